"""The panels that figures are put together from. Each function draws into axes that it is given and returns nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator
from matplotlib.transforms import ScaledTranslation

from results import Curve, FigureData
from style import GREY, LIGHT_GREY, SolverStyle

Styles = dict[str, SolverStyle]
COARSEST_STEP = 1 / 25  # the ladder of steps starts here (docs/measuring.md)
CLIP_RATIO = 20.0       # a solver this many times slower than the fastest one leaves the linear panel at its top
ARROW = "\u2191"         # "this point lies above the axes"


@dataclass(frozen=True)
class Mark:
    """A sign in the strip above the axes: a failure's letters, or an arrow for a point off the scale."""

    x: float
    text: str


Rows = dict[str, list[Mark]]


def draw_curves(axes: Axes, figure: FigureData, styles: Styles, x_factor: float = 1.0) -> None:
    """Median over x with thin bars from the first to the third quartile."""
    for order, (solver, style) in enumerate(styles.items()):
        best = figure.curves[solver].best
        if not best:
            continue
        x = [b.x * x_factor for b in best]
        y = [b.seconds for b in best]
        z = 10 + len(styles) - order if style.contestant else 2
        if style.contestant:  # for the others a bar would be heavier than the line
            bars = [[b.seconds - b.q1 for b in best], [b.q3 - b.seconds for b in best]]
            axes.errorbar(x, y, yerr=bars, fmt="none", ecolor=style.color, elinewidth=0.7, capsize=1.8, capthick=0.7,
                          zorder=z)
        axes.add_line(line_of(style, x, y, zorder=z))


def line_of(style: SolverStyle, x: list[float], y: list[float], **more: float) -> Line2D:
    """Line with the solver's look; the thin white rim keeps markers apart where curves run on top of one another."""
    line = Line2D(x, y, color=style.color, marker=style.marker, markersize=style.size, linewidth=style.width, **more)
    line.set_linestyle((0, style.dashes) if style.dashes else "-")
    if style.marker != "+":  # has no face that a rim could surround
        line.set(markeredgecolor="white", markeredgewidth=0.5)
    return line


# ---- scales -------------------------------------------------------------------------------------------------------

def log_x(axes: Axes, ticks: list[float], inches: float) -> None:
    """Log axis with a tick at each value that was measured, as far as their labels have room."""
    axes.set_xscale("log")
    low, high = min(ticks), max(ticks)
    pad = max((high / low) ** 0.06, 1.15)
    axes.set_xlim(low / pad, high * pad)
    scale = inches / math.log10(high * pad * pad / low)
    axes.xaxis.set_major_locator(FixedLocator(_with_room(ticks, scale)))
    axes.xaxis.set_minor_locator(FixedLocator(ticks))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:.6g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _with_room(ticks: list[float], inches_per_decade: float) -> list[float]:
    """From the largest value down, each tick whose label does not touch the one before it."""
    kept: list[float] = []
    for tick in sorted(ticks, reverse=True):
        needed = 0.07 * len(f"{tick:.6g}") + 0.08
        if not kept or math.log10(kept[-1] / tick) * inches_per_decade >= needed:
            kept.append(tick)
    return kept


def log_y(axes: Axes, figure: FigureData) -> None:
    axes.set_yscale("log")
    values = [v for curve in figure.curves.values() for b in curve.best for v in (b.q1, b.seconds, b.q3) if v > 0]
    low, high = (min(values), max(values)) if values else (0.1, 10.0)
    axes.set_ylim(low / 1.6, high * 1.6)
    decades = math.log10(high / low)
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0,) if decades > 2 else (1.0, 2.0, 5.0)))
    axes.yaxis.set_minor_locator(LogLocator(subs=range(2, 10)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())


def linear_scales(axes: Axes, figure: FigureData, xs: list[float], top: float) -> None:
    axes.set_xlim(0, 1.06 * max(xs))
    axes.set_ylim(0, top)
    axes.xaxis.set_major_locator(MaxNLocator(6))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))


def linear_top(figure: FigureData, styles: Styles) -> float:
    """Upper limit of the linear panel: fits all solvers within CLIP_RATIO of the fastest, and two in any case."""
    def slowest(solver: str) -> float:
        return max(b.q3 for b in figure.curves[solver].best)

    peaks = sorted(slowest(s) for s, style in styles.items() if style.contestant and figure.curves[s].best)
    if not peaks:
        peaks = sorted(slowest(s) for s in styles if figure.curves[s].best) or [1.0]
    shown = [peak for peak in peaks if peak <= CLIP_RATIO * peaks[0]]
    return 1.15 * max(shown + peaks[:2])


