#!/usr/bin/python3
"""Checks that the documents say what is in the tree.

    tests/docs/check_docs.py          names everything that is wrong, exit code 1
    tests/docs/check_docs.py --fix    first brings line numbers, paths of files that have moved, and measured numbers up to date

A document may quote code as

    `path/to/file.cpp:12`: `text of that line`

and the text must then stand in that line of that file. A paragraph may say where its numbers come from,

    <!-- results/paper-strain-chain.json strain chain 0.01: jacobi / fast_projection = 3.5 -->

and the number must then be in the paragraph and follow from the file, to its last digit; --fix brings both up to date where only
digits change. `jacobi` and `fast_projection` are contestants. `strain` (with a limit) and `resolution` (with a number of vertices)
mean the time of a best point, `error` (with a largest error) the least time within it, `delivered` (with a largest strain after
collisions) the same, `after collision` (with a limit) the strain of a best point, `right motion` (with a limit) the fastest at it or a tighter one within an error of 2 %; the unit is s, ms or %, none for a ratio or s.
A ratio may say more:

    = 3.5 (3.3-3.8)           its 95 % interval, which the paragraph must give as well
    = 3.5 within interval     the number need only lie in the interval; --fix leaves it alone while it does
    = 3.5 above 1             the whole interval must lie there (or below), as it must where words say faster or slower

A table of the committed references stands between <!-- references --> and <!-- end of references -->, and follows from their files.
What the program lists stands between <!-- bench list NAME --> and <!-- end of list -->, and follows from `bench list NAME`; the
folders' directions between <!-- folders of solvers --> and <!-- end of list --> follow from solvers/CMakeLists.txt. --fix makes these
anew, and what stands after <!-- bench budget RESULT.json ... --> in the same way. A paragraph may repeat words of a list:

    <!-- bench list suites: about six minutes -->

The program is BENCH_BINARY if that is set, else that of build/release; with --fix `./bench`, which builds it first.

Links between documents and paths in backticks must exist, Markdown files that comments name too. docs/measuring.md must name every
field of a point, docs/using.md every exit code. Pictures of results and docs/results.md must be of the commits that the results in the tree are of.
"""

from __future__ import annotations

import functools
import json
import os
import re
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # nothing of this test stays in the source tree

import measured_numbers
from measured_numbers import points_of

ROOT = Path(__file__).resolve().parents[2]
QUOTE = re.compile(r"`([\w./-]+\.\w+):(\d+)`: `([^`]+)`")
LINK = re.compile(r"\]\(([^)\s]+)\)")
BACKTICKS = re.compile(r"`([^`\n]+)`")
PATH = re.compile(r"\.?[\w-][\w./*-]*/[\w./*-]*")
NAMED_DOCUMENT = re.compile(r"[\w/.-]*\w\.md\b")
REFERENCES = re.compile(r"(<!-- references -->\n).*?(<!-- end of references -->)", re.DOTALL)
LISTS = re.compile(r"(<!-- (bench list (\w+)|bench budget ([^>]+?)|folders of (\w+)) -->\n\n?).*?(<!-- end of list -->)", re.DOTALL)
REPEATED = re.compile(r"<!-- bench list (\w+): (.*?) -->")
SOURCES = ("solvers", "harness", "tests", "plots", "cmake", "configs")
SOURCE_SUFFIXES = {".cpp", ".h", ".py", ".sh", ".cmake", ".txt", ".json"}


def documents() -> list[Path]:
    return [path for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md") if path.exists()] + sorted(
        (ROOT / "docs").rglob("*.md"))


def files_of_tree() -> list[Path]:
    """All files of the sources; without git too, in an unpacked archive."""
    return [path for folder in SOURCES for path in sorted((ROOT / folder).rglob("*"))
            if path.is_file() and path.suffix in SOURCE_SUFFIXES]


def lines_with(path: Path, text: str) -> list[int]:
    if not path.is_file():
        return []
    return [number for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1) if text in line]


def found_again(path: str, line: int, text: str) -> tuple[str, int] | None:
    """Where the text stands now: in the same file, or in the only file that has it."""
    here = lines_with(ROOT / path, text)
    if here:
        return path, min(here, key=lambda number: abs(number - line))
    if (ROOT / path).exists():
        candidates = [file for file in files_of_tree() if file.parent != ROOT / "tests"]
    else:
        candidates = [file for file in files_of_tree() if file.name == Path(path).name] or files_of_tree()
    holders = [(file, lines_with(file, text)) for file in candidates]
    holders = [(file, lines) for file, lines in holders if lines]
    if len(holders) != 1:
        return None
    file, lines = holders[0]
    return str(file.relative_to(ROOT)), lines[0]


