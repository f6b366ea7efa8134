"""Logarithmic axes: where they end, which values have ticks and words, and lines of known slope to read curves against."""

import math

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import FixedLocator, FuncFormatter, Locator, LogLocator, NullFormatter, NullLocator

from parts.style import GREY
from parts.words import step_name

COARSEST_STEP = 1 / 25  # the ladder of steps starts here (docs/measuring.md)


def set_ticks(axis: Axis, major: Locator, minor: Locator, text=lambda value: f"{value:g}") -> None:
    axis.set_major_locator(major)
    axis.set_minor_locator(minor)
    axis.set_major_formatter(FuncFormatter(lambda value, _: text(value)))
    axis.set_minor_formatter(NullFormatter())


def _log(axis: Axis, values: list[float], room: float, *ticks) -> None:
    """A logarithmic axis that reaches beyond all values by a factor."""
    name = axis.axis_name
    axis.axes.set(**{f"{name}scale": "log", f"{name}lim": (min(values) / room, max(values) * room)})
    set_ticks(axis, *ticks)


def log_x(axes: Axes, ticks: list[float], inches: float) -> None:
    """A tick at each value that was measured, as far as their labels have room."""
    ticks = sorted(set(ticks))
    spread = ticks[-1] / ticks[0]
    pad = max(spread**0.06, 1.15)
    scale = inches / math.log10(spread * pad * pad)
    kept: list[float] = []  # from the largest value down, each whose label does not touch the one before it
    for tick in reversed(ticks):
        if not kept or math.log10(kept[-1] / tick) * scale >= 0.07 * len(f"{tick:.7g}") + 0.08:
            kept.append(tick)
    _log(axes.xaxis, ticks, pad, FixedLocator(kept), FixedLocator(ticks), lambda x: f"{x:.7g}")


def log_y(axes: Axes, values: list[float]) -> None:
    values = values or [0.1, 10.0]
    few = max(values) / min(values) <= 100
    _log(axes.yaxis, values, 1.6, LogLocator(subs=(1.0, 2.0, 5.0) if few else (1.0,)), LogLocator(subs=range(2, 10)))


def log_log(axes: Axes, xs: list[float], ys: list[float]) -> None:
    for axis, values in ((axes.xaxis, xs), (axes.yaxis, ys)):
        _log(axis, values, 1.5, LogLocator(), LogLocator(subs=range(2, 10)))


def steps_on_x(axes: Axes, steps: list[float]) -> None:
    """A tick at each step that differs from the one before it, as far as there is room."""
    ladder: list[float] = []
    for step in sorted(set(steps), reverse=True):
        if not ladder or step < 0.95 * ladder[-1]:
            ladder.append(step)
    set_ticks(axes.xaxis, FixedLocator(ladder[::math.ceil(len(ladder) / 6)]), NullLocator(), step_name)


def log_steps_on_y(axes: Axes, steps: list[float]) -> None:
    steps = steps or [COARSEST_STEP]
    room = math.exp(max(0.6, 0.13 * math.log(max(steps) / min(steps))))  # for arrows, which are as long however many steps there are
    rungs = range(math.floor(math.log2(COARSEST_STEP / max(steps))), math.ceil(math.log2(COARSEST_STEP / min(steps))) + 1)
    _log(axes.yaxis, steps, room, FixedLocator([COARSEST_STEP / 2.0**k for k in rungs[::math.ceil(len(rungs) / 8)]]), NullLocator(), step_name)


def grid(axes: Axes) -> None:
    axes.grid(which="major", color="#DDDDDD", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines["top"].set_visible(False)


def draw_slopes(axes: Axes) -> None:
    """Faint lines of slope 1 and 2 through the upper right corner, to read the curves' slopes against; clipped at the axes."""
    low, high = axes.get_xlim()
    for power in (1, 2):
        axes.plot((low, high), [axes.get_ylim()[1] * (x / high) ** power for x in (low, high)], color=GREY, linewidth=0.6,
                  linestyle=(0, (1, 3)), zorder=1)
