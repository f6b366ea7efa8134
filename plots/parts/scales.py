"""Scales of axes: where they end, and which values have ticks and words."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

from parts.best_points import FigureData

COARSEST_STEP = 1 / 25  # the ladder of steps starts here (docs/measuring.md)


def log_x(axes: Axes, ticks: list[float], inches: float) -> None:
    """Log axis with a tick at each value that was measured, as far as their labels have room."""
    axes.set_xscale("log")
    low, high = min(ticks), max(ticks)
    pad = max((high / low) ** 0.06, 1.15)
    axes.set_xlim(low / pad, high * pad)
    scale = inches / math.log10(high * pad * pad / low)
    axes.xaxis.set_major_locator(FixedLocator(_with_room(ticks, scale)))
    axes.xaxis.set_minor_locator(FixedLocator(ticks))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:.7g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _with_room(ticks: list[float], inches_per_decade: float) -> list[float]:
    """From the largest value down, each tick whose label does not touch the one before it."""
    kept: list[float] = []
    for tick in sorted(ticks, reverse=True):
        needed = 0.07 * len(f"{tick:.7g}") + 0.08
        if not kept or math.log10(kept[-1] / tick) * inches_per_decade >= needed:
            kept.append(tick)
    return kept


def log_y(axes: Axes, figure: FigureData) -> None:
    axes.set_yscale("log")
    values = [v for curve in figure.curves.values() for b in curve.best for v in (b.low, b.seconds, b.high) if v > 0]
    low, high = (min(values), max(values)) if values else (0.1, 10.0)
    axes.set_ylim(low / 1.6, high * 1.6)
    decades = math.log10(high / low)
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0,) if decades > 2 else (1.0, 2.0, 5.0)))
    axes.yaxis.set_minor_locator(LogLocator(subs=range(2, 10)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())


def log_log(axes: Axes, xs: list[float], ys: list[float]) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(min(xs) / 1.5, max(xs) * 1.5)
    axes.set_ylim(min(ys) / 1.5, max(ys) * 1.5)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator())
        axis.set_minor_locator(LogLocator(subs=range(2, 10)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())


def step_axis(axes: Axes, steps: list[float]) -> None:
    ladder: list[float] = []
    for step in sorted(set(steps), reverse=True):
        if not ladder or step < 0.95 * ladder[-1]:
            ladder.append(step)
    stride = max(1, math.ceil(len(ladder) / 6))
    axes.xaxis.set_major_locator(FixedLocator(ladder[::stride]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda step, _: step_name(step)))


def log_step_axis(axes: Axes, steps: list[float]) -> None:
    axes.set_yscale("log")
    low, high = (min(steps), max(steps)) if steps else (COARSEST_STEP, COARSEST_STEP)
    room = 0.13 * math.log(high / low)  # for arrows, which are as long however many steps there are
    axes.set_ylim(low / math.exp(max(0.6, room)), high * math.exp(max(0.6, room)))
    rungs = range(math.floor(math.log2(COARSEST_STEP / high)), math.ceil(math.log2(COARSEST_STEP / low)) + 1)
    stride = max(1, math.ceil(len(rungs) / 8))
    axes.yaxis.set_major_locator(FixedLocator([COARSEST_STEP / 2.0**k for k in rungs[::stride]]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda step, _: step_name(step)))


def step_name(step: float) -> str:
    return f"1/{1 / step:.6g}" if step < 1 else f"{step:g}"


def gap(axes: Axes, left: float, right: float) -> float:
    """Distance of two x values as a fraction of the axes' width."""
    to_axes = axes.transData + axes.transAxes.inverted()
    return to_axes.transform((right, 0))[0] - to_axes.transform((left, 0))[0]
