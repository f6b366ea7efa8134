"""A result file that `bench` has checked, with what it says of it: the analysis of a sweep, and the legend of its solvers."""

import math
import re
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Iterable

from parts.words import clean, short, spoken

Json = dict[str, Any]
Figures = list[tuple]  # of a file: the name of each, the function that draws it, and its arguments

TOO_WRONG = {"X": "trajectory error above the limit"}  # of runs that are ok


@dataclass(frozen=True)
class Solver:
    """`family` is shared by the variants of a method; `contestant` is false for backends that are shown but not ranked. `solver` is
    the name of the solver that this one is with other settings; `unranked` ones stand beside the ranking. `origin` says whose method
    it is: "paper", "project", "literature", "engine" or "elsewhere", a plug-in."""

    name: str
    label: str
    family: str
    contestant: bool = True
    solver: str = ""
    unranked: bool = False
    origin: str = "elsewhere"


class Result:
    def __init__(self, document: Json) -> None:
        self.document = document
        self.context: Json = document["context"]
        self.suite: Json = self.context.get("suite", {})
        self.analysis: Json = document.get("analysis", {})
        self.noise: Json = self.context.get("noise") or {}
        self.statuses: list[Json] = document["legend"]["statuses"]
        fields = Solver.__dataclass_fields__
        origins = {entry["name"]: entry.get("origin", "elsewhere") for entry in document["legend"]["solvers"]}
        self.solvers = {name: Solver(**{key: entry[key] for key in fields if key in entry} |
                                     {"label": spoken(entry["label"]), "origin": origins.get(name.split("@")[0], origins[name])})
                        for entry in document["legend"]["solvers"] for name in [entry["name"]]}

    @cached_property
    def points(self) -> list[Json]:
        """Without the second of an A/A pair, which shows in the noise."""
        double = self.noise.get("pair", (None, None))[1]
        return [point for point in self.document.get("points", []) if point["contestant"] != double]

    def leaders(self, scene: str, sweep: str) -> set[str] | None:
        """Those that are first somewhere, or of the paper; None: runs with a step controller are not ranked."""
        planes = [plane for plane in self.analysis["planes"] if (plane["scene"], plane["sweep"]) == (scene, sweep)]
        return {name for plane in planes for name in plane["leaders"]} or None

    def headline(self, subject: str, scene: str, sweep: str, vertices: float | None = None) -> str:
        """A figure's title: the program's first sentence on a scene (vertices: of one size), with labels in place of names, and
        without what the fastest run was like."""
        found = next((finding["sentences"][0] for finding in self.analysis["findings"]
                      if (finding["scene"], finding["sweep"]) == (scene, sweep) and vertices in (None, finding["vertices"])), "")
        words = re.sub(r": [^;]*(;|\.$)", r"\1", found.replace(" with other settings", "")).rstrip(".")
        words = re.sub(r"; (.+), the best of the paper's six, takes", r"; the paper's best, \1, takes", re.sub(r" \([^)]*\) times", " times", words))
        return f"{subject[:1].upper()}{subject[1:]}. {re.sub(r'[a-z0-9_@]+', lambda name: self.title(name[0]), words)}".rstrip(". ")

    def title(self, name: str) -> str:
        """A solver's label without the words in parentheses; other words as they are."""
        return short(self.label(name)) if name in self.solvers else name

    def few(self, names: Iterable[str], times: dict[str, float]) -> list[str]:
        """At most eight, and plug-ins: the paper's six, the fastest of this project and the fastest of all others."""
        groups: dict[str, list[str]] = {"paper": [], "elsewhere": [], "project": [], "others": []}
        for name in names:
            solver = self.known(name)
            if solver.contestant:
                own = solver.origin in ("project", "elsewhere") or solver.origin == "paper" and "@" not in name
                groups[solver.origin if own else "others"].append(name)
        best = [min(groups[group], key=lambda name: times.get(name, math.inf)) for group in ("project", "others") if groups[group]]
        return [*groups["paper"], *groups["elsewhere"], *best]

    def known(self, name: str) -> Solver:
        """A name that the legend lacks is a family of its own."""
        return self.solvers.get(name) or Solver(name, name.replace("_", " "), name)

    def label(self, name: str) -> str:
        return clean(self.known(name).label)

    def at_any_settings(self, name: str) -> str:
        """The solver to which an unranked contestant's runs belong where settings are free."""
        return self.known(name).solver if self.known(name).unranked else name

    def key(self, letters: Iterable[str]) -> str:
        """What the letters of failures mean."""
        meanings = {**{status["letter"]: status["meaning"] for status in self.statuses if status["letter"]}, **TOO_WRONG}
        return ", ".join(f"{clean(letter)} = {clean(meaning)}" for letter, meaning in meanings.items() if letter in set(letters))


def seconds_of(point: Json) -> float | None:
    """The time that counts: the least sample."""
    timing = point["seconds_per_simulated_second"]
    return timing["min"] if timing else None
