#!/usr/bin/python3
"""Checks that the documents say what is in the tree.

    tests/docs/check_docs.py          names everything that is wrong, exit code 1
    tests/docs/check_docs.py --fix    first renews line numbers, paths of files that have moved, and generated blocks

A document may quote code as

    `path/to/file.cpp:12`: `text of that line`

and that line of that file must then contain the text. Generated blocks end with <!-- end of list --> and begin with one of

    <!-- references -->                         the committed references
    <!-- bench list NAME -->                    what `bench list NAME` prints
    <!-- steps RESULT.json LIMIT STEP ...; ... -->    time and largest error of every contestant at these steps
    <!-- claims -->                             the verdicts on the paper's claims
    <!-- orders ANSWERS.json NAME ... -->        the orders of convergence of these known answers
    <!-- methods HEADLINE, RESULT.json LIMIT, ... -->   each method's time as published and in its best stepper, within that error

--fix renews them. No other measured number belongs in a document. The program is BENCH_BINARY if that is set, else that of
build/release; with --fix `./bench`, which builds it first.

Links between documents and paths in backticks must exist, Markdown files that comments name too. docs/using.md must name every exit
code. docs/results.md must be what its own command makes. Pictures of results must be of the commits that the results in the tree are of.
"""

import functools
import itertools
import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
QUOTE = re.compile(r"`([\w./-]+\.\w+):(\d+)`: `([^`]+)`")
LINK = re.compile(r"\]\(([^)\s]+)\)")
BACKTICKS = re.compile(r"`([^`\n]+)`")
PATH = re.compile(r"\.?[\w-][\w./*-]*/[\w./*-]*")
NAMED_DOCUMENT = re.compile(r"[\w/.-]*\w\.md\b")
BLOCK = re.compile(r"<!-- (references|bench list|methods|orders|steps|claims)([^>:]*?) -->\n\n?.*?<!-- end of list -->", re.DOTALL)
SURE = 3  # gaps of a reference
SOURCES = ("solvers", "harness", "tests", "plots", "cmake", "configs")
SOURCE_SUFFIXES = {".cpp", ".h", ".py", ".sh", ".cmake", ".txt", ".json"}


def read(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def json_of(path: Path) -> dict:
    return json.loads(read(path))


def documents() -> list[Path]:
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]


@functools.cache
def files_of_tree() -> list[Path]:
    """All files of the sources; without git too, in an unpacked archive."""
    return [path for folder in SOURCES for path in sorted((ROOT / folder).rglob("*"))
            if path.is_file() and path.suffix in SOURCE_SUFFIXES]


def lines_with(path: Path, text: str) -> list[int]:
    return [number for number, line in enumerate(read(path).splitlines(), 1) if text in line] if path.is_file() else []


def quotes(document: Path) -> list[str]:
    return [f"{path}: '{text}' is not in line {line} (run tests/docs/check_docs.py --fix)"
            for path, line, text in QUOTE.findall(read(document)) if int(line) not in lines_with(ROOT / path, text)]


def markdown(head: list[str], rows: list[list[str]]) -> str:
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, *rows)).replace("\n", f"\n{'|---' * len(head)}|\n", 1) + "\n"


def references(_: str) -> str:
    """Until when each committed reference can be trusted at some levels of error."""
    levels = (0.02, 0.01, 0.005)

    def trusted(path: Path) -> tuple[str, list[str]]:
        file = json_of(path)
        known = list(zip(file["times"], file["gap"]))[:len(file["positions"])]
        return path.stem.split("-n")[0], [f"{max((t for t, gap in known if SURE * gap <= level), default=0):g}" for level in levels]

    paths = sorted((ROOT / "results/references").glob("*.json"),
                   key=lambda path: (path.name.split("-n")[0], int(re.findall(r"-n(\d+)", path.name)[0]), path.name))
    rows = []
    for (_, until), alike in itertools.groupby(paths, trusted):
        alike = [f"`{path.stem}`" for path in alike]
        rows.append([" to ".join(sorted({alike[0], alike[-1]}, key=alike.index)), *until])
    return markdown(["reference", *(f"{100 * level:g} %" for level in levels)], rows)