def references() -> str:
    """Until when each committed reference can be trusted at some levels of error."""
    levels = (0.02, 0.01, 0.005)
    rows = ["| reference | " + " | ".join(f"{100 * level:g} %" for level in levels) + " | runs of the ensemble |\n|"
            + "---|" * (2 + len(levels)) + "\n"]

    def number_of(path: Path) -> int:
        return int(re.findall(r"-n(\d+)", path.name)[0])

    for path in sorted((ROOT / "results/references").glob("*.json"), key=lambda p: (p.name.split("-n")[0], number_of(p), p.name)):
        file = json.loads(path.read_text(encoding="utf-8"))
        known = list(zip(file["times"], file["gap"]))[:len(file["positions"])]
        until = (max((t for t, gap in known if measured_numbers.SURE * gap <= level), default=0) for level in levels)
        rows.append(f"| `{path.stem}` | " + " | ".join(f"{t:g}" for t in until)
                    + f" | {file.get('ensemble', {}).get('runs', '-')} |\n")
    return "".join(rows)


@functools.cache
def output_of(*words: str) -> str:
    program = os.environ.get("BENCH_BINARY", "./bench" if "--fix" in sys.argv[1:] else "build/release/bench")
    return subprocess.run([program, *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def listed(name: str) -> list[dict]:
    return json.loads(output_of("list", name, "--json"))


def budgets_of(files: list[str]) -> str:
    return output_of("budget", *files)


def table_of(name: str) -> str:
    """Of a list of the program: the columns that its rows have."""
    rows = [{**row, "meaning": row.get("meaning", row.get("summary", row.get("description")))} for row in listed(name)]
    columns = [column for column in ("name", "where", "unit", "meaning") if column in rows[0]]
    quoted = "`bench {}`" if name == "verbs" else "{}" if name == "claims" else "`{}`"

    def cells(row: dict) -> str:
        return " | ".join(quoted.format(row[column]) if column == "name" else row[column].replace("|", "\\|") for column in columns)

    head = [name.removesuffix("s").replace("statuse", "status") if column == "name" else column for column in columns]
    return f"| {' | '.join(head)} |\n{'|---' * len(columns)}|\n" + "".join(f"| {cells(row)} |\n" for row in rows) + "\n"


def folders_of(tree: str) -> str:
    """Which folders each folder names in its CMakeLists.txt."""
    text = (ROOT / tree / "CMakeLists.txt").read_text(encoding="utf-8")
    uses = [(name, found[1].split() if (found := re.search(r"USES ([a-z ]+) ", rest)) else [])
            for name, rest in re.findall(r"^add_folder\((\w+)([^)]*)\)", text, re.MULTILINE)]
    uses += [(name, rest.split()) for name, rest in re.findall(rf"^folder_uses\(\w+ {tree}/(\w+)([^)]*)\)", text, re.MULTILINE)]
    return "| folder | uses |\n|---|---|\n" + "".join(f"| `{tree}/{name}` | {', '.join(used) or '-'} |\n" for name, used in uses) + "\n"


def with_tables(text: str) -> str:
    text = REFERENCES.sub(lambda match: match[1] + references() + match[2], text)
    def table(match: re.Match[str]) -> str:
        made = table_of(match[3]) if match[3] else budgets_of(match[4].split()) if match[4] else folders_of(match[5])
        return f"<!-- {match[2]} -->\n\n" + made + match[6]

    return LISTS.sub(table, text)


def fix() -> None:
    for document in documents():
        text = document.read_text(encoding="utf-8")

        def renewed(match: re.Match[str]) -> str:
            place = found_again(match[1], int(match[2]), match[3])
            return f"`{place[0]}:{place[1]}`: `{match[3]}`" if place else match[0]

        new = "".join(map(measured_numbers.renewed_paragraph, measured_numbers.paragraphs(QUOTE.sub(renewed, with_tables(text)))))
        if new != text:
            document.write_text(new, encoding="utf-8")
            print(f"{document.relative_to(ROOT)}: brought up to date")


def quotes(document: Path) -> list[str]:
    errors = []
    for path, line, text in QUOTE.findall(document.read_text(encoding="utf-8")):
        here = lines_with(ROOT / path, text)
        if not (ROOT / path).is_file():
            errors.append(f"{path} does not exist")
        elif not here:
            errors.append(f"{path} does not hold '{text}'")
        elif int(line) not in here:
            errors.append(f"{path}: '{text}' is in line {here[0]}, not {line} (run tests/docs/check_docs.py --fix)")
    return errors


def tables(document: Path) -> list[str]:
    text = document.read_text(encoding="utf-8")
    return [] if with_tables(text) == text else ["a generated table is out of date (run tests/docs/check_docs.py --fix)"]


def repeated(document: Path) -> list[str]:
    """Words that a paragraph repeats from a list are in both."""
    errors = []
    for paragraph in measured_numbers.paragraphs(document.read_text(encoding="utf-8")):
        words = re.sub(r"\s+", " ", re.sub(r"<!--.*?-->", "", paragraph, flags=re.DOTALL)).lower()
        for name, text in REPEATED.findall(paragraph):
            if text not in json.dumps(listed(name)):
                errors.append(f"bench list {name} does not say '{text}'")
            if text not in words:
                errors.append(f"no '{text}' beside the comment that it is from bench list {name}")
    return errors


def numbers(document: Path) -> list[str]:
    return measured_numbers.errors_in(without_blocks(document.read_text(encoding="utf-8")))


def heading_anchors(document: Path) -> set[str]:
    headings = re.findall(r"^#+ (.*)$", document.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def links(document: Path) -> list[str]:
    errors = []
    for target in LINK.findall(document.read_text(encoding="utf-8")):
        if re.match(r"\w+:", target):
            continue
        name, _, anchor = target.partition("#")
        place = (document.parent / name).resolve() if name else document
        if not place.exists():
            errors.append(f"link to {target}, which does not exist")
        elif anchor and place.suffix == ".md" and anchor not in heading_anchors(place):
            errors.append(f"link to {target}: there is no such heading")
    return errors


def without_blocks(text: str) -> str:
    return re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)


def paths(document: Path) -> list[str]:
    """What looks like a path into one of the tree's folders is one."""
    errors = []
    folders = {path.name for path in ROOT.iterdir() if path.is_dir()} - {"build", ".git"}
    for quoted in BACKTICKS.findall(without_blocks(document.read_text(encoding="utf-8"))):
        path = quoted.split(":")[0].split(" ")[0].removeprefix("./")
        if not PATH.fullmatch(path) or path.split("/")[0] not in folders or path.startswith("results/local"):
            continue
        if not list(ROOT.glob(path.rstrip("/"))):
            errors.append(f"`{quoted}`: {path} does not exist")
    return errors


def named_documents() -> list[str]:
    errors = []
    for file in files_of_tree():
        if file == Path(__file__).resolve():
            continue
        mark = "//" if file.suffix in {".cpp", ".h"} else "#"
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            for name in NAMED_DOCUMENT.findall(line.partition(mark)[2]):
                if not (ROOT / name).exists():
                    errors.append(f"{file.relative_to(ROOT)}:{number} names {name}, which does not exist")
    return errors


def names_in(value: object) -> set[str]:
    """Keys of all objects in it, but of those whose keys a suite or a scene chooses."""
    if isinstance(value, list):
        return set().union(*map(names_in, value))
    if not isinstance(value, dict):
        return set()
    chosen = {"settings", "options", "scene_parameters"}
    return set(value).union(*(names_in(part) for name, part in value.items() if name not in chosen))


def measured() -> list[str]:
    fields = set().union(*(names_in(points_of(file)[0]) for file in ("results/paper-strain-chain.json", "results/paper-step-chain.json")))
    schema = json.loads((ROOT / "configs/result.schema.json").read_text(encoding="utf-8"))
    fields = (fields | set(schema["definitions"]["point"]["properties"])) - {"best_at_error"}  # of older files
    explained = set(BACKTICKS.findall((ROOT / "docs/measuring.md").read_text(encoding="utf-8")))
    return [f"docs/measuring.md does not explain `{name}`" for name in sorted(fields - explained - {"error", "work"})]


def exit_codes() -> list[str]:
    codes = set(re.findall(r" = (\d+)", (ROOT / "harness/cli/exit_codes.h").read_text(encoding="utf-8")))
    explained = set(re.findall(r"^\| (\d+) \|", (ROOT / "docs/using.md").read_text(encoding="utf-8").partition("## Exit codes")[2].partition("\n## ")[0],
                                re.MULTILINE))
    return [f"docs/using.md: exit codes {sorted(explained)}, the program has {sorted(codes)}"] if codes != explained else []


def pictures() -> list[str]:
    """Pictures, and the rows of docs/results.md, are of the commits that their results are of."""
    files = [*(ROOT / "results").glob("*.json"), *(ROOT / "results/large").glob("*.json")]
    commits = {file: json.loads(file.read_text(encoding="utf-8"))["context"]["build"]["git"] for file in files}
    errors = []
    for picture in sorted((ROOT / "plots/figures").glob("*.svg")):
        drawn = re.search(r"commit ([0-9a-f]{12})", picture.read_text(encoding="utf-8"))
        sweep = re.sub(r"-(figure|plane|budget|lead).*", "-", picture.stem)  # pieces of which it may be drawn from
        of = [commit for file, commit in commits.items() if picture.stem.startswith(file.stem + "-") or file.stem.startswith(sweep)]
        if not of:
            errors.append(f"plots/figures/{picture.name} is of no result in results/")
        elif not drawn or not any(commit.startswith(drawn[1]) for commit in of):
            errors.append(f"plots/figures/{picture.name} is not of the commit that its result is of: results/measure --pages")
    for name, commit in re.findall(r"^\| `(results/[^`]*\.json)` \|.*?\| ([0-9a-f]{40}) \|", (ROOT / "docs/results.md").read_text(encoding="utf-8"),
                                   re.MULTILINE):
        if commits.get(ROOT / name) != commit:
            errors.append(f"docs/results.md is not of {name} as it is: results/measure --pages")
    return errors


def main() -> int:
    if "--fix" in sys.argv[1:]:
        fix()
    errors = [f"{document.relative_to(ROOT)}: {error}" for document in documents()
              for check in (quotes, numbers, tables, repeated, links, paths) for error in check(document)]
    errors += named_documents() + measured() + exit_codes() + pictures()
    for error in errors:
        print(error)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
