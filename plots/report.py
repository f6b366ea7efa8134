#!/usr/bin/python3
"""One page on what result files found: findings in words, ranks from which solvers can be hidden, a sortable table, every
figure, and the paper's claims. It needs only a browser and no network.

    plots/report.py report.json --out report.html

`bench report` runs it: report.json has the results, their sweeps with analyses (several files may be pieces of one), the findings of all, and
the claims decided. page/ has what the browser runs. Needs Debian's python3-matplotlib.
"""

import argparse
import base64
import gzip
import io
import json
import shlex
import sys
from html import escape
from operator import itemgetter
from pathlib import Path
from typing import Any, Callable, Iterable

sys.dont_write_bytecode = True

from figures import all_figures  # complains where matplotlib is missing

import matplotlib
from matplotlib.figure import Figure

from parts.result import Json, Result, seconds_of
from parts.style import RC

PAGE = Path(__file__).parent / "page"
SCRIPTS = ("document.js", "table.js")
FIRST = ("drape", "strain")  # the question that most readers come with
KINDS = ("strain", "resolution", "step")  # of sweeps, by how many readers ask


def table(head: Iterable[str], rows: Iterable[list[str]]) -> str:
    """Scrolls sideways if it is wide; the first cell of a row names it."""
    columns = "".join(f'<th scope="col">{name}</th>' for name in head)
    lines = "".join(f'<tr><th scope="row">{escape(name)}</th>' + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>\n"
                    for name, *cells in rows)
    return f'<div class="wide" tabindex="0"><table><thead><tr>{columns}</tr></thead><tbody>\n{lines}</tbody></table></div>'


def rank(place: Json) -> tuple[bool, int, int]:
    """The drape over strain comes first, then sweeps by kind, each from the largest size on."""
    return (place["scene"], place["sweep"]) != FIRST, KINDS.index(place["sweep"]), -place["vertices"]


def findings(found: list[Json]) -> str:
    """The program's own. The answer that most readers come for is first and large; of each other one a line shows, which opens."""
    def opened(text: str, first: str = "", *more: str) -> str:
        items = "".join(f"<li>{sentence}</li>\n" for sentence in more)
        return f"<details><summary>{text} {first}</summary>\n<ul>\n{items}</ul></details>\n" if more else f"<p>{text} {first}</p>\n"

    said = [[escape(text) for text in (f"{one['subject'].replace('_', ' ').capitalize()}, over {one['sweep']}:", *one["sentences"])]
            for one in sorted(found, key=rank)]
    answer = f'<p class="answer">{" ".join(said.pop(0))}</p>\n' if said and len(said[0]) > 1 else ""
    return answer + "".join(opened(*texts) for texts in said)


def picture(name: str, draw: Callable[[], Figure]) -> str:
    """A figure as an SVG that cannot run scripts. It is packed, and a script unpacks it."""
    figure, svg = draw(), io.BytesIO()
    figure.savefig(svg, format="svg", metadata={"Date": None, "Creator": None})
    title = escape(" ".join(figure.texts[0].get_text().split()) if figure.texts else name)
    name, image = escape(name), base64.b64encode(gzip.compress(svg.getvalue(), mtime=0)).decode()
    return (f'<figure id="figure-{name}"><img data-packed="{image}" alt="{title}">'
            f'<figcaption>{title} <a download="{name}.svg" href="#figure-{name}">SVG</a></figcaption></figure>\n')


def pictures(sweeps: list[tuple[str, Result]]) -> str:
    """Of sweeps by rank; figures of all solvers come at the end, behind a line to open."""
    def order(named: tuple[str, Result]) -> tuple[bool, tuple]:
        points = named[1].points
        return len({point["solver"] for point in points}) < 2, min(map(rank, points), default=(True, len(KINDS), 0))

    shown, complete = "", ""
    with matplotlib.rc_context(RC):
        for stem, result in sorted(sweeps, key=order):
            few, every = all_figures(result), all_figures(result, every=True)
            shown += "".join(picture(f"{stem}-{name}", draw) for name, draw in few.items())
            complete += "".join(picture(f"{stem}-{name}", draw) for name, draw in every.items() if name not in few)
    return shown + (f"<details><summary>Figures of all solvers, with their steps and failures</summary>\n{complete}</details>" if complete else "")


def _samples(point: Json) -> list[float]:
    return (point["seconds_per_simulated_second"] or {"samples": []})["samples"]


