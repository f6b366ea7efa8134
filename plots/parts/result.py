"""A result file that `bench` has checked, with what it says of it: the analysis of a sweep, and the legend of its solvers."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Iterable

from parts.words import clean

Json = dict[str, Any]
Figures = list[tuple]  # of a file: the name of each, the function that draws it, and its arguments

MORE_LETTERS = {"X": "trajectory error above the limit", "L": "the ladder ended"}  # of runs that are ok


@dataclass(frozen=True)
class Solver:
    """`family` is shared by the variants of a method; `contestant` is false for backends that are shown but not ranked. `solver` is
    the name of the solver that this one is with other settings; `unranked` ones stand beside the ranking. `origin` says who offers
    it: "paper", "project", "literature", "engine" or "elsewhere"."""

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
        self.solvers = {entry["name"]: Solver(**{key: entry[key] for key in fields if key in entry})
                        for entry in document["legend"]["solvers"]}

    @cached_property
    def points(self) -> list[Json]:
        """Without the second of an A/A pair, which shows in the noise."""
        double = self.noise.get("pair", (None, None))[1]
        return [point for point in self.document.get("points", []) if point["contestant"] != double]

    @property
    def noise_factor(self) -> float | None:
        """95 % of the times of an A/A pair are within this factor of each other."""
        return math.exp(self.noise["q95"]) if self.noise.get("q95") is not None else None

    def leaders(self, scene: str, sweep: str) -> set[str] | None:
        """Those that are first somewhere, or of the paper; None: runs with a step controller are not ranked."""
        planes = [plane for plane in self.analysis["planes"] if (plane["scene"], plane["sweep"]) == (scene, sweep)]
        return {name for plane in planes for name in plane["leaders"]} or None

    def finding(self, scene: str, sweep: str, vertices: float | None = None) -> list[str]:
        """The program's sentences on a scene; vertices: of one size."""
        return next((finding["sentences"] for finding in self.analysis["findings"]
                     if (finding["scene"], finding["sweep"]) == (scene, sweep) and vertices in (None, finding["vertices"])), [])

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
        meanings = {**{status["letter"]: status["meaning"] for status in self.statuses if status["letter"]}, **MORE_LETTERS}
        return ", ".join(f"{clean(letter)} = {clean(meaning)}" for letter, meaning in meanings.items() if letter in set(letters))


def seconds_of(point: Json) -> float | None:
    """The time that counts: the least sample."""
    timing = point["seconds_per_simulated_second"]
    return timing["min"] if timing else None
