"""The curves of the figures of cost: the best point of each solver at each place of an axis, and how the others failed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from parts.legend import TOO_WRONG, Legend
from parts.result_file import OK, Json, contestant_of, is_number, median_of, object_in, points_of, positive, suite_of
from parts.words import file_part

NUMBERS_OF_THE_PAPER = {"chain": "4", "drape": "5"}
AXES = {"strain": "strain_limit", "resolution": "vertices"}


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

    @property
    def adaptive(self) -> bool:
        """Whether a step controller chose the steps."""
        return any(point.get("adaptive") is True for point in self.points)

    def xs(self) -> list[float]:
        return sorted({entry.x for curve in self.curves.values() for entry in (*curve.best, *curve.failures)})


def sweeps_in(document: Json, legend: Legend, sweep: str) -> list[FigureData]:
    """One entry per scene and value of the axis that stays fixed, in a fixed order; with an error limit another one of the
    points that respect it."""
    groups: dict[tuple[str, float], list[Json]] = {}
    for point in points_of(document):
        if point["sweep"] == sweep:
            fixed = point["vertices"] if sweep == "strain" else point["strain_limit"]
            groups.setdefault((point["scene"], fixed), []).append(point)
    max_error = error_limit_of(document)
    figures = []
    for scene, fixed in sorted(groups):
        points = groups[scene, fixed]
        alone = sum(key[0] == scene for key in groups) == 1
        data = FigureData(scene, sweep, fixed, points, _curves(points, AXES[sweep], None, legend))
        data.name = _file_part(scene, sweep, fixed, alone) + ("-adaptive" if data.adaptive else "")
        figures.append(data)
        if max_error is not None:
            curves = _curves(points, AXES[sweep], max_error, legend)
            figures.append(FigureData(scene, sweep, fixed, points, curves, f"{data.name}-equal-error", max_error))
    return figures


def error_limit_of(document: Json) -> float | None:
    limit = suite_of(document).get("max_error")
    return float(limit) if positive(limit) else None


def number_in_paper(scene: str, sweep: str) -> str:
    """"4a" for the chain over strain; "" for scenes that the paper does not have."""
    number = NUMBERS_OF_THE_PAPER.get(scene, "")
    return number and number + {"strain": "a", "resolution": "b"}[sweep]


def _file_part(scene: str, sweep: str, fixed: float, alone: bool) -> str:
    """"figure4a" for the scenes of the paper, "<scene>-<sweep>" for others; the fixed value only where two would clash."""
    number = number_in_paper(scene, sweep)
    name = f"figure{number}" if number else f"{file_part(scene)}-{sweep}"
    if alone:
        return name
    return f"{name}-n{fixed:g}" if sweep == "strain" else f"{name}-strain{fixed:g}"


def _curves(points: list[Json], axis: str, max_error: float | None, legend: Legend) -> dict[str, Curve]:
    tried: dict[tuple[str, float], list[Json]] = {}
    for point in points:
        tried.setdefault((contestant_of(point), float(point[axis])), []).append(point)
    curves: dict[str, Curve] = {}
    for (solver, x), runs in sorted(tried.items(), key=lambda item: item[0]):
        curve = curves.setdefault(solver, Curve())
        best = best_of(runs, legend.competes(solver)) if max_error is None else best_at_error(runs)
        if best:
            curve.best.append(_as_best(x, best))
        else:
            curve.failures.append(Failure(x, failure_letters(runs, legend, max_error)))
    return curves


def best_of(runs: list[Json], competes: bool) -> Json | None:
    """The point that the harness marked. Who does not compete keeps no strain limit, so the fastest run will do."""
    marked = [run for run in runs if run.get("best") is True]
    if not marked and not competes:
        marked = [run for run in runs if median_of(run) is not None]
    return min(marked, key=lambda run: median_of(run) or math.inf, default=None)


def best_at_error(runs: list[Json]) -> Json | None:
    marked = [run for run in runs if run.get("best_at_error") is True and median_of(run) is not None]
    return min(marked, key=lambda run: median_of(run) or math.inf, default=None)


def _as_best(x: float, point: Json) -> Best:
    timing = point["seconds_per_simulated_second"]
    median = float(timing["median"])
    q1, q3 = (float(timing[key]) if positive(timing.get(key)) else median for key in ("q1", "q3"))
    return Best(x, median, min(q1, median), max(q3, median), _step_of(point))


def _step_of(point: Json) -> float | None:
    """Adaptive runs: the mean of the accepted steps."""
    steps = object_in(point, "work").get("steps")
    if point.get("adaptive") is True and positive(steps) and positive(point.get("duration")):
        return float(point["duration"]) / float(steps)
    return float(point["step"]) if positive(point.get("step")) else None


def failure_letters(runs: list[Json], legend: Legend, max_error: float | None = None) -> str:
    """"D" if every step diverged, "DT" if the coarse ones diverged and the fine ones took too long."""
    def step_of(run: Json) -> float:
        return run["step"] if is_number(run.get("step")) else 0.0

    def letter_of(run: Json) -> str:
        error = object_in(run, "error").get("trajectory")
        if max_error is not None and run["status"] == OK and is_number(error) and error > max_error:
            return TOO_WRONG
        return legend.letter(run["status"])

    return "".join(dict.fromkeys(letter_of(run) for run in sorted(runs, key=step_of, reverse=True)))
