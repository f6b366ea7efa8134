"""Reads a result file of schema inextensible-bench/1 and sorts its points into the curves of the figures."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

SCHEMA = "inextensible-bench/1"
STABILITY_SCHEMA = "inextensible-stability/1"
COST_SWEEPS = ("strain", "resolution")
SWEEPS = (*COST_SWEEPS, "step")
NUMBERS_OF_THE_PAPER = {"chain": "4", "drape": "5"}

# How a failure is written into a figure, and explained under it.
LETTERS = {
    "timeout": "T", "diverged": "D", "not_converged": "N", "strain_missed": "S", "unsupported": "U",
    "out_of_memory": "O", "crashed": "C", "skipped": "K",
}
TOO_WRONG = "E"   # ran well, but its trajectory error is above the limit
NOT_CHOSEN = "?"  # ran well, yet no step was marked best: an interrupted search, or an error that is not known

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
    """What one figure of cost shows. `fixed` is the axis that is not swept: vertices or strain limit. `max_error`: only
    runs within this trajectory error count."""

    scene: str
    sweep: str
    fixed: float
    points: list[Json]
    curves: dict[str, Curve]
    name: str = ""
    max_error: float | None = None


@dataclass(frozen=True)
class Run:
    """One run of a step sweep that reached its end. `sure` is false for an error below three times the reference's own."""

    seconds: float
    step: float
    limit: float
    error: float
    sure: bool


@dataclass
class RunsData:
    """All runs of a step sweep on one scene. Failures: step, limit and letter; residuals by limit and step."""

    scene: str
    vertices: int
    points: list[Json]
    runs: dict[str, list[Run]]
    failures: dict[str, list[tuple[float, float, str]]]
    residuals: dict[float, dict[float, list[list[float]]]]
    suffix: str = ""


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
    if isinstance(document, dict) and document.get("schema") == STABILITY_SCHEMA:
        _check_stability(document, path)
        return document
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


def _check_stability(document: Json, path: Path) -> None:
    for name, keys in (("matrix", ("row", "case", "solver", "outcome")), ("largest_steps", ("scene", "solver"))):
        entries = document.get(name)
        if not isinstance(entries, list):
            raise ResultError(f"{path} has no list of {name}")
        for number, entry in enumerate(entries):
            if not isinstance(entry, dict) or not all(isinstance(entry.get(key), str) for key in keys):
                raise ResultError(f"{path}: {name}[{number}] needs the texts {', '.join(keys)}")


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
    """One entry per (scene, sweep) and value of the axis that stays fixed, in a fixed order; with an error limit another
    one of the points that respect it."""
    groups: dict[tuple[str, str, float], list[Json]] = {}
    for point in document["points"]:
        if point.get("sweep") in COST_SWEEPS:
            fixed = point["vertices"] if point["sweep"] == "strain" else point["strain_limit"]
            groups.setdefault((point["scene"], point["sweep"], fixed), []).append(point)

    max_error = error_limit_of(document)
    order = sorted(groups, key=lambda key: (key[0], COST_SWEEPS.index(key[1]), key[2]))
    figures = []
    for scene, sweep, fixed in order:
        points = groups[scene, sweep, fixed]
        alone = sum(key[:2] == (scene, sweep) for key in order) == 1
        name = _file_part(scene, sweep, fixed, alone) + ("-adaptive" if adaptive(points) else "")
        axis = "strain_limit" if sweep == "strain" else "vertices"
        figures.append(FigureData(scene, sweep, fixed, points, _curves(points, axis, None), name))
        if max_error is not None:
            curves = _curves(points, axis, max_error)
            figures.append(FigureData(scene, sweep, fixed, points, curves, f"{name}-equal-error", max_error))
    return figures


def adaptive(points: list[Json]) -> bool:
    """Whether a step controller chose the steps."""
    return any(point.get("adaptive") is True for point in points)


def error_limit_of(document: Json) -> float | None:
    context = document.get("context")
    suite = context.get("suite") if isinstance(context, dict) else None
    limit = suite.get("max_error") if isinstance(suite, dict) else None
    return float(limit) if is_number(limit) and limit > 0 else None


def runs_in(document: Json) -> list[RunsData]:
    """One entry per scene and size that has a step sweep."""
    groups: dict[tuple[str, int], list[Json]] = {}
    for point in document["points"]:
        if point.get("sweep") == "step":
            groups.setdefault((point["scene"], point["vertices"]), []).append(point)
    entries = []
    for scene, vertices in sorted(groups):
        points = groups[scene, vertices]
        alone = sum(key[0] == scene for key in groups) == 1
        entries.append(_runs_data(scene, vertices, points, "" if alone else f"-n{vertices}"))
    return entries


