"""What a solver that reports a residual leaves of the constraint direction's equation, mean |F|, over time and over the step
(Figure 3 of the paper). Drawn for whoever has a series of residuals."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from parts.axes import grid, log_log, set_ticks, steps_on_x
from parts.result import Figures, Result
from parts.runs import Series, StepSweep, step_sweeps_in
from parts.sheet import GAP, LEFT, MAIN_HEIGHT, MAIN_WIDTH, make_sheet, scene_sentence
from parts.style import GREY
from parts.words import file_part, percent, scene_words, step_name

ByStep = dict[float, Series]


def figures_of(result: Result) -> Figures:
    figures = []
    for sweep in step_sweeps_in(result):
        shown = {solver: limit for solver in sweep.residuals if (limit := _tightest(sweep, solver)) is not None}
        for solver, limit in shown.items():
            name = f"residual-{sweep.name}" if len(shown) == 1 else f"residual-{file_part(solver)}-{sweep.name}"
            figures.append((name, draw, sweep, result, solver, limit))
    return figures


def _tightest(sweep: StepSweep, solver: str) -> float | None:
    """The tightest strain limit at which there is a line to draw: two steps with something left."""
    return min((limit for limit, by_step in sweep.residuals[solver].items()
                if sum(np.all(np.mean(series, axis=0)[1:] > 0) for series in by_step.values()) > 1), default=None)


def draw(sweep: StepSweep, result: Result, solver: str, limit: float) -> Figure:
    by_step = sweep.residuals[solver][limit]
    style = sweep.styles(result)[solver]
    words = [scene_sentence(sweep.scene, f"{sweep.vertices:,.0f} vertices", sweep.points),
             f"{style.label[:1].upper()}{style.label[1:]}, strain limit {percent(limit)}: what is left of the implicit "
             "constraint direction's equation F = 0 (in metres, mean over the vertices), after the "
             "first iteration of a step and after the last, for samples in which a step needed an iteration at all. Right: "
             "mean over those samples; the lines are fitted over all steps shown (bench claims: with confidence interval)."]
    sheet = make_sheet(result, f"{scene_words(sweep.scene)}: residual of {style.label}", words, LEFT + 2 * MAIN_WIDTH + GAP + 1.6, MAIN_HEIGHT)
    left, right = (sheet.axes(LEFT + place * (MAIN_WIDTH + GAP), sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT) for place in (0, 1))
    _draw_over_time(left, by_step, style.color)
    _draw_over_step(right, by_step, style.color)
    for axes in (left, right):
        grid(axes)
    return sheet.figure


def _draw_over_time(axes: Axes, by_step: ByStep, color: str) -> None:
    steps = sorted(by_step, reverse=True)
    axes.set_yscale("log")
    for step, opacity in zip((steps[0], steps[len(steps) // 2]), (1, 0.5)):
        time, first, last = zip(*by_step[step])
        axes.plot(time, first, color=color, alpha=opacity, linewidth=1, linestyle=(0, (3, 1.5)),
                  label=f"first iteration, h = {step_name(step)} s")
        axes.plot(time, last, color=color, alpha=opacity, linewidth=1.4,
                  label=f"last iteration, h = {step_name(step)} s")
    axes.set(xlabel="time (s)", ylabel="mean |F| (m)")
    set_ticks(axes.yaxis, LogLocator(), LogLocator(subs=range(2, 10)), lambda y: f"{y:.0e}")
    axes.legend(frameon=False, fontsize=7.5, loc="best")


def _draw_over_step(axes: Axes, by_step: ByStep, color: str) -> None:
    steps = sorted(by_step)
    means = np.array([np.mean(by_step[step], axis=0)[1:] for step in steps])
    log_log(axes, steps, means[means > 0])
    steps_on_x(axes, steps)
    for values, marker, dashes, name in zip(means.T, "os", ((3, 1.5), ()), ("first iteration", "last iteration")):
        x, y = np.array(steps)[values > 0], values[values > 0]
        slope, offset = np.polyfit(np.log(x), np.log(y), 1)
        axes.plot(x, y, marker, color=color, markersize=5, label=f"{name}: slope {slope:.2f}",
                  markerfacecolor=color if not dashes else "white")
        axes.plot(x, np.exp(offset) * x**slope, color=GREY, linewidth=0.8, linestyle=(0, dashes) if dashes else "-")
    axes.set_xlabel("time step (s)")
    axes.legend(frameon=False, fontsize=8, loc="upper left")
