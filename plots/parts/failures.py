"""The strip above the axes: a row for each solver that failed somewhere, and what its marks say."""

from __future__ import annotations

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.ticker import NullLocator

from parts.best_points import FigureData
from parts.colors import DARK_GREY, LIGHT_GREY
from parts.curves import Styles, line_of
from parts.scales import gap
from parts.sheet import LEFT, ROW_HEIGHT, Sheet
from parts.words import clean, shorten

NAME_SIZE = 6.5
FAILED, FAILED_OR_WRONG = "failed at every step", "failed or too wrong at every step"


@dataclass(frozen=True)
class Mark:
    """A sign in the strip above the axes: a failure's letters."""

    x: float
    text: str


Rows = dict[str, list[Mark]]


def letters_in(rows: Rows) -> set[str]:
    return {letter for marks in rows.values() for mark in marks for letter in mark.text}


def failed_rows(figure: FigureData, styles: Styles, x_factor: float = 1.0) -> Rows:
    """Marks for each contestant that failed at some x. Backends out of competition are not held to the limit."""
    contestants = [solver for solver in styles if styles[solver].contestant and styles[solver].leads]
    rows = {s: [Mark(f.x * x_factor, f.letters) for f in figure.curves[s].failures] for s in contestants}
    return {solver: marks for solver, marks in rows.items() if marks}


def add_strip(sheet: Sheet, main: Axes, rows: Rows, styles: Styles, title: str, names: bool = True) -> None:
    if not rows:
        return
    box = main.get_position()
    strip = sheet.axes(box.x0 * sheet.width, box.y1 * sheet.height, box.width * sheet.width, ROW_HEIGHT * len(rows))
    _draw_strip(strip, main, rows, styles, names)
    strip.set_title(title, loc="right", fontsize=7, pad=2, color=DARK_GREY)


def _draw_strip(axes: Axes, beneath: Axes, rows: Rows, styles: Styles, names: bool) -> None:
    """A strip on the top edge of `beneath` with one row a solver, so that failures at one x never hide each other."""
    axes.set_facecolor(LIGHT_GREY)
    axes.set_xscale(beneath.get_xscale())
    axes.set_xlim(beneath.get_xlim())
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.spines[["left", "top"]].set_visible(False)
    axes.xaxis.set_major_locator(NullLocator())
    axes.xaxis.set_minor_locator(NullLocator())
    axes.tick_params(axis="y", length=0, labelsize=NAME_SIZE)
    axes.set_yticks(range(len(rows)), [shorten(clean(name), LEFT - 0.15, NAME_SIZE) if names else "" for name in rows])
    points_wide = axes.get_figure().get_figwidth() * axes.get_position().width * 72
    for row, (solver, marks) in enumerate(rows.items()):
        style = styles[solver]
        for mark, after in zip(marks, marks[1:] + [None]):
            sign = line_of(style, [mark.x], [row], zorder=5)
            sign.set(linestyle="none", clip_on=False)
            axes.add_line(sign)
            if after and mark.text == after.text and gap(axes, mark.x, after.x) * points_wide < 7 + 5 * len(mark.text):
                continue  # no room, and the next mark says the same
            # words that would run out of the strip go to the left of their mark
            turned = (1 - gap(axes, axes.get_xlim()[0], mark.x)) * points_wide < 4 * len(mark.text)
            axes.annotate(mark.text, (mark.x, row), (-4.5 if turned else 4.5, -0.3), textcoords="offset points",
                          fontsize=NAME_SIZE, ha="right" if turned else "left", va="center_baseline", annotation_clip=False)
