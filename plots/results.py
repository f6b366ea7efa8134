"""Reads a result file of schema inextensible-bench/1 and sorts its points into the curves of the figures."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

SCHEMA = "inextensible-bench/1"
SWEEPS = ("strain", "resolution")
NUMBERS_OF_THE_PAPER = {"chain": "4", "drape": "5"}

# How a failure is written into a figure, and explained under it.
LETTERS = {
    "timeout": "T", "diverged": "D", "not_converged": "N", "strain_missed": "S", "unsupported": "U",
    "out_of_memory": "O", "crashed": "C", "skipped": "K",
}
NOT_CHOSEN = "?"  # ran well, yet no step was marked best: an interrupted search, or an error limit that was missed

Json = dict[str, Any]


class ResultError(Exception):
    """The file cannot be drawn; the message is one line for the user."""


@dataclass(frozen=True)
class Best:
    """The best run of one solver at one x."""

    x: float
    seconds: float
    q1: float
    q3: float
    step: float | None


@dataclass(frozen=True)
class Failure:
    """All steps failed at this x; `letters` say how, from the coarsest step to the finest."""

    x: float
    letters: str


@dataclass
class Curve:
    best: list[Best] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)


@dataclass
class FigureData:
    """What one figure shows. `fixed` is the axis that is not swept: vertices or strain limit."""

    scene: str
    sweep: str
    fixed: float
    points: list[Json]
    curves: dict[str, Curve]
    name: str = ""


def load(path: Path) -> Json:
    """The parsed file, with every point that a figure needs checked."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not a text file"
        raise ResultError(f"cannot read {path}: {reason}") from error
    try:
        document = json.loads(text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{path} is not valid JSON: {error}") from error
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        found = document.get("schema") if isinstance(document, dict) else None
        raise ResultError(f"{path} is not a result file: schema is {json.dumps(found)}, expected \"{SCHEMA}\"")
    points = document.get("points")
    if not isinstance(points, list):
        raise ResultError(f"{path} has no list of points")
    for number, point in enumerate(points):
        if not isinstance(point, dict):
            raise ResultError(f"{path}: points[{number}] is not an object")
        if point.get("sweep") in SWEEPS:
            _check(point, f"{path}: points[{number}]")
    return document


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a JSON number")


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _check(point: Json, where: str) -> None:
    """Only what the drawing relies on; configs/result.schema.json is the full description."""
    for key in ("scene", "solver", "status"):
        if not isinstance(point.get(key), str) or not point[key]:
            raise ResultError(f"{where} has no {key}")
    for key in ("vertices", "strain_limit"):
        if not is_number(point.get(key)) or point[key] <= 0:
            raise ResultError(f"{where} needs a positive number as {key}")
    if point.get("best") is True and median_of(point) is None:
        raise ResultError(f"{where} is marked best but has no positive median of seconds_per_simulated_second")


def median_of(point: Json) -> float | None:
    timing = point.get("seconds_per_simulated_second")
    median = timing.get("median") if isinstance(timing, dict) else None
    return float(median) if is_number(median) and median > 0 else None


def figures_in(document: Json) -> list[FigureData]:
    """One entry per (scene, sweep) and value of the axis that stays fixed, in a fixed order."""
    groups: dict[tuple[str, str, float], list[Json]] = {}
    for point in document["points"]:
        if point.get("sweep") in SWEEPS:
            fixed = point["vertices"] if point["sweep"] == "strain" else point["strain_limit"]
            groups.setdefault((point["scene"], point["sweep"], fixed), []).append(point)

    order = sorted(groups, key=lambda key: (key[0], SWEEPS.index(key[1]), key[2]))
    figures = []
    for scene, sweep, fixed in order:
        points = groups[scene, sweep, fixed]
        alone = sum(key[:2] == (scene, sweep) for key in order) == 1
        curves = _curves(points, "strain_limit" if sweep == "strain" else "vertices")
        figures.append(FigureData(scene, sweep, fixed, points, curves, _file_part(scene, sweep, fixed, alone)))
    return figures


def _file_part(scene: str, sweep: str, fixed: float, alone: bool) -> str:
    """"figure4a" for the scenes of the paper, "<scene>-<sweep>" for others; the fixed value only where two would clash."""
    number = NUMBERS_OF_THE_PAPER.get(scene)
    safe_scene = "".join(c if c.isalnum() or c in "-_" else "_" for c in scene)
    name = f"figure{number}{'a' if sweep == 'strain' else 'b'}" if number else f"{safe_scene}-{sweep}"
    if alone:
        return name
    return f"{name}-n{fixed:g}" if sweep == "strain" else f"{name}-strain{fixed:g}"


def _curves(points: list[Json], axis: str) -> dict[str, Curve]:
    tried: dict[tuple[str, float], list[Json]] = {}
    for point in points:
        tried.setdefault((point["solver"], float(point[axis])), []).append(point)
    curves: dict[str, Curve] = {}
    for (solver, x), runs in sorted(tried.items(), key=lambda item: item[0]):
        curve = curves.setdefault(solver, Curve())
        best = best_of(runs, solver)
        if best:
            curve.best.append(_as_best(x, best))
        else:
            curve.failures.append(Failure(x, failure_letters(runs)))
    return curves


def best_of(runs: list[Json], solver: str) -> Json | None:
    """The point that the harness marked. The null solver keeps no strain limit, so its fastest run will do."""
    marked = [run for run in runs if run.get("best") is True]
    if not marked and solver == "null":
        marked = [run for run in runs if run["status"] in ("ok", "strain_missed") and median_of(run) is not None]
    return min(marked, key=lambda run: median_of(run) or math.inf, default=None)


def _as_best(x: float, point: Json) -> Best:
    timing = point["seconds_per_simulated_second"]
    median = float(timing["median"])
    q1, q3 = (float(timing[key]) if is_number(timing.get(key)) else median for key in ("q1", "q3"))
    step = point.get("step")
    return Best(x, median, min(q1, median), max(q3, median), float(step) if is_number(step) and step > 0 else None)


def failure_letters(runs: list[Json]) -> str:
    """"D" if every step diverged, "DT" if the coarse ones diverged and the fine ones took too long."""
    def step_of(run: Json) -> float:
        return run["step"] if is_number(run.get("step")) else 0.0

    letters = ""
    for run in sorted(runs, key=step_of, reverse=True):
        letter = LETTERS.get(run["status"], NOT_CHOSEN)
        letters += "" if letter in letters else letter
    return letters
