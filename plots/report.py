#!/usr/bin/python3
"""One page that tells what result files found: findings in words, charts to hide solvers in and tables to sort, every figure,
the paper's claims, and scenes in motion. It needs nothing but a browser, and no network.

    plots/report.py results/*.json --out report.html [--analyses FILE] [--claims claims.json] [--motion FOLDER ...]

page/ has one file a part: data.py, findings.py, pictures.py and motion.py for what is computed here, .css and .js for the browser.
`bench report` runs it with the claims decided and scenes recorded. Needs Debian's python3-matplotlib and python3-numpy.
"""

from __future__ import annotations

import argparse
import json
import sys
from html import escape
from pathlib import Path

sys.dont_write_bytecode = True

try:
    import matplotlib
except ImportError:
    print("report.py: matplotlib is missing (Debian: apt-get install python3-matplotlib)", file=sys.stderr)
    sys.exit(2)

from figures import all_figures
from page.data import document_data, embedded
from page.findings import findings
from page.motion import recorded
from page.pictures import Picture, picture
from parts.legend import legend_of, merged
from parts.program import exit_code
from parts.result_file import Json, ResultError, load, object_in
from parts.style import RC

PAGE = Path(__file__).parent / "page"
SCRIPTS = ("document.js", "contest.js", "table.js", "motion.js")


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="report.py", description="One page that tells what result files found.")
    parser.add_argument("results", type=Path, nargs="+", metavar="RESULT.json")
    parser.add_argument("--out", type=Path, required=True, metavar="report.html")
    parser.add_argument("--analyses", type=Path, metavar="FILE", help="what bench found: findings, and the analysis of each result")
    parser.add_argument("--claims", type=Path, metavar="claims.json", help="verdicts on the paper's claims")
    parser.add_argument("--motion", type=Path, nargs="*", default=[], metavar="FOLDER", help="recordings of bench film")
    return parser.parse_args(arguments)


def section(name: str, title: str, body: str) -> str:
    return f'<section id="{name}" aria-labelledby="{name}-title">\n<h2 id="{name}-title">{title}</h2>\n{body}\n</section>\n' if body else ""


def findings_part(told: list[Json], documents: list[Json]) -> str:
    """The answer that most readers come for is first, and large."""
    def items(texts: list[str]) -> str:
        return "<ul>\n" + "".join(f"<li>{text}</li>\n" for text in texts) + "</ul>" if texts else ""
    found = findings(told, documents)
    if not found:
        return ""
    answer = ""
    if found[0].parts:
        answer = f'<p class="answer">{escape(found[0].text)} {escape(" ".join(found[0].parts))}</p>\n'
        found = found[1:]
    return answer + items([escape(one.text) + items([escape(part) for part in one.parts]) for one in found])


def pictures_of(documents: dict[Path, Json]) -> list[Picture]:
    with matplotlib.rc_context(RC):
        return [picture(f"{path.stem}-{name}", draw) for path, document in documents.items()
                for name, draw in all_figures(document).items()]


def picture_part(item: Picture) -> str:
    name, title = escape(item.name), escape(item.title)
    return (f'<figure id="figure-{name}"><img src="{item.svg}" alt="{title}" loading="lazy">'
            f'<figcaption>{title} <a download="{name}.svg" data-of="figure-{name}" href="#figure-{name}">SVG</a> '
            f'<a download="{name}.csv" href="{item.csv}">CSV</a></figcaption></figure>\n')


def claims_part(claims: list[Json]) -> str:
    if not claims:
        return ""
    rows = "".join(f'<tr><th scope="row">{escape(c["id"])}</th><td>{escape(c["statement"])}</td>'
                   f'<td class="verdict">{escape(c["verdict"])}</td><td>{escape(c["measured"])}</td><td>{escape(c["rule"])}</td></tr>\n'
                   for c in claims)
    return ('<div class="wide" tabindex="0"><table><thead><tr><th scope="col">Claim</th><th scope="col">Says</th><th scope="col">Verdict'
            f'</th><th scope="col">Measured</th><th scope="col">Rule</th></tr></thead><tbody>\n{rows}</tbody></table></div>')


def machine_part(documents: dict[Path, Json]) -> str:
    def row(path: Path, document: Json) -> str:
        context = object_in(document, "context")
        build = object_in(context, "build")
        cells = (path.name, context.get("date", ""), context.get("cpu_model", ""), context.get("num_cpus", ""),
                 str(build.get("git", ""))[:12] + (" with changes" if build.get("dirty") else ""), build.get("compiler", ""),
                 build.get("flags", ""))
        return "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in cells) + "</tr>\n"
    return ('<div class="wide" tabindex="0"><table><thead><tr>' + "".join(f'<th scope="col">{name}</th>' for name in (
        "File", "Date", "Processor", "Cores", "Commit", "Compiler", "Flags")) + "</tr></thead><tbody>\n"
        + "".join(row(path, document) for path, document in documents.items()) + "</tbody></table></div>")


def page(documents: dict[Path, Json], told: list[Json], claims: list[Json], motions: list[Json]) -> str:
    legend = merged(legend_of(document) for document in documents.values() if "legend" in document)
    data = document_data(documents, legend)
    parts = [("findings", "Findings", findings_part(told, list(documents.values())))]
    if data["points"]:
        parts += [("contest", "Who is fastest", (PAGE / "contest.html").read_text(encoding="utf-8")),
                  ("points", "All points", (PAGE / "table.html").read_text(encoding="utf-8"))]
    if motions:
        parts.append(("motion", "In motion", (PAGE / "motion.html").read_text(encoding="utf-8")))
    parts += [("figures", "Figures", "".join(picture_part(item) for item in pictures_of(documents))),
              ("claims", "The paper's claims", claims_part(claims)),
              ("machine", "Machine and build", machine_part(documents))]
    parts = [part for part in parts if part[2]]
    links = "".join(f'<a href="#{name}">{title}</a>' for name, title, _ in parts)
    script = "\n".join((PAGE / name).read_text(encoding="utf-8") for name in SCRIPTS)
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>Inextensible cloth: which solver, at which strain</title>\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; "
        "script-src 'unsafe-inline'\">\n"
        f'<style>\n{(PAGE / "page.css").read_text(encoding="utf-8")}</style>\n</head>\n<body>\n'
        "<header><h1>Which solver keeps cloth from stretching, how fast, how well</h1>\n"
        f'<nav aria-label="Parts of this page">{links}</nav></header>\n<main>\n'
        + "".join(section(*part) for part in parts)
        + f'</main>\n<script type="application/json" id="data">{embedded({**data, "motions": motions})}</script>\n'
        f"<script>\n{script}</script>\n</body>\n</html>\n")


def run(arguments: list[str]) -> None:
    options = parse(arguments)
    documents = {path: load(path) for path in options.results}
    claims = json.loads(options.claims.read_text(encoding="utf-8")) if options.claims else []
    analyses = json.loads(options.analyses.read_text(encoding="utf-8")) if options.analyses else {"findings": [], "of": {}}
    for path, document in documents.items():
        if str(path) in analyses["of"]:
            document["analysis"] = analyses["of"][str(path)]
    text = page(documents, analyses["findings"], claims, [recorded(folder) for folder in options.motion])
    try:
        options.out.write_text(text, encoding="utf-8", errors="replace")
    except OSError as error:
        raise ResultError(f"cannot write {options.out}: {error.strerror}") from error
    print(options.out)


if __name__ == "__main__":
    sys.exit(exit_code(run))
