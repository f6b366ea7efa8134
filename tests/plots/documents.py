"""Small result files as bench writes them, checked and analysed by bench, and what the tests ask of a drawn figure."""

import copy
import json
import os
import re
import subprocess
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import figures
from parts.result import Result
from parts.style import RC

ROOT = Path(__file__).resolve().parents[2]
BENCH = os.environ.get("BENCH_BINARY", str(ROOT / "build/release/bench"))

Json = dict[str, Any]

STEPS = (1 / 30, 0.02, 0.01)  # not above a frame: longer ones have no answer


@cache
def committed(name: str) -> Json:
    return json.loads((ROOT / "results" / name).read_text(encoding="utf-8"))


def document(points: list[Json], **suite: Any) -> Json:
    given = copy.deepcopy(committed("figure1.json"))
    context = {**given["context"], "cpu_model": "Model 7", "host_name": "box", "date": "2026-11-21T22:39:39+00:00",
               "build": {**given["context"]["build"], "git": "a2e87d4fef63"},
               "command": ["bench", "--sweep", "strain", "--force", "--out", "results/it.json", "--reps", "9"],
               "suite": {**given["context"]["suite"], "profile": "default", "reps": 3, "timeout": 5.0, **suite}}
    return {**given, "context": context, "points": points, "benchmarks": []}


def timing(seconds: float) -> Json:
    """Nine samples, the least of which takes `seconds`."""
    taken = [seconds * (1 + 0.01 * place) for place in range(9)]
    return {"min": seconds, "median": taken[4], "q1": taken[2], "q3": taken[6], "samples": taken[::-1]}


def point(contestant: str, sweep: str = "strain", scene: str = "chain", vertices: int = 80, limit: float = 0.01,
          step: float = 0.01, seconds: float | None = 0.5, status: str = "ok", error: Json | None = None,
          **more: Any) -> Json:
    given = copy.deepcopy(committed("figure1.json")["points"][0])
    errors = {"trajectory": 0.02, "gap": 1e-6, "valid_until": 1.0, **(error or {})}
    return {**given, "sweep": sweep, "scene": scene, "solver": contestant, "contestant": contestant, "vertices": vertices,
            "resolution": vertices, "strain_limit": limit, "max_strain": limit, "step": step, "status": status, "status_detail": "",
            "duration": 1.0, "id": f"{scene}/{contestant}/n:{vertices}/strain:{limit:g}/h:{step:g}",
            "scene_parameters": {"n": vertices, "gravity": 9.81, "duration": 1.0}, "work": {**given["work"], "steps": 100},
            "seconds_per_simulated_second": timing(seconds) if seconds else None, "error": {**given["error"], **errors},
            "filter_seconds_per_simulated_second": None, "frame_times": [], **more}


def strain_sweep(**suite: Any) -> Json:
    """Everyone ran at three limits; Jacobi fails at the tightest, diverging at the coarse step and too slow at the fine."""
    points = []
    for place, solver in enumerate(("fast_projection", "shake", "jacobi")):
        for limit in (0.1, 0.01, 0.001):
            if solver == "jacobi" and limit == 0.001:
                points += [point(solver, limit=limit, step=step, seconds=None, status=status)
                           for step, status in ((0.01, "timeout"), (0.02, "diverged"))]
            else:
                points.append(point(solver, limit=limit, seconds=(place + 1) * 0.01 / limit**0.5, best=True, error={"trajectory": 0.2}))
    return document(points, **suite)


def two_questions() -> Json:
    """SHAKE is fast and wrong at the coarse step, right at the fine one; Jacobi is never right, nobody at the tight limit."""
    return document([point("shake", step=1 / 30, seconds=0.1, error={"trajectory": 0.2}),
                     point("shake", step=0.01, seconds=0.4, error={"trajectory": 0.01}),
                     point("jacobi", step=1 / 30, seconds=0.2, error={"trajectory": 0.5}),
                     point("fast_projection", step=0.02, seconds=0.3, error={"trajectory": 0.015}),
                     point("fast_projection", limit=0.1, step=0.02, seconds=0.3, error={"trajectory": 0.015}),
                     point("shake", limit=0.001, seconds=0.7, error={"trajectory": 0.3})])


def resolution_sweep(scene: str = "drape") -> Json:
    """Cost of slope 1, 1.5 and so on over vertices; ICD fails at the largest size."""
    points = []
    for place, solver in enumerate(("fast_projection", "shake", "icd")):
        for vertices in (100, 400, 1600):
            if solver == "icd" and vertices == 1600:
                points.append(point(solver, "resolution", scene, vertices, seconds=None, status="not_converged"))
            else:
                points.append(point(solver, "resolution", scene, vertices, seconds=1e-4 * vertices ** (1 + place / 2), best=True))
    return document(points)


