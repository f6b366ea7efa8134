"""A result file's legend: how its solvers are called and which belong together, and the letters of its statuses.

No solver and no status is known by name here: what a file does not say is made up from the name itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable

from parts.result_file import OK, Json, ResultError, points_of
from parts.words import clean

NOT_CHOSEN = "?"  # ran well, yet no step was marked best: an interrupted search, or an error that is not known
TOO_WRONG = "X"   # ran well, but its trajectory error is above the limit
MEANINGS = {TOO_WRONG: "trajectory error above the limit", NOT_CHOSEN: "ran, but no step was chosen as best"}


@dataclass(frozen=True)
class Solver:
    """`family` is shared by the variants of a method; `contestant` is false for backends that are shown but not ranked.
    `solver` is another name's where this is that solver with other settings; `hollow` ones stand beside the ranking.
    `origin` says who offers it: "paper", "project", "literature", "engine" or "elsewhere"."""

    name: str
    label: str
    family: str
    contestant: bool
    solver: str = ""
    hollow: bool = False
    origin: str = "elsewhere"


@dataclass(frozen=True)
class Status:
    letter: str
    meaning: str


@dataclass(frozen=True)
class Legend:
    """Solvers in the order that figures list them in; statuses by name."""

    solvers: dict[str, Solver]
    statuses: dict[str, Status]

    def competes(self, solver: str) -> bool:
        return solver not in self.solvers or self.solvers[solver].contestant

    def ranked(self, solver: str) -> bool:
        """Hollow ones compete, but beside the ranking."""
        return self.competes(solver) and not (solver in self.solvers and self.solvers[solver].hollow)

    def at_any_settings(self, solver: str) -> str:
        """Whose curve its runs belong to where settings are free: of a hollow one, its solver's."""
        return self.solvers[solver].solver if solver in self.solvers and self.solvers[solver].hollow else solver

    def label(self, solver: str) -> str:
        return self.solvers[solver].label if solver in self.solvers else clean(solver.replace("_", " "))

    def letter(self, status: str) -> str:
        """Letter of a run that is not shown. One that ended well has none."""
        return NOT_CHOSEN if status == OK else self.statuses[status].letter

    def key(self, letters: Iterable[str], more: dict[str, str] = MEANINGS) -> str:
        """What the letters mean; a letter that two statuses share has both meanings."""
        meanings: dict[str, list[str]] = {}
        for letter, meaning in [(s.letter, s.meaning) for s in self.statuses.values()] + list(more.items()):
            meanings.setdefault(letter, []).append(meaning)
        wanted = set(letters)
        return ", ".join(f"{letter} = {' or '.join(known)}" for letter, known in meanings.items() if letter in wanted)


def legend_of(document: Json) -> Legend:
    given = document.get("legend", {})
    if not isinstance(given, dict):
        raise ResultError("the file's legend is not an object")
    solvers = {entry["name"]: _solver(entry) for entry in _entries(given, "solvers")}
    statuses = {entry["name"]: _status(entry) for entry in _entries(given, "statuses")}
    for name in sorted({point["status"] for point in points_of(document)}):
        if name not in statuses and name != OK:
            statuses[name] = made_up(name)
    statuses.pop(OK, None)
    return Legend(solvers, statuses)


def merged(legends: Iterable[Legend]) -> Legend:
    """Legend of several files: the first one's, then what only later ones have."""
    solvers: dict[str, Solver] = {}
    statuses: dict[str, Status] = {}
    for legend in legends:
        for known, more in ((solvers, legend.solvers), (statuses, legend.statuses)):
            for name, entry in more.items():
                known.setdefault(name, entry)
    return Legend(solvers, statuses)


def _entries(legend: Json, what: str) -> list[Json]:
    entries = legend.get(what, [])
    if not isinstance(entries, list) or not all(isinstance(e, dict) and isinstance(e.get("name"), str) for e in entries):
        raise ResultError(f"the file's legend.{what} is not a list of objects with names")
    return entries


def _solver(entry: Json) -> Solver:
    name, label, family = entry["name"], entry.get("label"), entry.get("family")
    return Solver(name, clean(label if label else name.replace("_", " ")), family if isinstance(family, str) else name,
                  entry.get("contestant") is not False, entry["solver"] if isinstance(entry.get("solver"), str) else "",
                  entry.get("unranked") is True, entry["origin"] if isinstance(entry.get("origin"), str) else "elsewhere")


def _status(entry: Json) -> Status:
    given = made_up(entry["name"])
    letter, meaning = entry.get("letter"), entry.get("meaning")
    return Status(clean(letter)[:1] if letter and clean(letter) else given.letter, clean(meaning) if meaning else given.meaning)


def made_up(name: str) -> Status:
    """Letter of a status that no legend explains."""
    words = clean(name.replace("_", " "))
    return Status(words[:1].upper() or NOT_CHOSEN, words)