def _runs_data(scene: str, vertices: int, points: list[Json], suffix: str) -> RunsData:
    data = RunsData(scene, vertices, points, {}, {}, {}, suffix)
    for point in points:
        step, limit, seconds = point.get("step"), float(point["strain_limit"]), median_of(point)
        if not is_number(step) or step <= 0:
            continue
        runs = data.runs.setdefault(point["solver"], [])
        error = point.get("error") if isinstance(point.get("error"), dict) else {}
        distance, gap = error.get("trajectory"), error.get("gap")
        if point["status"] != "ok" or seconds is None:
            letter = LETTERS.get(point["status"], NOT_CHOSEN)
            data.failures.setdefault(point["solver"], []).append((float(step), limit, letter))
        elif is_number(distance) and distance > 0:
            sure = not is_number(gap) or distance >= 3 * gap
            runs.append(Run(seconds, float(step), limit, float(distance), sure))
        series = error.get("residuals")
        if point["status"] == "ok" and point["solver"] == "fast_projection" and isinstance(series, list) and series:
            data.residuals.setdefault(limit, {})[float(step)] = series
    return data


def cheapest(runs: list[Run]) -> list[Run]:
    """Those that no other run beats in both error and time, from the smallest error to the largest."""
    front: list[Run] = []
    for run in sorted(runs, key=lambda run: (run.error, run.seconds)):
        if not front or run.seconds < front[-1].seconds:
            front.append(run)
    return front


def _file_part(scene: str, sweep: str, fixed: float, alone: bool) -> str:
    """"figure4a" for the scenes of the paper, "<scene>-<sweep>" for others; the fixed value only where two would clash."""
    number = NUMBERS_OF_THE_PAPER.get(scene)
    safe_scene = "".join(c if c.isalnum() or c in "-_" else "_" for c in scene)
    name = f"figure{number}{'a' if sweep == 'strain' else 'b'}" if number else f"{safe_scene}-{sweep}"
    if alone:
        return name
    return f"{name}-n{fixed:g}" if sweep == "strain" else f"{name}-strain{fixed:g}"


def _curves(points: list[Json], axis: str, max_error: float | None) -> dict[str, Curve]:
    tried: dict[tuple[str, float], list[Json]] = {}
    for point in points:
        tried.setdefault((point["solver"], float(point[axis])), []).append(point)
    curves: dict[str, Curve] = {}
    for (solver, x), runs in sorted(tried.items(), key=lambda item: item[0]):
        curve = curves.setdefault(solver, Curve())
        best = best_of(runs, solver) if max_error is None else best_at_error(runs)
        if best:
            curve.best.append(_as_best(x, best))
        else:
            curve.failures.append(Failure(x, failure_letters(runs, max_error)))
    return curves


def best_of(runs: list[Json], solver: str) -> Json | None:
    """The point that the harness marked. The null solver keeps no strain limit, so its fastest run will do."""
    marked = [run for run in runs if run.get("best") is True]
    if not marked and solver == "null":
        marked = [run for run in runs if run["status"] in ("ok", "strain_missed") and median_of(run) is not None]
    return min(marked, key=lambda run: median_of(run) or math.inf, default=None)


def best_at_error(runs: list[Json]) -> Json | None:
    marked = [run for run in runs if run.get("best_at_error") is True and median_of(run) is not None]
    return min(marked, key=lambda run: median_of(run) or math.inf, default=None)


def _as_best(x: float, point: Json) -> Best:
    timing = point["seconds_per_simulated_second"]
    median = float(timing["median"])
    q1, q3 = (float(timing[key]) if is_number(timing.get(key)) else median for key in ("q1", "q3"))
    return Best(x, median, min(q1, median), max(q3, median), _step_of(point))


def _step_of(point: Json) -> float | None:
    """Adaptive runs: the mean of the accepted steps."""
    steps = point["work"].get("steps") if isinstance(point.get("work"), dict) else None
    if point.get("adaptive") is True and is_number(steps) and steps > 0 and is_number(point.get("duration")):
        return float(point["duration"]) / float(steps)
    step = point.get("step")
    return float(step) if is_number(step) and step > 0 else None


def failure_letters(runs: list[Json], max_error: float | None = None) -> str:
    """"D" if every step diverged, "DT" if the coarse ones diverged and the fine ones took too long."""
    def step_of(run: Json) -> float:
        return run["step"] if is_number(run.get("step")) else 0.0

    def letter_of(run: Json) -> str:
        error = run["error"].get("trajectory") if isinstance(run.get("error"), dict) else None
        if max_error is not None and run["status"] == "ok" and is_number(error) and error > max_error:
            return TOO_WRONG
        return LETTERS.get(run["status"], NOT_CHOSEN)

    letters = ""
    for run in sorted(runs, key=step_of, reverse=True):
        letters += "" if letter_of(run) in letters else letter_of(run)
    return letters
