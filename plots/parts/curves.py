"""Curves of time, the steps beneath them, and the strip of failures above them."""

import math
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.text import Annotation
from matplotlib.ticker import NullLocator
from matplotlib.transforms import ScaledTranslation

from parts.axes import gap, log_steps_on_y, set_ticks
from parts.result import Json
from parts.sheet import LEFT, ROW_HEIGHT, Sheet
from parts.style import DARK_GREY, LIGHT_GREY, Styles, line_of
from parts.words import clean, shorten

NAME_SIZE = 6.5
Rows = dict[str, list[tuple[float, str]]]  # of a strip: x and letters, by solver


@dataclass(frozen=True)
class Best:
    """The fastest run of one solver at one x: its least sample, and the median of three or more."""

    x: float
    seconds: float
    median: float
    step: float
    ladder_end: str  # whether the step is the coarsest or the finest of those tried


@dataclass(frozen=True)
class Curve:
    best: list[Best]
    failures: list[tuple[float, str]]


Curves = dict[str, Curve]


def curves_in(panel: Json, factor: float = 1.0, time: str = "time") -> Curves:
    """Curves of the program's analysis; factor: of x. time: "filter" for the filter's own."""
    return {name: Curve(sorted((Best(factor * best["x"], *best[time], best["step"], best["ladder_end"])
                                for best in curve.get("best", []) if best[time]), key=lambda best: best.x),
                        sorted((factor * x, letters) for x, letters in curve.get("failures", [])))
            for name, curve in panel.items()}


def all_best(curves: Curves) -> list[Best]:
    return [best for curve in curves.values() for best in curve.best]


def draw_curves(axes: Axes, curves: Curves, styles: Styles) -> None:
    """Time over x with thin bars up to the median of the samples."""
    for order, (solver, style) in enumerate(styles.items()):
        best = curves[solver].best if solver in curves else []
        if not best:
            continue
        x, y = [b.x for b in best], [b.seconds for b in best]
        z = 10 + len(styles) - order if style.prominent else 2
        if style.prominent:  # for the others a bar would be heavier than the line
            axes.errorbar(x, y, yerr=[[0.0] * len(best), [b.median - b.seconds for b in best]], fmt="none", ecolor=style.color,
                          elinewidth=0.7, capsize=1.8, capthick=0.7, zorder=z)
        axes.add_line(line_of(style, x, y, zorder=z))


def ends_of(curves: Curves) -> dict[str, tuple[float, float]]:
    """Where each curve ends on the right."""
    return {solver: (curve.best[-1].x, curve.best[-1].seconds) for solver, curve in curves.items() if curve.best}


def draw_noise(axes: Axes, factor: float | None) -> None:
    """A bar in the lower right corner, on a log axis: two points that are less than its height apart do not differ."""
    if factor is None:
        return
    low, high = axes.get_ylim()
    bottom = low * (high / low) ** 0.04
    across = axes.get_yaxis_transform()  # x over the axes' width, y as it is
    axes.plot([0.975, 0.975], [bottom, bottom * factor], transform=across, color="black", linewidth=1.2, marker="_", markersize=5,
              zorder=30, gid="noise")
    axes.text(0.96, bottom * factor**0.5, "A/A noise", transform=across, ha="right", va="center", fontsize=6.5, zorder=30)


# ---- the steps that the fastest runs took -----------------------------------------------------------------------------

