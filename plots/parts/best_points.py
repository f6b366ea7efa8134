"""The curves of the figures of cost: the best point of each solver at each place of an axis, and how the others failed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from parts.legend import TOO_WRONG, Legend
from parts.result_file import (OK, Json, contestant_of, is_number, time_in, spread_in, time_of, object_in, points_of,
                               positive)
from parts.words import file_part, scene_words

NUMBERS_OF_THE_PAPER = {"chain": "4", "drape": "5"}
HEADLINE = 0.02  # of the scene's size: the level of error of headlines (docs/measuring.md)
AXES = {"strain": "strain_limit", "resolution": "vertices"}

TIME, FILTER_TIME = "seconds_per_simulated_second", "filter_seconds_per_simulated_second"


@dataclass(frozen=True)
class Best:
    """The best run of one solver at one x, at its strain limit or a tighter one; its least sample. `low` to `high` is from there to the median of the samples, where
    there are three. `ladder_end`: 1 if the step is the coarsest of those tried, -1 if the finest, else 0."""

    x: float
    seconds: float
    low: float
    high: float
    step: float | None
    ladder_end: int = 0


@dataclass(frozen=True)
class Failure:
    """No step's run counts at this x, nor at a tighter limit; `letters` say why, from the coarsest step to the finest."""

    x: float
    letters: str


@dataclass
class Curve:
    """`filter` holds the inextensibility filter's part of the best points, as far as it was timed."""

    best: list[Best] = field(default_factory=list)
    failures: list[Failure] = field(default_factory=list)
    filter: list[Best] = field(default_factory=list)


@dataclass
class FigureData:
    """What one panel of a figure of cost shows. `fixed` is the axis that is not swept: vertices or strain limit. `level`: only
    runs within this error count; None: whatever their motion. `within`: the panel beside it, of the headline's error."""

    scene: str
    sweep: str
    fixed: float
    points: list[Json]
    curves: dict[str, Curve]
    name: str = ""
    level: float | None = None
    within: FigureData | None = None

    @property
    def has_filter(self) -> bool:
        """Whether the filter's own time is worth a panel: a collider takes part, and it was timed."""
        return any(curve.filter for curve in self.curves.values()) and any(with_collider(p) for p in self.points)

    @property
    def adaptive(self) -> bool:
        """Whether a step controller chose the steps."""
        return any(point.get("adaptive") is True for point in self.points)

    def xs(self) -> list[float]:
        return sorted({entry.x for curve in self.curves.values() for entry in (*curve.best, *curve.failures)})


def sweeps_in(document: Json, legend: Legend, sweep: str) -> list[FigureData]:
    """One entry per scene and value of the axis that stays fixed, in a fixed order; where errors are known it has a second
    panel of the runs that are right to the headline's level."""
    groups: dict[tuple[str, float], list[Json]] = {}
    for point in points_of(document):
        if point["sweep"] == sweep:
            fixed = point["vertices"] if sweep == "strain" else point["strain_limit"]
            groups.setdefault((point["scene"], fixed), []).append(point)
    chosen = Chosen(document)
    figures = []
    for scene, fixed in sorted(groups):
        points = groups[scene, fixed]
        alone = sum(key[0] == scene for key in groups) == 1
        of_scene = [point for key, group in groups.items() if key[0] == scene for point in group]
        data = FigureData(scene, sweep, fixed, points, _curves(points, of_scene, AXES[sweep], None, legend, chosen))
        data.name = _file_part(scene, sweep, fixed, alone) + ("-adaptive" if data.adaptive else "")
        if any(chosen.has(point, HEADLINE) for point in points):
            curves = _curves(points, of_scene, AXES[sweep], HEADLINE, legend, chosen)
            data.within = FigureData(scene, sweep, fixed, points, curves, data.name, HEADLINE)
        figures.append(data)
    return figures


def with_collider(point: Json) -> bool:
    return is_number(point.get("max_strain_after_collision"))


def delivered_strain(point: Json) -> float | None:
    """The largest strain after the collision filter."""
    return float(point["max_strain_after_collision"]) if with_collider(point) else None


def number_in_paper(scene: str, sweep: str) -> str:
    """"4a" for the chain over strain; "" for scenes that the paper does not have."""
    number = NUMBERS_OF_THE_PAPER.get(scene, "")
    return number and number + {"strain": "a", "resolution": "b"}[sweep]


