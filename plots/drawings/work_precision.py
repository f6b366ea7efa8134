"""Time against error: one curve a solver through its cheapest runs at any step and limit, all others as dots, the front of
all solvers underneath."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.caption import ERROR_LABEL, origin_sentence, scene_sentence, timing, validity, warnings_of
from parts.curves import Styles, draw_noise, line_of
from parts.failures import Mark, Rows, add_strip, letters_in
from parts.legend import MEANINGS, Legend
from parts.result_file import Json, finding_in, leaders_in, noise_factor
from parts.scales import log_log
from parts.sheet import (LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, TIME_LABEL, grid, label_ends, labels_height,
                         make_sheet)
from parts.step_runs import FailedStep, Run, RunsData, cheapest, step_sweeps_in, styles_of
from parts.style import SolverStyle, receding_sentences, with_leaders
from parts.words import scene_words

TARGETS = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
LADDER_ENDED = "L"
FRONT = "#FFE08A"


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(f"work-precision-{data.name}", partial(draw, data, document, legend))
            for data in step_sweeps_in(document, legend) if data.all_runs()]


def draw(data: RunsData, document: Json, legend: Legend) -> Figure:
    styles = with_leaders(styles_of(data, legend), leaders_in(document, data.scene, "step"))
    rows = _missed_targets(data, styles)
    words = [scene_sentence(data.scene, f"{data.vertices:,.0f} vertices", data.points) + validity(data),
             "Every run that kept its strain limit, at any step and limit, with tuned or untuned settings, is a dot. A curve joins the runs of a solver that "
             "none of its others beats in both time and error; the yellow band is the front of all solvers. Hollow: error "
             "below three times the reference's own uncertainty.",
             *receding_sentences(styles.values()), _key_of(rows, legend), timing(document), origin_sentence(document)]
    sheet = make_sheet(f"{scene_words(data.scene)}: time against error", warnings_of(document), [w for w in words if w],
                       LEFT + 1.25 * MAIN_WIDTH + LEGEND_WIDTH, 1.25 * MAIN_HEIGHT + ROW_HEIGHT * len(rows),
                       labels_height(styles) - 1.25 * MAIN_HEIGHT,
                       " ".join(finding_in(document, data.scene, "step", data.vertices)[:1]))
    axes = sheet.axes(LEFT, sheet.bottom, 1.25 * MAIN_WIDTH, 1.25 * MAIN_HEIGHT)
    runs = data.all_runs()
    log_log(axes, [run.error for run in runs], [run.seconds for run in runs])
    axes.set_xlabel(ERROR_LABEL)
    axes.set_ylabel(TIME_LABEL)
    front = cheapest(runs)
    axes.plot([run.error for run in front], [run.seconds for run in front], color=FRONT, linewidth=9, alpha=0.8,
              solid_capstyle="round", solid_joinstyle="round", zorder=2)
    for order, (solver, style) in enumerate(styles.items()):
        _draw_solver(axes, data.runs.get(solver, []), style, 10 + len(styles) - order if style.leads else 3)
    draw_noise(axes, noise_factor(document))
    grid(axes)
    add_strip(sheet, axes, rows, styles, "error not reached")
    ends = {solver: max(cheapest(own), key=lambda run: run.error) for solver, own in data.runs.items() if own}
    label_ends(sheet, axes, {solver: (run.error, run.seconds) for solver, run in ends.items()}, styles)
    return sheet.figure


def _draw_solver(axes: Axes, runs: list[Run], style: SolverStyle, z: int) -> None:
    axes.plot([run.error for run in runs], [run.seconds for run in runs], linestyle="none", marker=".", markersize=2.5,
              color=style.color, alpha=0.5, zorder=4)
    curve = cheapest(runs)
    line = line_of(style, [run.error for run in curve], [run.seconds for run in curve], zorder=z)
    line.set_markevery([number for number, run in enumerate(curve) if run.sure])
    axes.add_line(line)
    unsure = [run for run in curve if not run.sure]
    hollow = line_of(style, [run.error for run in unsure], [run.seconds for run in unsure], zorder=z)
    hollow.set(linestyle="none", markerfacecolor="white", markeredgecolor=style.color, markeredgewidth=1)
    axes.add_line(hollow)


def _missed_targets(data: RunsData, styles: Styles) -> Rows:
    """The error targets that some solver reached and this one did not, with what became of its finer steps."""
    errors = [run.error for run in data.all_runs()]
    shown = [target for target in TARGETS if min(errors) <= target <= max(errors)]
    rows: Rows = {}
    for solver in (name for name, style in styles.items() if style.leads):
        closest = min(data.runs.get(solver, []), key=lambda run: run.error, default=None)
        letters = _letters([failure for failure in data.failures.get(solver, []) if not closest or failure.step < closest.step])
        marks = [Mark(target, letters) for target in sorted(shown) if not closest or target < closest.error]
        if marks:
            rows[solver] = marks
    return rows


def _letters(failures: list[FailedStep]) -> str:
    return "".join(dict.fromkeys(f.letter for f in sorted(failures, key=lambda f: f.step, reverse=True))) or LADDER_ENDED


def _key_of(rows: Rows, legend: Legend) -> str:
    if not rows:
        return ""
    meanings = legend.key(letters_in(rows), {**MEANINGS, LADDER_ENDED: "the ladder ended"})
    return ("A mark above the axes: no run of the solver reached this error; letters say what became of steps finer than its "
            f"best: {meanings}.")
