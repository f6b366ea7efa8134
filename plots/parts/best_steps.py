"""The panel of the steps that the best points were run at."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.text import Annotation
from matplotlib.transforms import ScaledTranslation, Transform

from parts.best_points import Best, Curve, FigureData
from parts.curves import Styles, line_of
from parts.scales import gap, log_step_axis
from parts.style import SolverStyle


def steps_label(figure: FigureData) -> str:
    return "mean time step (s)" if figure.adaptive else "best time step (s)"


def draw_steps(axes: Axes, figure: FigureData, styles: Styles, x_factor: float = 1.0) -> None:
    """The step each best point was run at. Solvers often share one, so equal steps are fanned out sideways."""
    contestants = {s: style for s, style in styles.items() if style.contestant and style.leads and not style.hollow}
    taken: dict[tuple[float, int], list[str]] = {}
    for solver in contestants:
        for best in figure.curves[solver].best:
            if best.step:
                taken.setdefault((best.x, _rung(best.step)), []).append(solver)
    log_step_axis(axes, [b.step for s in contestants for b in figure.curves[s].best if b.step])
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
            if best.ladder_end:
                axes.add_artist(_arrow(best, x_factor, style, moved))


def _arrow(best: Best, x_factor: float, style: SolverStyle, place: Transform) -> Annotation:
    """Points on, from the marker of a step at the ladder's end."""
    there = (0.9 * style.size + 1.5) * best.ladder_end
    return Annotation("\u2191" if best.ladder_end > 0 else "\u2193", (best.x * x_factor, best.step), (0, there), xycoords=place,
                      textcoords="offset points", fontsize=8, color=style.color, ha="center",
                      va="bottom" if best.ladder_end > 0 else "top", zorder=12, annotation_clip=False, clip_on=False)


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
    gaps = [gap(axes, a, b) * wide for a, b in zip(xs, xs[1:])]
    return min([5.5] + [room / (most + 0.5) for room in gaps])
