"""Curves with their solver's look, and lines of known slope to read them against."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from parts.best_points import FigureData
from parts.colors import GREY
from parts.style import SolverStyle

Styles = dict[str, SolverStyle]


def draw_curves(axes: Axes, figure: FigureData, styles: Styles, x_factor: float = 1.0) -> None:
    """Time over x with thin bars up to the median of the samples."""
    for order, (solver, style) in enumerate(styles.items()):
        best = figure.curves[solver].best
        if not best:
            continue
        x = [b.x * x_factor for b in best]
        y = [b.seconds for b in best]
        z = 10 + len(styles) - order if style.contestant and style.leads else 2
        if style.contestant and style.leads:  # for the others a bar would be heavier than the line
            bars = [[b.seconds - b.low for b in best], [b.high - b.seconds for b in best]]
            axes.errorbar(x, y, yerr=bars, fmt="none", ecolor=style.color, elinewidth=0.7, capsize=1.8, capthick=0.7,
                          zorder=z)
        axes.add_line(line_of(style, x, y, zorder=z))


def ends_of(figure: FigureData, x_factor: float = 1.0) -> dict[str, tuple[float, float]]:
    """Where each curve ends on the right."""
    last = {solver: max(curve.best, key=lambda best: best.x) for solver, curve in figure.curves.items() if curve.best}
    return {solver: (best.x * x_factor, best.seconds) for solver, best in last.items()}


def line_of(style: SolverStyle, x: list[float], y: list[float], **more: float) -> Line2D:
    """Line with the solver's look; the thin white rim keeps markers apart where curves run on top of one another."""
    line = Line2D(x, y, color=style.color, marker=style.marker, markersize=style.size, linewidth=style.width, **more)
    line.set_linestyle((0, style.dashes) if style.dashes else "-")
    if style.hollow:
        line.set(markerfacecolor="none", markeredgecolor=style.color, markeredgewidth=0.9)
    elif style.marker not in ("+", "x", "1"):  # these have no face that a rim could surround
        line.set(markeredgecolor="white", markeredgewidth=0.5)
    return line


def draw_slopes(axes: Axes) -> None:
    """Faint lines of slope 1 and 2 through the lower left corner, to read the curves' slopes against."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    for power in (1, 2):
        end = min(right, left * (high / low) ** (1 / power))
        axes.plot([left, end], [low, low * (end / left) ** power], color=GREY, linewidth=0.6, linestyle=(0, (1, 3)),
                  zorder=1)


def draw_noise(axes: Axes, factor: float | None) -> None:
    """A bar in the lower right corner, on a log axis: two points that are less than its height apart do not differ."""
    if factor is None or axes.get_yscale() != "log":
        return
    low, high = axes.get_ylim()
    bottom = low * (high / low) ** 0.04
    across = axes.get_yaxis_transform()  # x over the axes' width, y as it is
    axes.plot([0.975, 0.975], [bottom, bottom * factor], transform=across, color="black", linewidth=1.2, marker="_", markersize=5,
              zorder=30, gid="noise")
    axes.text(0.96, bottom * factor**0.5, "A/A noise", transform=across, ha="right", va="center", fontsize=6.5, zorder=30)
