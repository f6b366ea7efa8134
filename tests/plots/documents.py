"""Small result files for the tests, as bench writes them, and what the tests ask of a drawn figure."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Iterator

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

import figures
from parts.style import RC

ROOT = Path(__file__).resolve().parents[2]

Json = dict[str, Any]

SOLVERS = (
    ("implicit_springs", "implicit springs", "implicit_springs", True),
    ("jacobi", "Jacobi strain limiting", "jacobi", True),
    ("gauss_seidel", "Gauss-Seidel strain limiting", "gauss_seidel", True),
    ("gauss_seidel_colored", "Gauss-Seidel strain limiting, colored", "gauss_seidel", True),
    ("shake", "SHAKE", "shake", True),
    ("icd", "ICD (implicit constraint direction)", "icd", True),
    ("fast_projection", "fast projection", "fast_projection", True),
    ("fast_projection_smoothed", "fast projection, smoothed", "fast_projection", True),
    ("fast_projection@bdf2", "fast projection in BDF2", "fast_projection", True),
    ("rattle", "RATTLE (SHAKE with velocities)", "shake", True),
    ("null", "scene without inextensibility", "null", False),
    ("dense_newton", "dense Newton (no contestant)", "dense_newton", False),
)
STATUSES = (("ok", "", "ran"), ("strain_missed", "S", "strain limit missed"), ("not_converged", "N", "not converged"),
            ("diverged", "D", "diverged"), ("timeout", "T", "timeout"), ("skipped", "K", "skipped"))
STEPS = (0.04, 0.02, 0.01)


def legend() -> Json:
    return {"solvers": [dict(zip(("name", "label", "family", "contestant"), row)) for row in SOLVERS],
            "statuses": [dict(zip(("name", "letter", "meaning"), row)) for row in STATUSES]}


def document(points: list[Json], **suite: Any) -> Json:
    return {"schema": "inextensible-bench/1", "complete": True, "legend": legend(), "points": points,
            "context": {"cpu_model": "Model 7", "num_cpus": 2, "library_build_type": "release", "seed": 1,
                        "date": "2026-11-21T22:39:39+00:00", "host_name": "box", "build": {"git": "a2e87d4fef63", "dirty": False},
                        "suite": {"profile": "default", "reps": 3, "timeout": 5.0, **suite}}}


def point(solver: str, sweep: str = "strain", scene: str = "chain", vertices: int = 80, limit: float = 0.01,
          step: float = 0.01, seconds: float | None = 0.5, status: str = "ok", **more: Any) -> Json:
    timing = {"min": seconds, "median": 1.1 * seconds, "q1": 1.05 * seconds, "q3": 1.2 * seconds} if seconds else None
    return {"sweep": sweep, "scene": scene, "solver": solver, "vertices": vertices, "strain_limit": limit, "step": step,
            "status": status, "status_detail": "", "duration": 1.0, "adaptive": False, "best": False,
            "scene_parameters": {"n": vertices, "gravity": 9.81, "duration": 1.0}, "work": {"steps": 100},
            "seconds_per_simulated_second": timing, "error": {"trajectory": 0.02, "gap": 1e-6, "valid_until": 1.0}, **more}


def strain_sweep(scene: str = "chain", solvers: tuple[str, ...] = ("fast_projection", "shake", "jacobi"), **suite: Any) -> Json:
    """Everyone ran at three limits; Jacobi fails at the tightest, diverging at the coarse step and too slow at the fine."""
    points = []
    for place, solver in enumerate(solvers):
        for limit in (0.1, 0.01, 0.001):
            if solver == "jacobi" and limit == 0.001:
                points += [point(solver, scene=scene, limit=limit, step=0.01, seconds=None, status="timeout"),
                           point(solver, scene=scene, limit=limit, step=0.04, seconds=None, status="diverged")]
            else:
                seconds = (place + 1) * 0.01 / limit**0.5
                points.append(point(solver, scene=scene, limit=limit, seconds=seconds, best=True))
    return document(points, **suite)


def two_questions() -> Json:
    """SHAKE is fast and wrong at the coarse step, right at the fine one; Jacobi is never right. The analysis has a cell of any
    motion and one of 2 %, and is what figures are drawn from."""
    points = [point("shake", step=0.04, seconds=0.1, id="shake coarse", error={"trajectory": 0.2}),
              point("shake", step=0.01, seconds=0.4, id="shake fine", error={"trajectory": 0.01}),
              point("jacobi", step=0.04, seconds=0.2, id="jacobi coarse", error={"trajectory": 0.5}, best=True),
              point("fast_projection", step=0.02, seconds=0.3, id="fast", error={"trajectory": 0.015})]

    def entry(name: str, which: str, seconds: float, error: float) -> Json:
        return {"contestant": name, "row": name, "unranked": False, "counts": True, "id": which, "seconds": seconds, "step": 0.01,
                "error": error}

    def cell(limit: float, level: float | None, entries: list[Json], lead: float | None) -> Json:
        paper = next((e["row"] for e in entries if e["row"] != "icd"), None)
        return {"strain_limit": limit, "error_level": level, "known_until": 1.0, "entries": entries, "clear": bool(lead),
                "empty_because": "" if entries else "no run that was tried has a motion error of at most 2 %", "first": entries[0]["row"] if entries else None,
                "paper_best": paper, "lead_over_paper_best": {"value": lead, "low": None, "high": None} if lead else None}

    cells = [cell(0.01, None, [entry("shake", "shake coarse", 0.1, 0.2), entry("jacobi", "jacobi coarse", 0.2, 0.5),
                               entry("fast_projection", "fast", 0.3, 0.015)], None),
             cell(0.01, 0.02, [entry("icd", "icd", 0.2, 0.012), entry("fast_projection", "fast", 0.3, 0.015),
                               entry("shake", "shake fine", 0.4, 0.01)], 1.5),
             cell(0.001, None, [], None), cell(0.001, 0.02, [], None)]
    plane = {"scene": "chain", "sweep": "strain", "scene_parameters": {}, "resolution": 80, "vertices": 80,
             "strain_limits": [0.01, 0.001], "error_levels": [None, 0.02], "cells": cells,
             "leaders": ["shake", "icd", "jacobi", "fast_projection"]}
    def stair(seconds: float, limit: float, right: bool) -> Json:
        return {"id": "", "frame_seconds": seconds, "strain_limit": limit, "error": 0.01, "right": right}

    budget = {"scene": "chain", "resolution": 80, "vertices": 80, "rows": [
        {"row": "icd", "stairs": [stair(0.5e-3, 0.01, False), stair(2e-3, 0.01, True), stair(3e-3, 0.01, True), stair(8e-3, 0.001, True)]},
        {"row": "jacobi", "stairs": [stair(1e-3, 0.01, False)]}]}
    finding = {"scene": "chain", "sweep": "strain", "vertices": 80, "subject": "chain of 80 vertices",
               "sentences": ["At 1 % strain, motion error at most 2 %, icd is the fastest.", "A second sentence."]}
    return {**document(points), "analysis": {"schema": "inextensible-analysis/1", "headline_error": 0.02, "findings": [finding], "planes": [plane],
                                             "growth": [], "budgets": [budget]}}


def resolution_sweep(scene: str = "drape", solvers: tuple[str, ...] = ("fast_projection", "shake", "icd")) -> Json:
    """Cost of slope 1, 1.5 and so on over vertices; ICD fails at the largest size."""
    points = []
    for place, solver in enumerate(solvers):
        for vertices in (100, 400, 1600):
            if solver == "icd" and vertices == 1600:
                points.append(point(solver, "resolution", scene, vertices, seconds=None, status="not_converged"))
            else:
                points.append(point(solver, "resolution", scene, vertices, seconds=1e-4 * vertices ** (1 + place / 2), best=True))
    return document(points)


def step_sweep(scene: str = "chain", residuals_of: tuple[str, ...] = ("fast_projection",)) -> Json:
    """First order at two limits; SHAKE fails at the coarsest step; the finest errors of the loose limit are unsure."""
    points = []
    for place, solver in enumerate(("fast_projection", "shake")):
        for limit in (0.01, 0.0001):
            for step in STEPS:
                if solver == "shake" and step == STEPS[0]:
                    points.append(point(solver, "step", scene, limit=limit, step=step, seconds=None, status="not_converged"))
                    continue
                error: Json = {"trajectory": step * (place + 1), "gap": 0.005 if limit == 0.01 else 1e-6, "valid_until": 0.5}
                if solver in residuals_of:
                    error["residuals"] = [[t / 10, step**2, step**3] for t in range(1, 6)]
                points.append(point(solver, "step", scene, limit=limit, step=step, seconds=1e-3 / step * (1 + place), error=error))
    return document(points)


def stability() -> Json:
    cells = [{"row": row, "case": case, "solver": solver, "outcome": outcome, "as_expected": expected, "energy_gain": gain,
              "admitted_beside": "refused" if case == "whip 1" else None}
             for row, case, solver, outcome, expected, gain in (
                 ("Q1", "Q1", "fast_projection", "survived", True, 0.0), ("Q1", "Q1", "shake", "refused", True, 0.6),
                 ("whip", "whip 1", "shake", "survived", True, None), ("whip", "whip 2", "shake", "diverged", False, None))]
    steps = [{"scene": "chain of 20", "solver": "fast_projection", "step": 0.25},
             {"scene": "chain of 20", "solver": "shake", "step": None}]
    return {"schema": "inextensible-stability/1", "complete": True, "context": document([])["context"],
            "legend": {"solvers": legend()["solvers"]}, "matrix": cells, "largest_steps": steps}


def known_answers() -> Json:
    """Two answers, SHAKE of second order, Jacobi without a value at the coarse step."""
    answers = [{"name": name, "scene": "baton", "quantity": "distance", "exact": 0.0, "continuum": False} for name in ("place", "rate")]
    rows = [{"answer": name, "solver": solver, "step": step, "value": step**order, "deviation": None if missing else step**order}
            for name in ("place", "rate") for solver, order in (("shake", 2), ("jacobi", 1)) for step in (0.01, 0.005, 0.0025)
            for missing in [solver == "jacobi" and step == 0.01]]
    return {"schema": "inextensible-answers/1", "complete": True, "context": document([])["context"],
            "legend": {"solvers": legend()["solvers"], "statuses": []}, "answers": answers, "rows": rows}


# ---- drawn figures ------------------------------------------------------------------------------------------------

def drawn(result: Json) -> dict[str, Figure]:
    with matplotlib.rc_context(RC):
        pictures = {name: draw() for name, draw in figures.all_figures(result).items()}
        for figure in pictures.values():
            figure.canvas.draw()
    return pictures


def words_of(figure: Figure) -> str:
    """Title, warnings and caption in one line."""
    return " ".join(" ".join(text.get_text() for text in figure.texts).split())


def axes_with(figure: Figure, xlabel: str = "", ylabel: str = "") -> Axes:
    found = [axes for axes in figure.axes if xlabel in axes.get_xlabel() and ylabel in axes.get_ylabel()
             and (axes.get_xlabel() or axes.get_ylabel())]
    assert len(found) == 1, f"{len(found)} axes with '{xlabel}' and '{ylabel}'"
    return found[0]


def legend_labels(figure: Figure) -> list[str]:
    """Labels of legends and beside the ends of curves."""
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    beside = [text for text in figure.texts if str(text.get_gid()).startswith("label-")]
    return [" ".join(text.get_text().split()) for text in [*(text for box in legends for text in box.get_texts()), *beside]]


def strips(figure: Figure) -> list[Axes]:
    return [axes for axes in figure.axes if axes.get_title(loc="right")]


def marks(strip: Axes) -> list[str]:
    return [text.get_text() for text in strip.texts]


def curves(axes: Axes, color: str | None = None) -> list[Any]:
    """Joined lines through two points or more, without the helping lines, which are grey and thin."""
    return [line for line in axes.lines if line.get_linestyle() != "None" and len(line.get_xdata()) > 1
            and line.get_color() not in ("#7F7F7F", "#FFE08A") and color in (None, line.get_color())]


def texts_outside(figure: Figure) -> list[str]:
    """Words that run out of the figure."""
    renderer = figure.canvas.get_renderer()
    frame = figure.bbox
    outside = []
    for text in _visible_texts(figure):
        box = text.get_window_extent(renderer)
        if text.get_text().strip() and (box.x0 < frame.x0 - 1 or box.x1 > frame.x1 + 1 or box.y0 < frame.y0 - 1
                                        or box.y1 > frame.y1 + 1):
            outside.append(text.get_text())
    return outside


def _visible_texts(figure: Figure) -> Iterator[Text]:
    for axes in figure.axes:
        if axes.axison:
            for axis in (axes.xaxis, axes.yaxis):
                low, high = sorted(axis.get_view_interval())
                for tick in axis.get_major_ticks():
                    if low <= tick.get_loc() <= high and tick.label1.get_visible():
                        yield tick.label1
                yield axis.label
        yield from axes.texts
        if axes.get_legend():
            yield from axes.get_legend().get_texts()
        yield from (axes.title, axes._left_title, axes._right_title)
    yield from figure.texts


def written(result: Json, folder: Path, name: str = "result.json") -> Path:
    path = folder / name
    path.write_text(json.dumps(result), encoding="utf-8")
    return path