# What a row holds; the scripts know it by these names.
FIELDS: dict[str, Callable[[Json], Any]] = {
    **{name: itemgetter(name) for name in ("id", "scene", "sweep", "vertices", "step", "status", "best")},
    "solver": itemgetter("contestant"), "limit": itemgetter("strain_limit"), "detail": itemgetter("status_detail"),
    "seconds": seconds_of, "high": lambda point: point["seconds_per_simulated_second"]["median"] if len(_samples(point)) >= 3 else None,
    "runs": lambda point: len(_samples(point)),
    "strain": itemgetter("max_strain"), "delivered": itemgetter("max_strain_after_collision"),
    "error": lambda point: point["error"]["trajectory"], "energy": lambda point: point["error"]["energy_gain"],
    "iterations": lambda point: point["work"]["iterations"], "factorizations": lambda point: point["work"]["factorizations"],
    "projections": lambda point: point["work"]["edge_projections"],
}


def embedded(results: dict[Path, Result], sweeps: list[Json]) -> Json:
    """The legends of all files are merged. sweeps: each with its files' numbers."""
    sweep_of = {file: number for number, sweep in enumerate(sweeps) for file in sweep["files"]}
    return {
        "columns": ["file", *FIELDS],
        "points": [[file, *(read(point) for read in FIELDS.values())]
                   for file, result in enumerate(results.values()) for point in result.points],
        "files": [{"name": path.name, "command": repeat_command(result), "sweep": sweep_of[number]}
                  for number, (path, result) in enumerate(results.items())],
        "labels": {name: result.label(name) for result in results.values()
                   for name in (*result.solvers, *(point["contestant"] for point in result.points))},
    }


def repeat_command(result: Result) -> str:
    """The command that made the file, without options that name files; the page adds a filter for one point."""
    words = iter(result.context.get("command", [])[1:])
    kept = ["./bench"]
    for word in words:
        if word in ("--out", "--filter"):
            next(words, None)
        elif word not in ("--force", "--resume", "--no-plots"):
            kept.append(shlex.quote(word))
    return " ".join(kept)


def script_text(value: Any) -> str:
    """JSON as the text of a script element, which no solver's name can end."""
    text = json.dumps(value, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def page(results: dict[Path, Result], sweeps: list[Json], found: list[Json], claims: list[Json]) -> str:
    def file(name: str) -> str:
        return (PAGE / name).read_text(encoding="utf-8")

    data, names = embedded(results, sweeps), list(results)
    drawn = pictures([(names[sweep["files"][0]].stem, Result(sweep["document"])) for sweep in sweeps])
    machines = [[path.name, *(str(result.context[key]) for key in ("date", "cpu_model", "num_cpus")),
                 build["git"][:12] + (" with changes" if build["dirty"] else ""), build["compiler"], build["flags"]]
                for path, result in results.items() if (build := result.context["build"])]
    verdicts = [[claim[key] for key in ("id", "statement", "verdict", "measured", "rule")] for claim in claims]
    parts = [(name, title, body) for name, title, body in (
        ("findings", "Findings", findings(found)),
        ("points", "Who is fastest", file("table.html") if data["points"] else ""),
        ("figures", "Figures", drawn),
        ("claims", "The paper's claims", table(("Claim", "Says", "Verdict", "Measured", "Rule"), verdicts) if claims else ""),
        ("machine", "Machine and build", table(("File", "Date", "Processor", "Cores", "Commit", "Compiler", "Flags"), machines)),
    ) if body]
    links = "".join(f'<a href="#{name}">{title}</a>' for name, title, _ in parts)
    sections = "".join(f'<section id="{name}" aria-labelledby="{name}-title">\n<h2 id="{name}-title">{title}</h2>\n{body}\n</section>\n'
                       for name, title, body in parts)
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>Inextensible cloth: which solver, at which strain</title>\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src blob:; style-src 'unsafe-inline'; "
        "script-src 'unsafe-inline'\">\n"
        f'<style>\n{file("page.css")}</style>\n</head>\n<body>\n'
        "<header><h1>Which solver keeps cloth from stretching, how fast, how well</h1>\n"
        f'<nav aria-label="Parts of this page">{links}</nav></header>\n<main>\n{sections}</main>\n'
        f'<script type="application/json" id="data">{script_text(data)}</script>\n'
        f'<script>\n{chr(10).join(map(file, SCRIPTS))}</script>\n</body>\n</html>\n')


def main() -> int:
    parser = argparse.ArgumentParser(prog="report.py", description="Write one page with the findings of result files.")
    parser.add_argument("report", type=Path, metavar="report.json", help="results, findings and claims, as bench report gives them")
    parser.add_argument("--out", type=Path, required=True, metavar="report.html")
    options = parser.parse_args()
    given = json.loads(options.report.read_text(encoding="utf-8"))
    results = {Path(entry["name"]): Result(entry["document"]) for entry in given["results"]}
    text = page(results, given["sweeps"], given["findings"], given["claims"])
    options.out.write_text(text, encoding="utf-8", errors="replace")
    print(options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
