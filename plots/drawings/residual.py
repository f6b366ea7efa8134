"""What a solver that reports a residual leaves of the constraint direction's equation, mean |F|, over time and over the step
(Figure 3 of the paper). Drawn for whoever has a series of residuals."""

from __future__ import annotations

import math
from functools import partial
from typing import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from parts.caption import origin_sentence, percent, scene_sentence, warnings_of
from parts.colors import GREY
from parts.legend import Legend
from parts.result_file import Json
from parts.scales import log_log, step_axis, step_name
from parts.sheet import GAP, LEFT, MAIN_HEIGHT, MAIN_WIDTH, grid, make_sheet
from parts.step_runs import RunsData, Series, step_sweeps_in, styles_of
from parts.words import file_part, scene_words

ByStep = dict[float, Series]


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    figures = []
    for data in step_sweeps_in(document, legend):
        shown = {solver: limit for solver in data.residuals if (limit := _tightest(data, solver)) is not None}
        for solver, limit in shown.items():
            name = f"residual-{data.name}" if len(shown) == 1 else f"residual-{file_part(solver)}-{data.name}"
            figures.append((name, partial(draw, data, document, legend, solver, limit)))
    return figures


def _tightest(data: RunsData, solver: str) -> float | None:
    """The tightest strain limit at which there is a line to draw: two steps with something left."""
    def steps_with_rest(by_step: ByStep) -> int:
        return sum(_mean(series, 1) > 0 and _mean(series, 2) > 0 for series in by_step.values())

    return min((limit for limit, by_step in data.residuals[solver].items() if steps_with_rest(by_step) > 1), default=None)


def draw(data: RunsData, document: Json, legend: Legend, solver: str, limit: float) -> Figure:
    by_step = data.residuals[solver][limit]
    style = styles_of(data, legend)[solver]
    words = [scene_sentence(data.scene, f"{data.vertices:,.0f} vertices", data.points),
             f"{style.label[:1].upper()}{style.label[1:]}, strain limit {percent(limit)}: what is left of the implicit "
             "constraint direction's equation F = 0 (in metres, mean over the vertices), after the "
             "first iteration of a step and after the last, for samples in which a step needed an iteration at all. Right: "
             "mean over those samples; the lines are fitted over all steps shown (bench claims: with confidence interval).",
             origin_sentence(document)]
    sheet = make_sheet(f"{scene_words(data.scene)}: residual of {style.label}", warnings_of(document), words,
                       LEFT + 2 * MAIN_WIDTH + GAP + 1.6, MAIN_HEIGHT)
    left = sheet.axes(LEFT, sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT)
    right = sheet.axes(LEFT + MAIN_WIDTH + GAP, sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT)
    _draw_over_time(left, by_step, style.color)
    _draw_over_step(right, by_step, style.color)
    for axes in (left, right):
        grid(axes)
    return sheet.figure


def _draw_over_time(axes: Axes, by_step: ByStep, color: str) -> None:
    steps = sorted(by_step, reverse=True)
    axes.set_yscale("log")
    for step, opacity in zip((steps[0], steps[len(steps) // 2]), (1, 0.5)):
        time, first, last = (list(column) for column in zip(*by_step[step]))
        axes.plot(time, first, color=color, alpha=opacity, linewidth=1, linestyle=(0, (3, 1.5)),
                  label=f"first iteration, h = {step_name(step)} s")
        axes.plot(time, last, color=color, alpha=opacity, linewidth=1.4,
                  label=f"last iteration, h = {step_name(step)} s")
    axes.set_xlabel("time (s)")
    axes.set_ylabel("mean |F| (m)")
    axes.yaxis.set_major_locator(LogLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:.0e}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.legend(frameon=False, fontsize=7.5, loc="best")


def _draw_over_step(axes: Axes, by_step: ByStep, color: str) -> None:
    steps = sorted(by_step)
    first = [_mean(by_step[step], 1) for step in steps]
    last = [_mean(by_step[step], 2) for step in steps]
    log_log(axes, steps, [value for value in first + last if value > 0])
    step_axis(axes, steps)
    for values, marker, dashes, name in ((first, "o", (3, 1.5), "first iteration"), (last, "s", (), "last iteration")):
        pairs = [(step, value) for step, value in zip(steps, values) if value > 0]
        slope, offset = np.polyfit(*np.log(np.array(pairs)).T, 1) if len(pairs) > 1 else (math.nan, math.nan)
        x = np.array([step for step, _ in pairs])
        axes.plot(x, [value for _, value in pairs], marker, color=color, markersize=5, label=f"{name}: slope {slope:.2f}",
                  markerfacecolor=color if not dashes else "white")
        axes.plot(x, np.exp(offset) * x**slope, color=GREY, linewidth=0.8, linestyle=(0, dashes) if dashes else "-")
    axes.set_xlabel("time step (s)")
    axes.legend(frameon=False, fontsize=8, loc="upper left")


def _mean(series: Series, column: int) -> float:
    return sum(row[column] for row in series) / len(series)