def _file_part(scene: str, sweep: str, fixed: float, alone: bool) -> str:
    """"figure4a" for the scenes of the paper, "<scene>-<sweep>" for others; the fixed value only where two would clash."""
    number = number_in_paper(scene, sweep)
    name = f"figure{number}" if number else f"{file_part(scene_words(scene))}-{sweep}"
    if alone:
        return name
    return f"{name}-n{fixed:g}" if sweep == "strain" else f"{name}-strain{fixed:g}"


class Chosen:
    """Which runs stand for their contestants at a level of error: as the program's analysis says, where the document has it,
    else as the sweep marked them."""

    def __init__(self, document: Json) -> None:
        analysis = document.get("analysis")
        self._ids: set[tuple[float | None, str, str]] | None = None
        if isinstance(analysis, dict):
            self._ids = {(cell["error_level"], plane["sweep"], entry["id"]) for plane in analysis["planes"]
                         for cell in plane["cells"] for entry in cell["entries"]}

    def has(self, point: Json, level: float | None) -> bool:
        if self._ids is not None and point.get("adaptive") is not True:
            return (level, point["sweep"], point.get("id")) in self._ids
        if level is None:
            return point.get("best") is True
        marks = point.get("best_at_errors")
        return isinstance(marks, list) and level in marks


def _curves(points: list[Json], of_scene: list[Json], axis: str, level: float | None, legend: Legend,
            chosen: Chosen) -> dict[str, Curve]:
    tried: dict[tuple[str, float], list[Json]] = {}
    for point in points:
        tried.setdefault((contestant_of(point), float(point[axis])), []).append(point)
    curves: dict[str, Curve] = {}
    for (solver, x), runs in sorted(tried.items(), key=lambda item: item[0]):
        curve = curves.setdefault(solver, Curve())
        counting = [*runs, *_tighter(runs[0], of_scene)]
        best = best_of(counting, level, legend.competes(solver), chosen)
        if best:
            _add_best(curve, x, best)
        elif not any(_counts(run, level) for run in counting):
            curve.failures.append(Failure(x, failure_letters(runs, legend, level)))
    return curves


def _tighter(run: Json, of_scene: list[Json]) -> list[Json]:
    """The contestant's runs at tighter limits: they keep this one's as well."""
    return [other for other in of_scene if contestant_of(other) == contestant_of(run) and other["vertices"] == run["vertices"]
            and other["strain_limit"] < run["strain_limit"]]


def _counts(run: Json, level: float | None) -> bool:
    return run["status"] == OK and not _too_wrong(run, level)


def _too_wrong(run: Json, level: float | None) -> bool:
    error = object_in(run, "error").get("trajectory")
    return level is not None and is_number(error) and error > level


def _add_best(curve: Curve, x: float, point: Json) -> None:
    curve.best.append(_as_best(x, point, TIME))
    if time_in(point, FILTER_TIME) is not None:
        curve.filter.append(_as_best(x, point, FILTER_TIME))


def best_of(runs: list[Json], level: float | None, competes: bool, chosen: Chosen) -> Json | None:
    """The point that the program chose. Who does not compete keeps no strain limit, so the fastest run will do."""
    marked = [run for run in runs if chosen.has(run, level)]
    if not marked and not competes:
        marked = [run for run in runs if time_of(run) is not None]
    return min(marked, key=lambda run: time_of(run) or math.inf, default=None)


def _as_best(x: float, point: Json, key: str) -> Best:
    time = time_in(point, key) or math.nan
    low, high = spread_in(point, key) or (time, time)
    end = {"coarsest": 1, "finest": -1}.get(point.get("at_ladder_end"), 0)
    return Best(x, time, low, high, _step_of(point), end)


def _step_of(point: Json) -> float | None:
    """Adaptive runs: the mean of the accepted steps."""
    steps = object_in(point, "work").get("steps")
    if point.get("adaptive") is True and positive(steps) and positive(point.get("duration")):
        return float(point["duration"]) / float(steps)
    return float(point["step"]) if positive(point.get("step")) else None


def failure_letters(runs: list[Json], legend: Legend, level: float | None = None) -> str:
    """"D" if every step diverged, "DT" if the coarse ones diverged and the fine ones took too long."""
    def letter_of(run: Json) -> str:
        return TOO_WRONG if run["status"] == OK and _too_wrong(run, level) else legend.letter(run["status"])

    return "".join(dict.fromkeys(letter_of(run) for run in sorted(runs, key=_step_or_zero, reverse=True)))


def _step_or_zero(run: Json) -> float:
    return run["step"] if is_number(run.get("step")) else 0.0