def draw_steps(axes: Axes, curves: Curves, styles: Styles) -> None:
    """Solvers often share a step, so equal ones are fanned out sideways; an arrow marks the coarsest or finest step tried."""
    shown = {solver: (style, curves[solver].best) for solver, style in styles.items() if style.prominent and not style.hollow}
    log_steps_on_y(axes, [b.step for _, best in shown.values() for b in best])
    taken: dict[tuple[float, int], list[str]] = {}
    for solver, (style, best) in shown.items():
        for b in best:
            taken.setdefault((b.x, _rung(b.step)), []).append(solver)
        faint = line_of(style, [b.x for b in best], [b.step for b in best], zorder=3)
        faint.set(marker="", linewidth=0.7, alpha=0.6)
        axes.add_line(faint)
    most = max((len(solvers) for solvers in taken.values()), default=1)
    xs = sorted({b.x for b in all_best(curves)})
    # as wide as a marker if the nearest x leaves that much room
    spacing = min([5.5] + [gap(axes, a, b) / (most + 0.5) for a, b in zip(xs, xs[1:])])
    for solver, (style, best) in shown.items():
        for b in best:
            solvers = taken[b.x, _rung(b.step)]
            shift = (solvers.index(solver) - (len(solvers) - 1) / 2) * spacing
            moved = axes.transData + ScaledTranslation(shift / 72, 0, axes.get_figure().dpi_scale_trans)
            marker = line_of(style, [b.x], [b.step], zorder=10)
            marker.set(linestyle="none", transform=moved, markersize=0.85 * style.look.size)
            axes.add_artist(marker)
            if b.ladder_end:
                sign, up, beside = ("\u2191", 1, "bottom") if b.ladder_end == "coarsest" else ("\u2193", -1, "top")
                axes.add_artist(Annotation(sign, (b.x, b.step), (0, (0.9 * style.look.size + 1.5) * up), xycoords=moved,
                                           textcoords="offset points", fontsize=8, color=style.color, ha="center", va=beside,
                                           zorder=12, annotation_clip=False, clip_on=False))


def _rung(step: float) -> int:
    """Steps within a tenth of an octave count as one."""
    return round(10 * math.log2(step))


# ---- failures ---------------------------------------------------------------------------------------------------------

def failed_rows(curves: Curves, styles: Styles) -> Rows:
    """Backends out of competition are not held to the limit."""
    return {solver: curves[solver].failures for solver, style in styles.items()
            if style.prominent and solver in curves and curves[solver].failures}


def letters_in(rows: Rows) -> set[str]:
    return {letter for marks in rows.values() for _, letters in marks for letter in letters}


def add_strip(sheet: Sheet, beneath: Axes, rows: Rows, styles: Styles, title: str) -> None:
    """On the top edge of `beneath`, with one row a solver, so that failures at one x never hide each other."""
    if not rows:
        return
    box = beneath.get_position()
    axes = sheet.axes(box.x0 * sheet.width, box.y1 * sheet.height, box.width * sheet.width, ROW_HEIGHT * len(rows))
    axes.set(facecolor=LIGHT_GREY, xscale=beneath.get_xscale(), xlim=beneath.get_xlim(), ylim=(len(rows) - 0.5, -0.5))
    axes.spines[["left", "top"]].set_visible(False)
    set_ticks(axes.xaxis, NullLocator(), NullLocator())
    axes.tick_params(axis="y", length=0, labelsize=NAME_SIZE)
    axes.set_yticks(range(len(rows)), [shorten(clean(name), LEFT - 0.15, NAME_SIZE) for name in rows])
    for row, (solver, marks) in enumerate(rows.items()):
        for (x, letters), after in zip(marks, [*marks[1:], None]):
            sign = line_of(styles[solver], [x], [row], zorder=5)
            sign.set(linestyle="none", clip_on=False)
            axes.add_line(sign)
            if after and letters == after[1] and gap(axes, x, after[0]) < 7 + 5 * len(letters):
                continue  # no room, and the next mark says the same
            # words that would run out of the strip go to the left of their mark
            turned = gap(axes, x, axes.get_xlim()[1]) < 4 * len(letters)
            axes.annotate(letters, (x, row), (-4.5 if turned else 4.5, -0.3), textcoords="offset points",
                          fontsize=NAME_SIZE, ha="right" if turned else "left", va="center_baseline", annotation_clip=False)
    axes.set_title(title, loc="right", fontsize=7, pad=2, color=DARK_GREY)