def draw_slopes(axes: Axes) -> None:
    """Faint lines of slope 1 and 2 through the lower left corner, to read the curves' slopes against."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    for power in (1, 2):
        end = min(right, left * (high / low) ** (1 / power))
        axes.plot([left, end], [low, low * (end / left) ** power], color=GREY, linewidth=0.6, linestyle=(0, (1, 3)),
                  zorder=1)


# ---- failures and points off the scale ----------------------------------------------------------------------------

def failed_rows(figure: FigureData, styles: Styles, x_factor: float = 1.0) -> Rows:
    """Marks for each contestant that failed at some x. Backends out of competition are not held to the limit."""
    contestants = [solver for solver in styles if styles[solver].contestant]
    rows = {s: [Mark(f.x * x_factor, f.letters) for f in figure.curves[s].failures] for s in contestants}
    return {solver: marks for solver, marks in rows.items() if marks}


def clipped_rows(figure: FigureData, styles: Styles, top: float) -> Rows:
    """Failures, and an arrow for each point above `top`; the highest point of a solver has its value beside it."""
    failed = failed_rows(figure, styles)
    rows: Rows = {}
    for solver in styles:
        above = [b for b in figure.curves[solver].best if b.seconds > top]
        peak = max(above, key=lambda b: b.seconds, default=None)
        arrows = [Mark(b.x, f"{ARROW} {b.seconds:.3g} s" if b is peak else ARROW) for b in above]
        marks = sorted(arrows + failed.get(solver, []), key=lambda mark: mark.x)
        if marks:
            rows[solver] = marks
    return rows


def draw_strip(axes: Axes, beneath: Axes, rows: Rows, styles: Styles, names: bool) -> None:
    """A strip on the top edge of `beneath` with one row a solver, so that failures at one x never hide each other."""
    axes.set_facecolor(LIGHT_GREY)
    axes.set_xscale(beneath.get_xscale())
    axes.set_xlim(beneath.get_xlim())
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.spines[["left", "top"]].set_visible(False)
    axes.xaxis.set_major_locator(NullLocator())
    axes.xaxis.set_minor_locator(NullLocator())
    axes.tick_params(axis="y", length=0, labelsize=6.5)
    axes.set_yticks(range(len(rows)), list(rows) if names else [""] * len(rows))
    points_wide = axes.get_figure().get_figwidth() * axes.get_position().width * 72
    for row, (solver, marks) in enumerate(rows.items()):
        style = styles[solver]
        for mark, after in zip(marks, marks[1:] + [None]):
            sign = line_of(style, [mark.x], [row], zorder=5)
            sign.set(linestyle="none", clip_on=False)
            axes.add_line(sign)
            if after and mark.text == after.text and _gap(axes, mark.x, after.x) * points_wide < 7 + 5 * len(mark.text):
                continue  # no room, and the next mark says the same
            # words that would run out of the strip go to the left of their mark
            turned = (1 - _gap(axes, axes.get_xlim()[0], mark.x)) * points_wide < 4 * len(mark.text)
            axes.annotate(mark.text, (mark.x, row), (-4.5 if turned else 4.5, -0.3), textcoords="offset points", fontsize=6.5,
                          ha="right" if turned else "left", va="center_baseline", annotation_clip=False)


def _gap(axes: Axes, left: float, right: float) -> float:
    """Distance of two x values as a fraction of the axes' width."""
    to_axes = axes.transData + axes.transAxes.inverted()
    return to_axes.transform((right, 0))[0] - to_axes.transform((left, 0))[0]


# ---- best steps ---------------------------------------------------------------------------------------------------

def draw_steps(axes: Axes, figure: FigureData, styles: Styles, x_factor: float = 1.0) -> None:
    """The step each best point was run at. Solvers often share one, so equal steps are fanned out sideways."""
    contestants = {s: style for s, style in styles.items() if style.contestant}
    taken: dict[tuple[float, int], list[str]] = {}
    for solver in contestants:
        for best in figure.curves[solver].best:
            if best.step:
                taken.setdefault((best.x, _rung(best.step)), []).append(solver)
    _log_step_axis(axes, [b.step for s in contestants for b in figure.curves[s].best if b.step])
    for solver, style in contestants.items():
        _faint_line(axes, figure.curves[solver], style, x_factor)
    spread = _fan_spacing(axes, figure, x_factor, max((len(solvers) for solvers in taken.values()), default=1))
    for solver, style in contestants.items():
        for best in (b for b in figure.curves[solver].best if b.step):
            solvers = taken[best.x, _rung(best.step)]
            shift = (solvers.index(solver) - (len(solvers) - 1) / 2) * spread
            moved = axes.transData + ScaledTranslation(shift / 72, 0, axes.get_figure().dpi_scale_trans)
            marker = line_of(style, [best.x * x_factor], [best.step], zorder=10)
            marker.set(linestyle="none", transform=moved, markersize=0.85 * style.size)
            axes.add_artist(marker)


def _rung(step: float) -> int:
    """Steps within a tenth of an octave count as one."""
    return round(10 * math.log2(step))


def _faint_line(axes: Axes, curve: Curve, style: SolverStyle, x_factor: float) -> None:
    best = [b for b in curve.best if b.step]
    line = line_of(style, [b.x * x_factor for b in best], [b.step for b in best], zorder=3)
    line.set(marker="", linewidth=0.7, alpha=0.6)
    axes.add_line(line)


def _fan_spacing(axes: Axes, figure: FigureData, x_factor: float, most: int) -> float:
    """Points between fanned markers: as wide as a marker if the nearest x leaves that much room."""
    xs = sorted({b.x * x_factor for curve in figure.curves.values() for b in curve.best})
    wide = axes.get_figure().get_figwidth() * axes.get_position().width * 72
    gaps = [_gap(axes, a, b) * wide for a, b in zip(xs, xs[1:])]
    return min([5.5] + [gap / (most + 0.5) for gap in gaps])


def _log_step_axis(axes: Axes, steps: list[float]) -> None:
    axes.set_yscale("log")
    low, high = (min(steps), max(steps)) if steps else (COARSEST_STEP, COARSEST_STEP)
    axes.set_ylim(low / 1.7, high * 1.7)
    rungs = range(math.floor(math.log2(COARSEST_STEP / high)), math.ceil(math.log2(COARSEST_STEP / low)) + 1)
    stride = max(1, math.ceil(len(rungs) / 8))
    axes.yaxis.set_major_locator(FixedLocator([COARSEST_STEP / 2.0**k for k in rungs[::stride]]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda step, _: f"1/{1 / step:.6g}" if step < 1 else f"{step:g}"))
