"""What the report says in words: the program's own findings, then counts of hard cases and known answers."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from parts.result_file import Json

FIRST = ("drape", "strain")  # the question that most readers come with


@dataclass(frozen=True)
class Finding:
    text: str
    parts: tuple[str, ...] = ()


def findings(told: list[Json], documents: list[Json]) -> list[Finding]:
    """`told`: what the program found (bench report), the largest drape over strain before all others."""
    found = [Finding(f"{one['subject'].replace('_', ' ').capitalize()}, over {one['sweep']}:", tuple(one["sentences"]))
             for one in sorted(told, key=_rank)]
    for document in documents:
        if "matrix" in document:
            found.append(_hard_cases(document))
        if "rows" in document and "answers" in document:
            found.append(_answers(document))
    return found


def _rank(one: Json) -> tuple[bool, int]:
    first = (one["scene"], one["sweep"]) == FIRST
    return (not first, -one["vertices"] if first else 0)


def _hard_cases(document: Json) -> Finding:
    cells = document["matrix"]
    outcomes = Counter(cell["outcome"].replace("_", " ") for cell in cells)
    unexpected = sum(cell.get("as_expected") is False for cell in cells)
    cases = len({cell["row"] for cell in cells})
    return Finding(f"Hard cases: {len(cells)} runs of {cases} cases, {unexpected} not as theory expects; "
                   + ", ".join(f"{count} {name}" for name, count in outcomes.most_common()) + ".")


def _answers(document: Json) -> Finding:
    rows = document["rows"]
    finished = sum(isinstance(row.get("deviation"), (int, float)) for row in rows)
    return Finding(f"Known answers: {len(document['answers'])} figures that theory or measurement knows, {len(rows)} runs, of which "
                   f"{finished} gave a figure.")
