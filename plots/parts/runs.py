"""The runs of a step sweep: each one's time, error and residuals, and which steps failed."""

from dataclasses import dataclass, field

from parts.result import Json, Result, seconds_of
from parts.words import place_part

Series = list[list[float]]  # rows of time, residual after the first iteration, after the last


@dataclass(frozen=True)
class Run:
    """One run of a step sweep that reached its end. `sure` is false for an error below three times the reference's own."""

    seconds: float
    step: float
    error: float
    sure: bool


@dataclass
class StepSweep:
    """All runs of a step sweep on one scene, by solver; residuals by strain limit and step."""

    scene: str
    vertices: int
    points: list[Json]
    name: str  # the scene as part of a file's name
    runs: dict[str, list[Run]] = field(default_factory=dict)
    residuals: dict[str, dict[float, dict[float, Series]]] = field(default_factory=dict)


def step_sweeps_in(result: Result) -> list[StepSweep]:
    """One entry per scene and size that has a step sweep, of the solvers that are ranked: the others have no error to show.
    Runs with untuned settings count as the solver's own, because settings are tuned for strain, not for error."""
    groups: dict[tuple[str, int], list[Json]] = {}
    for point in result.points:
        if point["sweep"] == "step" and result.known(result.at_any_settings(point["contestant"])).contestant:
            groups.setdefault((point["scene"], point["vertices"]), []).append(point)
    places = [{"scene": scene, "vertices": vertices} for scene, vertices in groups]
    sweeps = []
    for scene, vertices in sorted(groups):
        sweep = StepSweep(scene, vertices, groups[scene, vertices], place_part({"scene": scene, "vertices": vertices}, places))
        sweeps.append(sweep)
        for point in sweep.points:
            solver, step, error, seconds = result.at_any_settings(point["contestant"]), point["step"], point["error"], seconds_of(point)
            own = sweep.runs.setdefault(solver, [])
            if point["status"] != "ok" or seconds is None:
                continue
            if error["trajectory"]:
                own.append(Run(seconds, step, error["trajectory"], error["trajectory"] >= 3 * (error["gap"] or 0)))
            if error.get("residuals"):
                sweep.residuals.setdefault(solver, {}).setdefault(point["strain_limit"], {})[step] = error["residuals"]
    return sweeps


def cheapest(runs: list[Run]) -> list[Run]:
    """Those that no other run beats in both error and time, from the smallest error to the largest."""
    front: list[Run] = []
    for run in sorted(runs, key=lambda run: (run.error, run.seconds)):
        if not front or run.seconds < front[-1].seconds:
            front.append(run)
    return front