def step_sweep(residuals_of: tuple[str, ...] = ("fast_projection",)) -> Json:
    """First order at two limits; SHAKE fails at the coarsest step; the finest errors of the loose limit are unsure."""
    points = []
    for place, solver in enumerate(("fast_projection", "shake")):
        for limit in (0.01, 0.0001):
            for step in STEPS:
                if solver == "shake" and step == STEPS[0]:
                    points.append(point(solver, "step", limit=limit, step=step, seconds=None, status="not_converged"))
                    continue
                error: Json = {"trajectory": step * (place + 1), "gap": 0.005 if limit == 0.01 else 1e-6, "valid_until": 0.5}
                if solver in residuals_of:
                    error["residuals"] = [[t / 10, step**2, step**3] for t in range(1, 6)]
                points.append(point(solver, "step", limit=limit, step=step, seconds=1e-3 / step * (1 + place), error=error))
    return document(points)


def stability() -> Json:
    given = copy.deepcopy(committed("stability.json"))
    cells = [{**given["matrix"][0], "row": row, "case": case, "solver": solver, "outcome": outcome, "as_expected": expected, "energy_gain": gain,
              "admitted_beside": "refused" if case == "whip 1" else None}
             for row, case, solver, outcome, expected, gain in (
                 ("Q1", "Q1", "fast_projection", "survived", True, 0.0), ("Q1", "Q1", "shake", "refused", True, 0.6),
                 ("whip", "whip 1", "shake", "survived", True, None), ("whip", "whip 2", "shake", "diverged", False, None))]
    return {**given, "legend": committed("figure1.json")["legend"], "matrix": cells}


def known_answers() -> Json:
    """Two answers, SHAKE of second order, Jacobi without a value at the coarse step."""
    given = copy.deepcopy(committed("answers.json"))
    answers = [{**given["answers"][0], "name": name, "scene": "baton", "quantity": "distance"} for name in ("place", "rate")]
    rows = [{**given["rows"][0], "answer": name, "solver": solver, "step": step, "value": step**order,
             "deviation": None if solver == "jacobi" and step == 0.01 else step**order}
            for name in ("place", "rate") for solver, order in (("shake", 2), ("jacobi", 1)) for step in (0.01, 0.005, 0.0025)]
    return {**given, "legend": committed("figure1.json")["legend"], "answers": answers, "rows": rows}


def analysed(result: Json) -> Result:
    """As bench gives it to its scripts: checked, with the analysis of a sweep."""
    if "points" not in result:
        return Result(result)
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(result, file)
        file.flush()
        shown = subprocess.run([BENCH, "show", file.name, "--json"], capture_output=True, text=True, check=False)
    assert shown.returncode == 0, shown.stderr
    return Result({**printable(result), "analysis": json.loads(shown.stdout)})


def printable(value: Any) -> Any:
    """As bench reads a file: without characters that control a terminal."""
    if isinstance(value, dict):
        return {key: printable(member) for key, member in value.items()}
    if isinstance(value, list):
        return [printable(member) for member in value]
    return re.sub("[\0-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff]", "?", value) if isinstance(value, str) else value


def drawn(result: Json) -> dict[str, Figure]:
    with matplotlib.rc_context(RC):
        pictures = {name: draw() for name, draw in figures.all_figures(analysed(result), every=True).items()}
        for figure in pictures.values():
            figure.canvas.draw()
    return pictures


def axes_with(figure: Figure, xlabel: str = "", ylabel: str = "") -> Axes:
    (found,) = [axes for axes in figure.axes if xlabel in axes.get_xlabel() and ylabel in axes.get_ylabel()
                and (axes.get_xlabel() or axes.get_ylabel())]
    return found


def panels(figure: Figure) -> list[Axes]:
    """The main panels of a figure of cost: any motion, and motion that is right."""
    return [axes for axes in figure.axes if axes.get_yscale() == "log" and not {axes.get_ylabel()} & {"filter alone (s)", "best time step (s)"}]


def legend_labels(figure: Figure) -> list[str]:
    return [" ".join(text.get_text().split()) for axes in figure.axes if axes.get_legend() for text in axes.get_legend().get_texts()]


def words(figure: Figure) -> str:
    """Those around the panels."""
    return " ".join(" ".join(text.get_text() for text in figure.texts).split())


def strips(figure: Figure) -> list[Axes]:
    return [axes for axes in figure.axes if axes.get_title(loc="right")]


def marks(strip: Axes) -> list[str]:
    return [text.get_text() for text in strip.texts]


def curves(axes: Axes, color: str | None = None) -> list[Any]:
    """Joined lines through two points or more, without the helping lines, which are grey and thin."""
    return [line for line in axes.lines if line.get_linestyle() != "None" and len(line.get_xdata()) > 1
            and line.get_color() not in ("#7F7F7F", "#FFE08A") and color in (None, line.get_color())]


def fits(figure: Figure) -> bool:
    """Whether nothing runs out of the figure."""
    box = figure.get_tightbbox(figure.canvas.get_renderer())  # inches
    return min(box.x0, box.y0) > -0.02 and box.x1 < figure.get_figwidth() + 0.02 and box.y1 < figure.get_figheight() + 0.02
