"""Curves of time, the names at their ends, the steps beneath them, and the strip of failures above them."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.text import Annotation
from matplotlib.ticker import NullLocator
from matplotlib.transforms import ScaledTranslation

from parts.axes import log_steps_on_y, set_ticks
from parts.result import Json, Result
from parts.sheet import END_WIDTH, LEFT, LEGEND_SIZE, ROW_HEIGHT, Sheet
from parts.style import DARK_GREY, LIGHT_GREY, Styles, line_of
from parts.words import short, shorten, wrap

NAME_SIZE = 6.5
Rows = dict[str, list[tuple[float, str]]]  # of a strip: x and letters, by solver


@dataclass(frozen=True)
class Best:
    """The fastest run of one solver at one x."""

    x: float
    seconds: float
    step: float
    ladder_end: str  # whether the step is the coarsest or the finest of those tried


@dataclass(frozen=True)
class Curve:
    best: list[Best]
    failures: list[tuple[float, str]]


Curves = dict[str, Curve]


def curves_in(panel: Json, result: Result, factor: float = 1.0, time: str = "time") -> Curves:
    """Curves of the program's analysis, a solver's the fastest of its tuned and untuned settings; factor: of x. time: "filter" for the
    filter's own."""
    best: dict[str, dict[float, Best]] = {}
    failures: dict[str, dict[float, str]] = {}
    for name, curve in panel.items():
        solver = result.at_any_settings(name)
        own = best.setdefault(solver, {})
        for run in curve.get("best", []):
            if run[time] and (run["x"] not in own or run[time][0] < own[run["x"]].seconds):
                own[run["x"]] = Best(factor * run["x"], run[time][0], run["step"], run["ladder_end"])
        failures.setdefault(solver, {}).update(curve.get("failures", []))
    return {name: Curve([own[x] for x in sorted(own)], sorted((factor * x, why) for x, why in failures[name].items() if x not in own))
            for name, own in best.items()}


def all_best(curves: Curves) -> list[Best]:
    return [best for curve in curves.values() for best in curve.best]


def draw_curves(axes: Axes, curves: Curves, styles: Styles, stairs: bool) -> None:
    """Time over x; stairs: a run counts for every larger x."""
    for order, (solver, style) in enumerate(styles.items()):
        if solver in curves and curves[solver].best:
            line = line_of(style, *zip(*((b.x, b.seconds) for b in curves[solver].best)), zorder=10 + len(styles) - order if style.leads else 2)
            line.set_drawstyle("steps-post" if stairs else "default")
            axes.add_line(line)


def ends_of(curves: Curves) -> dict[str, tuple[float, float]]:
    """Where each curve ends on the right."""
    return {solver: (curve.best[-1].x, curve.best[-1].seconds) for solver, curve in curves.items() if curve.best}


def label_ends(axes: Axes, curves: Curves, styles: Styles) -> None:
    """Each curve's name, to the right of the axes at the height of its end, moved apart where ends are close."""
    width, height = 72 * axes.get_position().size * axes.get_figure().get_size_inches()  # points
    ends = {name: (x, y, height * axes.transAxes.inverted().transform(axes.transData.transform((x, y)))[1])
            for name, (x, y) in ends_of(curves).items()}
    names = sorted(ends, key=lambda name: ends[name][2])
    lines = [wrap(short(styles[name].label), END_WIDTH - 0.3, LEGEND_SIZE)[:3] for name in names]
    halves = [0.6 * LEGEND_SIZE * len(text) + 1 for text in lines]
    places = [ends[name][2] for name in names]
    for _ in range(500):  # neighbours that overlap push each other apart, the axes' ends hold them
        for k in range(len(names)):
            if k and (overlap := places[k - 1] + halves[k - 1] + halves[k] - places[k]) > 0:
                places[k - 1], places[k] = places[k - 1] - overlap / 2, places[k] + overlap / 2
            places[k] = min(max(places[k], halves[k]), height - halves[k])
    for name, text, place in zip(names, lines, places):
        axes.annotate("\n".join(text), ends[name][:2], (1 + 14 / width, place / height), textcoords="axes fraction", va="center",
                      fontsize=LEGEND_SIZE, color=[0.75 * part for part in to_rgb(styles[name].color)], linespacing=1.0, annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": "#AAAAAA", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 3, "relpos": (0, 0.5)})


def draw_steps(axes: Axes, curves: Curves, styles: Styles) -> None:
    """Solvers often share a step, so each is moved sideways a little; an arrow marks the coarsest or finest step tried."""
    shown = [(style, curves[solver].best) for solver, style in styles.items() if style.leads and solver in curves]
    log_steps_on_y(axes, [b.step for _, best in shown for b in best])
    for place, (style, best) in enumerate(shown):
        moved = axes.transData + ScaledTranslation(3 * (place - len(shown) / 2) / 72, 0, axes.get_figure().dpi_scale_trans)
        line = line_of(style, [b.x for b in best], [b.step for b in best], zorder=10)
        line.set(transform=moved, markersize=0.7 * style.look.size, linewidth=0.7)
        axes.add_artist(line)
        for b in best:
            if b.ladder_end:
                sign, up, beside = ("\u2191", 4, "bottom") if b.ladder_end == "coarsest" else ("\u2193", -4, "top")
                axes.add_artist(Annotation(sign, (b.x, b.step), (0, up), xycoords=moved, textcoords="offset points", fontsize=8,
                                           color=style.color, ha="center", va=beside, zorder=12, annotation_clip=False, clip_on=False))


def failed_rows(curves: Curves, styles: Styles) -> Rows:
    return {solver: curves[solver].failures for solver, style in styles.items() if style.leads and solver in curves and curves[solver].failures}


def letters_in(rows: Rows) -> set[str]:
    return {letter for marks in rows.values() for _, letters in marks for letter in letters}


def add_strip(sheet: Sheet, beneath: Axes, rows: Rows, styles: Styles) -> None:
    """On the top edge of `beneath`, with one row a solver, so that failures at one x never hide each other."""
    if not rows:
        return
    box = beneath.get_position()
    axes = sheet.axes(box.x0 * sheet.width, box.y1 * sheet.height, box.width * sheet.width, ROW_HEIGHT * len(rows))
    axes.set(facecolor=LIGHT_GREY, xscale=beneath.get_xscale(), xlim=beneath.get_xlim(), ylim=(len(rows) - 0.5, -0.5))
    axes.spines[["left", "top"]].set_visible(False)
    set_ticks(axes.xaxis, NullLocator(), NullLocator())
    axes.tick_params(axis="y", length=0, labelsize=NAME_SIZE)
    axes.set_yticks(range(len(rows)), [shorten(short(styles[name].label), LEFT - 0.15, NAME_SIZE) for name in rows])
    for row, (solver, marks) in enumerate(rows.items()):
        for x, letters in marks:
            sign = line_of(styles[solver], [x], [row], zorder=5)
            sign.set(linestyle="none", clip_on=False)
            axes.add_line(sign)
            # words that could run out of the strip go to the left of their mark
            turned = x > np.sqrt(np.prod(axes.get_xlim()))
            axes.annotate(letters, (x, row), (-4.5 if turned else 4.5, -0.3), textcoords="offset points",
                          fontsize=NAME_SIZE, ha="right" if turned else "left", va="center_baseline", annotation_clip=False)
    axes.set_title("no run that counts", loc="right", fontsize=7, pad=2, color=DARK_GREY)
