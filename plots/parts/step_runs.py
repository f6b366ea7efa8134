"""The runs of a step sweep: each one's time, error and residuals, and which steps failed."""

from __future__ import annotations

from dataclasses import dataclass, field

from parts.legend import Legend
from parts.result_file import OK, Json, contestant_of, is_number, time_of, object_in, points_of, positive
from parts.style import SolverStyle, styles_for
from parts.words import file_part, scene_words

Series = list[list[float]]  # rows of time, residual after the first iteration, after the last


@dataclass(frozen=True)
class Run:
    """One run of a step sweep that reached its end. `sure` is false for an error below three times the reference's own."""

    seconds: float
    step: float
    limit: float
    error: float
    sure: bool


@dataclass(frozen=True)
class FailedStep:
    step: float
    limit: float
    letter: str


@dataclass
class RunsData:
    """All runs of a step sweep on one scene, by solver; residuals by solver, strain limit and step."""

    scene: str
    vertices: int
    points: list[Json]
    name: str  # the scene as part of a file's name
    runs: dict[str, list[Run]] = field(default_factory=dict)
    failures: dict[str, list[FailedStep]] = field(default_factory=dict)
    residuals: dict[str, dict[float, dict[float, Series]]] = field(default_factory=dict)

    def all_runs(self) -> list[Run]:
        return [run for runs in self.runs.values() for run in runs]


def step_sweeps_in(document: Json, legend: Legend) -> list[RunsData]:
    """One entry per scene and size that has a step sweep, of the solvers that are ranked: the others have no error to show.
    Runs with untuned settings count as the solver's own, because settings are tuned for strain, not for error."""
    groups: dict[tuple[str, int], list[Json]] = {}
    for point in points_of(document):
        if point["sweep"] == "step" and legend.ranked(legend.at_any_settings(contestant_of(point))):
            groups.setdefault((point["scene"], point["vertices"]), []).append(point)
    entries = []
    for scene, vertices in sorted(groups):
        alone = sum(key[0] == scene for key in groups) == 1
        name = file_part(scene_words(scene)) + ("" if alone else f"-n{vertices:g}")
        data = RunsData(scene, vertices, groups[scene, vertices], name)
        for point in data.points:
            if positive(point.get("step")):
                _add(data, point, legend)
        entries.append(data)
    return entries


def _add(data: RunsData, point: Json, legend: Legend) -> None:
    solver, seconds = legend.at_any_settings(contestant_of(point)), time_of(point)
    step, limit = float(point["step"]), float(point["strain_limit"])
    runs = data.runs.setdefault(solver, [])
    error = object_in(point, "error")
    distance, gap = error.get("trajectory"), error.get("gap")
    if point["status"] != OK or seconds is None:
        data.failures.setdefault(solver, []).append(FailedStep(step, limit, legend.letter(point["status"])))
    elif positive(distance):
        sure = not is_number(gap) or distance >= 3 * gap
        runs.append(Run(seconds, step, limit, float(distance), sure))
    series = _series(error.get("residuals"))
    if point["status"] == OK and series:
        data.residuals.setdefault(solver, {}).setdefault(limit, {})[step] = series


def _series(rows: object) -> Series:
    """Rows of three numbers; anything else is no series."""
    if not isinstance(rows, list):
        return []
    return [row for row in rows if isinstance(row, list) and len(row) == 3 and all(is_number(value) for value in row)]


def styles_of(data: RunsData, legend: Legend) -> dict[str, SolverStyle]:
    return styles_for({*data.runs, *data.failures}, legend)


def cheapest(runs: list[Run]) -> list[Run]:
    """Those that no other run beats in both error and time, from the smallest error to the largest."""
    front: list[Run] = []
    for run in sorted(runs, key=lambda run: (run.error, run.seconds)):
        if not front or run.seconds < front[-1].seconds:
            front.append(run)
    return front