@functools.cache
def output_of(*words: str) -> str:
    program = os.environ.get("BENCH_BINARY", "./bench" if "--fix" in sys.argv[1:] else "build/release/bench")
    return subprocess.run([program, *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def table_of(name: str) -> str:
    """The columns that the rows of a list of the program have."""
    rows = [{**row, "meaning": row.get("meaning", row.get("summary", row.get("description")))}
            for row in json.loads(output_of("list", name, "--json"))]
    columns = [column for column in ("name", "where", "unit", "meaning") if column in rows[0]]
    quoted = "`bench {}`" if name == "verbs" else "`{}`"
    return markdown([name.removesuffix("s").replace("statuse", "status") if column == "name" else column for column in columns],
                    [[quoted.format(row[column]) if column == "name" else row[column].replace("|", "\\|") for column in columns] for row in rows])


@functools.cache
def planes_of(file: str) -> list[dict]:
    return json.loads(output_of("show", file, "--json"))["planes"]


def methods_of(words: str) -> str:
    """A row for each method: milliseconds in its published stepper, then in its best one where that is faster; bold where it leads clearly."""
    headline, *columns = (part.split() for part in words.split(","))
    level, titles, times, leaders = float(headline[0]), [], [], []  # times: of each column, of each contestant
    for file, limit in columns:
        plane = next(p for p in planes_of(file) if p["sweep"] != "resolution" and float(limit) in p["strain_limits"])
        cell = next(c for c in plane["cells"] if (c["strain_limit"], c["error_level"]) == (float(limit), level))
        titles.append(f"{plane['scene'].replace('_', ' ')} {plane['resolution']}, {100 * float(limit):g} %")
        times.append({entry["row"]: 1e3 * entry["seconds"] for entry in cell["entries"] if entry["counts"]})
        leaders.append(cell["first"].partition("@")[0] if ((cell["lead_over_next_family"] or {}).get("low") or 1) > 1 else "")

    def in_steppers(column: dict[str, float], method: str) -> dict[str, float]:
        return {row: time for row, time in column.items() if row.partition("@")[0] == method}

    def text(column: dict[str, float], leader: str, method: str) -> str:
        own = in_steppers(column, method)
        if not own:
            return "-"
        best = min(own, key=own.__getitem__)
        shown = f"{own[method]:.3g}" if method in own else "-"
        shown += f", {own[best]:.3g} @{best.partition('@')[2]}" * (best != method)
        return f"**{shown}**" if method == leader else shown

    methods = {row.partition("@")[0] for column in times for row in column}
    order = sorted(methods, key=lambda m: [min(in_steppers(column, m).values(), default=math.inf) for column in reversed(times)])
    return markdown(["method", *titles], [[f"`{m}`", *(text(column, leader, m) for column, leader in zip(times, leaders))] for m in order])


def orders_of(words: str) -> str:
    """A row for each method: its order between the two finest steps and its deviation at the finest one, in each stepper."""
    file, *names = words.split()
    finest = {(row["answer"], row["solver"]): row for row in json_of(ROOT / file)["rows"] if row["deviation"] is not None}

    def text(answer: str, method: str) -> str:
        cells = []
        for (name, solver), row in finest.items():
            if name == answer and solver.partition("@")[0] == method:
                order = "-" if row["order"] is None else f"{row['order']:.1f}"
                stepper = f" @{solver.partition('@')[2]}" if "@" in solver else ""
                cells.append(f"{order} ({100 * abs(row['deviation']):.2g} %){stepper}")
        return ", ".join(cells) or "-"

    methods = dict.fromkeys(solver.partition("@")[0] for answer, solver in finest if answer in names)
    return markdown(["method", *(f"`{name}`" for name in names)],
                    [[f"`{method}`", *(text(name, method) for name in names)] for method in methods])


def steps_of(words: str) -> str:
    """Milliseconds for a simulated second and the largest error in percent, or the status of a failure; of further limits, the last step."""
    heads, columns, contestants = [], [], {}
    for part in words.split(";"):
        file, limits, *steps = part.split()
        points = {(p["contestant"], p["strain_limit"], round(1 / p["step"], 3)): p for p in json_of(ROOT / file)["points"] if not p["contestant"].endswith("_again")}
        contestants |= dict.fromkeys(key[0] for key in points)
        for i, limit in enumerate(limits.split(",")):
            for rate in (round(1 / float(step), 3) for step in (steps[-1:] if i else steps)):
                heads.append(f"{next(iter(points.values()))['resolution']}, {100 * float(limit):g} %, 1/{rate:g} s")
                columns.append({c: p for (c, of, at), p in points.items() if (of, at) == (float(limit), rate)})

    def text(p: dict | None) -> str:
        if p is None or p["status"] != "ok" or p["error"]["trajectory"] is None:
            return p["status"] if p else "-"
        return f"{1e3 * p['seconds_per_simulated_second']['min']:.3g}, {100 * p['error']['trajectory']:.2g} %"

    return markdown(["contestant", *heads], [[f"`{c}`", *(text(column.get(c)) for column in columns)] for c in contestants])


def claims_of(words: str) -> str:
    """The verdict on each of the paper's claims, from all committed results."""
    files = sorted(str(file) for file in (ROOT / "results").glob("*.json") if file.name != "answers.json")
    said = re.findall(r"^(C\d+) \((.*?)\): (.*)\n  ([a-z ]+)", output_of("claims", *files), re.MULTILINE)
    return markdown(["", "claim", "verdict"], [[f"{name}, {where}", claim, verdict] for name, where, claim, verdict in said])


BLOCKS = {"references": references, "claims": claims_of, "bench list": table_of, "methods": methods_of, "orders": orders_of, "steps": steps_of}


def with_tables(text: str) -> str:
    return BLOCK.sub(lambda match: f"<!-- {match[1]}{match[2]} -->\n\n{BLOCKS[match[1]](match[2].strip())}<!-- end of list -->", text)


def tables(document: Path) -> list[str]:
    text = read(document)
    return [] if with_tables(text) == text else ["a generated table is out of date (run tests/docs/check_docs.py --fix)"]


def fix() -> None:
    def renewed(match: re.Match[str]) -> str:
        lines = lines_with(ROOT / match[1], match[3])
        nearest = min(lines, key=lambda number: abs(number - int(match[2])), default=match[2])
        return f"`{match[1]}:{nearest}`: `{match[3]}`"

    for document in documents():
        text = read(document)
        new = QUOTE.sub(renewed, with_tables(text))
        if new != text:
            document.write_text(new, encoding="utf-8")
            print(f"{document.relative_to(ROOT)}: brought up to date")


def heading_anchors(document: Path) -> set[str]:
    headings = re.findall(r"^#+ (.*)$", read(document), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def links(document: Path) -> list[str]:
    errors = []
    for target in (target for target in LINK.findall(read(document)) if not re.match(r"\w+:", target)):
        name, _, anchor = target.partition("#")
        place = (document.parent / name).resolve() if name else document
        if not place.exists():
            errors.append(f"link to {target}, which does not exist")
        elif anchor and place.suffix == ".md" and anchor not in heading_anchors(place):
            errors.append(f"link to {target}: there is no such heading")
    return errors


def paths(document: Path) -> list[str]:
    """What looks like a path into one of the tree's folders is one."""
    folders = {path.name for path in ROOT.iterdir() if path.is_dir()} - {"build", ".git"}
    text = re.sub(r"^```.*?^```$", "", read(document), flags=re.MULTILINE | re.DOTALL)
    named = {quoted.split(":")[0].split(" ")[0].removeprefix("./") for quoted in BACKTICKS.findall(text)}
    return [f"`{path}` does not exist" for path in sorted(named) if PATH.fullmatch(path) and path.split("/")[0] in folders
            and not path.startswith("results/local") and not list(ROOT.glob(path.rstrip("/")))]


def named_documents() -> list[str]:
    return [f"{file.relative_to(ROOT)}:{number} names {name}, which does not exist"
            for file in files_of_tree() if file != Path(__file__).resolve() for number, line in enumerate(read(file).splitlines(), 1)
            for name in NAMED_DOCUMENT.findall(line.partition("//" if file.suffix in {".cpp", ".h"} else "#")[2]) if not (ROOT / name).exists()]


def exit_codes() -> list[str]:
    codes = set(re.findall(r"^  \w+ = (\d+)", read(ROOT / "harness/cli/command.h"), re.MULTILINE))
    section = read(ROOT / "docs/using.md").partition("## Exit codes")[2].partition("\n## ")[0]
    explained = set(re.findall(r"^\| (\d+) \|", section, re.MULTILINE))
    return [f"docs/using.md: exit codes {sorted(explained)}, the program has {sorted(codes)}"] if codes != explained else []


def results_page() -> list[str]:
    """It is what its own command makes of the committed result files, and short enough to be read."""
    page = read(ROOT / "docs/results.md")
    words = re.search(r"^```sh\n\./bench (results .*) --out docs/results\.md\n```$", page, re.MULTILINE)
    if not words or page.replace(" --out docs/results.md\n", "\n") != output_of(*words[1].split()):
        return ["docs/results.md is not what its own command makes"]
    lines = page.count("\n")
    return [f"docs/results.md has {lines} lines, 200 are to be read"] if lines > 200 else []


def pictures() -> list[str]:
    """Pictures are of the commits that their results are of."""
    files = [*(ROOT / "results").glob("*.json")]
    commits = {file: json_of(file)["context"]["build"]["git"] for file in files}
    shown = "".join(map(read, documents()))
    errors = [f"plots/figures/{picture.name} is shown by no document" for picture in (ROOT / "plots/figures").iterdir() if picture.name not in shown]
    for picture in sorted((ROOT / "plots/figures").glob("*.svg")):
        drawn = re.search(r"commit ([0-9a-f]{12})", read(picture))
        sweep = re.sub(r"-(figure|plane).*", "-", picture.stem)  # pieces of which it may be drawn from
        of = [commit for file, commit in commits.items() if picture.stem.startswith(file.stem + "-") or file.stem.startswith(sweep)]
        if not of:
            errors.append(f"plots/figures/{picture.name} is of no result in results/")
        elif not drawn or not any(commit.startswith(drawn[1]) for commit in of):
            errors.append(f"plots/figures/{picture.name} is not of the commit that its result is of: results/measure --pages")
    return errors


def main() -> int:
    if "--fix" in sys.argv[1:]:
        fix()
    errors = [f"{document.relative_to(ROOT)}: {error}" for document in documents()
              for check in (quotes, tables, links, paths) for error in check(document)]
    errors += named_documents() + exit_codes() + results_page() + pictures()
    for error in errors:
        print(error)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
