"""What a solver that reports a residual leaves of the constraint direction's equation, mean |F|, over time and over the step
(Figure 3 of the paper). Drawn for whoever has a series of residuals."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from parts.axes import grid, log_log, set_ticks, steps_on_x
from parts.result import Figures, Result
from parts.runs import Series, StepSweep, step_sweeps_in
from parts.sheet import GAP, MAIN_HEIGHT, NARROW, RIGHT, make_sheet
from parts.style import GREY, styles_for
from parts.words import file_part, percent, step_name, subject

ByStep = dict[float, Series]
WIDTH = 3.7  # of a panel, inches


def figures_of(result: Result, every: bool = False) -> Figures:
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
    by_step, label = sweep.residuals[solver][limit], result.title(solver)
    color = styles_for([solver], result)[solver].color
    words = [f"{sweep.vertices:,.0f} vertices, strain limit {percent(limit)}; F is what is left of the implicit constraint direction's equation "
             "F = 0, its mean over the vertices. Right: its mean over the samples at left in which a step needed an iteration at all; "
             "lines are fitted over all steps shown."]
    steps = np.array(sorted(by_step))
    means = np.array([np.mean(by_step[step], axis=0)[1:] for step in steps]).T
    fits = [np.polyfit(np.log(steps[left > 0]), np.log(left[left > 0]), 1) for left in means]
    title = (f"{label[:1].upper()}{label[1:]}, {subject(sweep.scene)}: halving the time step divides the last iteration's residual by "
             f"{2 ** fits[1][0]:.2g}")
    sheet = make_sheet(result, title, words, NARROW + 2 * WIDTH + GAP + RIGHT, MAIN_HEIGHT)
    left, right = (sheet.axes(NARROW + place * (WIDTH + GAP), sheet.bottom, WIDTH, MAIN_HEIGHT) for place in (0, 1))
    _draw_over_time(left, by_step, color)
    _draw_over_step(right, steps, means, fits, color)
    for axes in (left, right):
        grid(axes)
    return sheet.figure


def _draw_over_time(axes: Axes, by_step: ByStep, color: str) -> None:
    steps = sorted(by_step, reverse=True)
    axes.set_yscale("log")
    for step, opacity in zip((steps[0], steps[len(steps) // 2]), (1, 0.5)):
        time, first, last = zip(*by_step[step])
        for name, left, width, dashes in (("first", first, 1, (0, (3, 1.5))), ("last", last, 1.4, "-")):
            axes.plot(time, left, color=color, alpha=opacity, linewidth=width, linestyle=dashes,
                      label=f"{name} iteration, h = {step_name(step)} s")
    axes.set(xlabel="time (s)", ylabel="mean |F| (m)")
    set_ticks(axes.yaxis, LogLocator(), LogLocator(subs=range(2, 10)), lambda y: f"{y:.0e}")
    axes.legend(frameon=False, fontsize=7.5, loc="best")


def _draw_over_step(axes: Axes, steps: np.ndarray, means: np.ndarray, fits: list[np.ndarray], color: str) -> None:
    log_log(axes, steps, means[means > 0])
    steps_on_x(axes, steps)
    for y, (slope, offset), marker, dashes, name in zip(means, fits, "os", ((3, 1.5), ()), ("first iteration", "last iteration")):
        x = steps[y > 0]
        axes.plot(x, y[y > 0], marker, color=color, markersize=5, label=f"{name}: slope {slope:.2f}",
                  markerfacecolor=color if not dashes else "white")
        axes.plot(x, np.exp(offset) * x**slope, color=GREY, linewidth=0.8, linestyle=(0, dashes) if dashes else "-")
    axes.set_xlabel("time step (s)")
    axes.legend(frameon=False, fontsize=8, loc="upper left")
