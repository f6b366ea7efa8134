#!/usr/bin/python3
"""Checks that the documents say what is in the tree.

    tests/docs/check_docs.py          names everything that is wrong, exit code 1
    tests/docs/check_docs.py --fix    first brings line numbers, and paths of files that have moved, up to date

A document may quote code as

    `path/to/file.cpp:12`: `text of that line`

and the text must then stand in that line of that file. A paragraph may say where its numbers come from,

    <!-- results/paper-strain.json strain drape 0.01: jacobi / fast_projection = 3.5 -->

and the number must then be in the paragraph and follow from the file, to its last digit. `strain` (with a limit) and `resolution`
(with a number of vertices) mean the time of a best point, `error` (with a largest error) the least time within it, `after
collision` (with a limit) the strain of a best point; the unit is s, ms or %, none for a ratio or s. Links between documents and
paths in backticks must exist, Markdown files that comments name too, and docs/measuring.md must name every field of a point, every
counter and every status.
"""

from __future__ import annotations

import functools
import json
import math
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
QUOTE = re.compile(r"`([\w./-]+\.\w+):(\d+)`: `([^`]+)`")
NUMBER = re.compile(r"<!-- (\S+\.json) ([a-z ]+) (\w+) ([\d.]+): (\w+)(?: / (\w+))? = ([\d.]+) ?(s|ms|%|) -->")
COMMENTED = re.compile(r"<!--.*?-->", re.DOTALL)
UNITS = {"": 1, "s": 1, "ms": 1e-3, "%": 0.01}
LINK = re.compile(r"\]\(([^)\s]+)\)")
BACKTICKS = re.compile(r"`([^`\n]+)`")
PATH = re.compile(r"\.?[\w-][\w./*-]*/[\w./*-]*")
NAMED_DOCUMENT = re.compile(r"[\w/.-]*\w\.md\b")
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


def fix() -> None:
    for document in documents():
        text = document.read_text(encoding="utf-8")

        def renewed(match: re.Match[str]) -> str:
            place = found_again(match[1], int(match[2]), match[3])
            return f"`{place[0]}:{place[1]}`: `{match[3]}`" if place else match[0]

        new = QUOTE.sub(renewed, text)
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


@functools.cache
def points_of(file: str) -> list[dict]:
    return json.loads((ROOT / file).read_text(encoding="utf-8"))["points"]


def measured_value(file: str, quantity: str, scene: str, place: float, solver: str) -> float:
    """What the file says; raises LookupError where it says nothing."""
    points = [p for p in points_of(file) if p["scene"] == scene and p.get("contestant", p["solver"]) == solver and p["status"] == "ok"]
    if quantity == "error":
        times = [p["seconds_per_simulated_second"]["median"] for p in points
                 if p["sweep"] == "step" and (p["error"]["trajectory"] or math.inf) <= place]
        if not times:
            raise LookupError("no such point")
        return min(times)
    axis = "vertices" if quantity == "resolution" else "strain_limit"
    sweep = "resolution" if quantity == "resolution" else "strain"
    points = [p for p in points if p["sweep"] == sweep and p["best"] and math.isclose(p[axis], place)]
    if sweep == "strain":  # the largest size, as in figures
        points = [p for p in points if p["vertices"] == max(q["vertices"] for q in points)]
    if len(points) != 1:
        raise LookupError(f"{len(points)} such points")
    return (points[0]["max_strain_after_collision"] if quantity == "after collision"
            else points[0]["seconds_per_simulated_second"]["median"])


def numbers(document: Path) -> list[str]:
    errors = []
    text = without_blocks(document.read_text(encoding="utf-8"))
    for paragraph in re.split(r"\n(?=\* |\n)", text):
        words = COMMENTED.sub("", paragraph)
        for comment in COMMENTED.findall(paragraph):
            match = NUMBER.fullmatch(comment)
            if not match:
                if ".json" in comment:
                    errors.append(f"cannot read {comment}")
                continue
            file, quantity, scene, place, solver, rival, number, unit = match.groups()
            try:
                value = measured_value(file, quantity, scene, float(place), solver) / UNITS[unit]
                if rival:
                    value /= measured_value(file, quantity, scene, float(place), rival)
            except (OSError, LookupError, ValueError) as error:
                errors.append(f"{comment}: {error}")
                continue
            decimals = len(number.partition(".")[2])
            if f"{value:.{decimals}f}" != number:
                errors.append(f"{comment}: it is {value:.4g}")
            wanted = number + (f" {unit}" if unit else "")
            if not re.search(rf"(?<![\d.]){re.escape(wanted)}(?![\d]|\.\d)", words):
                errors.append(f"{comment}: the paragraph does not say {wanted}")
    return errors


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
    fields = set().union(*(names_in(points_of(file)[0]) for file in ("results/paper-strain.json", "results/default-step.json")))
    counters = (ROOT / "solvers/problem/work_counters.h").read_text(encoding="utf-8")
    fields |= set(re.findall(r"^  (?:std::int64_t|double) (\w+) = 0;", counters, re.MULTILINE))
    schema = json.loads((ROOT / "configs/result.schema.json").read_text(encoding="utf-8"))
    statuses = set(schema["definitions"]["status"]["enum"])
    explained = set(BACKTICKS.findall((ROOT / "docs/measuring.md").read_text(encoding="utf-8")))
    return [f"docs/measuring.md does not explain `{name}`" for name in sorted((fields | statuses) - explained - {"error", "work"})]


def main() -> int:
    if "--fix" in sys.argv[1:]:
        fix()
    errors = [f"{document.relative_to(ROOT)}: {error}" for document in documents()
              for check in (quotes, numbers, links, paths) for error in check(document)]
    errors += named_documents() + measured()
    for error in errors:
        print(error)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
