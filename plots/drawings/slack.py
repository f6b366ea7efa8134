"""Error over step at a loose strain limit and at the tightest one: where slack within the limit spoils the order."""

from __future__ import annotations

import math
from functools import partial
from typing import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.caption import ERROR_LABEL, origin_sentence, percent, scene_sentence, validity, warnings_of
from parts.curves import Styles, line_of
from parts.failures import Mark, Rows, add_strip, letters_in
from parts.legend import Legend
from parts.result_file import Json
from parts.scales import log_log, step_axis
from parts.sheet import LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, add_legend, grid, legend_height, make_sheet
from parts.step_runs import RunsData, step_sweeps_in, styles_of
from parts.style import GREY
from parts.words import scene_words

LOOSE = 0.01  # strain limit at which slack is shown


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(f"slack-{data.name}", partial(draw, data, document, legend))
            for data in step_sweeps_in(document, legend) if data.all_runs()]


def draw(data: RunsData, document: Json, legend: Legend) -> Figure:
    styles = styles_of(data, legend)
    limits = sorted({run.limit for run in data.all_runs()})
    tight, loose = limits[0], min(limits, key=lambda limit: abs(math.log(limit / LOOSE)))
    shown = [loose] if tight == loose else [loose, tight]
    rows = _failed_steps(data, styles, shown)
    words = [scene_sentence(data.scene, f"{data.vertices:,.0f} vertices", data.points) + validity(data),
             "Error of every run over its step. An order of convergence is a slope (dotted: 1 and 2); where edges may be "
             "slack within a loose limit, the limit and not the step decides, and smaller steps do not help or even harm.",
             _key_of_failures(rows, legend), origin_sentence(document)]
    width = LEFT + len(shown) * MAIN_WIDTH + (len(shown) - 1) * 0.4 + LEGEND_WIDTH
    sheet = make_sheet(f"{scene_words(data.scene)}: error over step", warnings_of(document), [w for w in words if w], width,
                       MAIN_HEIGHT + ROW_HEIGHT * len(rows[0]) + 0.15, legend_height(styles) - MAIN_HEIGHT)
    runs = data.all_runs()
    tried = [failed.step for steps in data.failures.values() for failed in steps] + [run.step for run in runs]
    for number, limit in enumerate(shown):
        axes = sheet.axes(LEFT + number * (MAIN_WIDTH + 0.4), sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT)
        log_log(axes, tried, [run.error for run in runs])
        step_axis(axes, tried)
        _guides(axes)
        for order, (solver, style) in enumerate(styles.items()):
            path = sorted((run for run in data.runs.get(solver, []) if run.limit == limit), key=lambda run: run.step)
            axes.add_line(line_of(style, [run.step for run in path], [run.error for run in path],
                                         zorder=10 + len(styles) - order))
        axes.set_xlabel(f"time step (s), strain limit {percent(limit)}")
        if number == 0:
            axes.set_ylabel(ERROR_LABEL)
        else:
            axes.tick_params(axis="y", labelleft=False)
        grid(axes)
        add_strip(sheet, axes, rows[number], styles, "steps that failed", names=number == 0)
    add_legend(axes, styles, anchor=(1.03, 1.0))
    return sheet.figure


def _failed_steps(data: RunsData, styles: Styles, limits: list[float]) -> list[Rows]:
    """For each limit the same rows: of every solver that fails at one of them."""
    failures = {solver: sorted((f for f in data.failures.get(solver, []) if f.limit in limits), key=lambda f: f.step)
                for solver in styles}
    return [{solver: [Mark(f.step, f.letter) for f in failed if f.limit == limit] for solver, failed in failures.items() if failed}
            for limit in limits]


def _key_of_failures(rows: list[Rows], legend: Legend) -> str:
    meanings = legend.key(letter for row in rows for letter in letters_in(row))
    return f"A mark above the axes: a step that failed: {meanings}." if meanings else ""


def _guides(axes: Axes) -> None:
    """Slopes 1 and 2 through the upper right corner."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    for power in (1, 2):
        end = max(left, right * (low / high) ** (1 / power))
        axes.plot([end, right], [high * (end / right) ** power, high], color=GREY, linewidth=0.6, linestyle=(0, (1, 3)),
                  zorder=1)
