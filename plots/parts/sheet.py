"""A sheet that panels are placed on by inches, with title, warnings, caption and legend; and how it is saved."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from parts.colors import ALARM
from parts.curves import Styles, line_of
from parts.result_file import ResultError
from parts.words import shorten, wrap

# All lengths in inches. Placing by hand keeps the panels' size the same, however long caption and legend are.
LEFT, GAP, RIGHT = 1.45, 0.75, 0.2
MAIN_WIDTH, LEGEND_WIDTH = 4.5, 3.0
MAIN_HEIGHT, STEPS_HEIGHT, ROW_HEIGHT = 3.3, 1.7, 0.16
BETWEEN, X_LABEL, LINE_HEIGHT = 0.14, 0.5, 0.15
MARGIN = 0.2
TIME_LABEL = "wall seconds per simulated second"

TITLE_SIZE, FINDING_SIZE, WARNING_SIZE, CAPTION_SIZE, LEGEND_SIZE = 11, 9, 9.5, 7.5, 8
FINDING_HEIGHT, LABEL_HEIGHT = 0.17, 0.145
LABEL_WIDTHS = {1: 2.05, 2: 1.65}  # of a legend's words, by its number of columns
LABEL_LINES = 2


@dataclass
class Sheet:
    """A matplotlib figure that is addressed in inches from its lower left corner; panels start at `bottom`."""

    figure: Figure
    width: float
    height: float
    bottom: float

    def axes(self, left: float, bottom: float, width: float, height: float, sharex: Axes | None = None,
             sharey: Axes | None = None) -> Axes:
        box = (left / self.width, bottom / self.height, width / self.width, height / self.height)
        return self.figure.add_axes(box, sharex=sharex, sharey=sharey)

    def text(self, left: float, bottom: float, words: str, **look: object) -> None:
        self.figure.text(left / self.width, bottom / self.height, words, va="top", **look)


def make_sheet(title: str, warnings: list[str], paragraphs: list[str], width: float, panels_height: float,
               hanging: float = 0, finding: str = "") -> Sheet:
    """An empty sheet with title, what the figure finds, warnings and caption on it; `panels_height` is what all panels and
    strips need, `hanging` how far a legend hangs below them."""
    room = width - 2 * MARGIN
    lines = [line for paragraph in paragraphs for line in wrap(paragraph, room, CAPTION_SIZE)]
    titles = wrap(title, room, TITLE_SIZE, "bold")
    if len(titles) > 2:
        titles = [titles[0], shorten(" ".join(titles[1:]), room, TITLE_SIZE, "bold")]
    found = wrap(clean_sentence(finding), room, FINDING_SIZE)
    bottom = 0.15 + LINE_HEIGHT * len(lines) + max(X_LABEL, hanging + 0.1)
    height = bottom + panels_height + 0.3 + 0.2 * (len(titles) + len(warnings)) + FINDING_HEIGHT * len(found)
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    sheet = Sheet(figure, width, height, bottom)
    for number, line in enumerate(titles):
        sheet.text(MARGIN, height - 0.12 - 0.2 * number, line, fontsize=TITLE_SIZE, fontweight="bold")
    below = height - 0.16 - 0.2 * len(titles)
    for number, line in enumerate(found):
        sheet.text(MARGIN, below - FINDING_HEIGHT * number, line, fontsize=FINDING_SIZE)
    below -= FINDING_HEIGHT * len(found)
    for number, warning in enumerate(warnings):
        sheet.text(MARGIN, below - 0.2 * number, warning, fontsize=WARNING_SIZE, fontweight="bold", color=ALARM)
    for number, line in enumerate(lines):
        sheet.text(MARGIN, 0.1 + LINE_HEIGHT * (len(lines) - number), line, fontsize=CAPTION_SIZE)
    return sheet


def grid(axes: Axes) -> None:
    axes.grid(which="major", color="#DDDDDD", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines["top"].set_visible(False)


def add_legend(axes: Axes, styles: Styles, anchor: tuple[float, float], columns: int = 1) -> None:
    handles = [line_of(style, [], []) for style in styles.values()]
    labels = ["\n".join(_label_lines(style.label, columns)) for style in styles.values()]
    axes.legend(handles, labels, loc="upper left", bbox_to_anchor=anchor,
                borderaxespad=0, frameon=False, fontsize=LEGEND_SIZE, handlelength=4.2, labelspacing=0.55,
                ncol=columns, columnspacing=1.2)


def label_ends(sheet: Sheet, axes: Axes, ends: dict[str, tuple[float, float]], styles: Styles) -> None:
    """Names of those who lead beside the right edge, each as near to the end of its curve as names above it leave room, joined
    to it by a thin line. Whoever has no curve here is named below the others."""
    leading = [name for name, style in styles.items() if style.leads]
    labels = {name: wrap(styles[name].label, LABEL_WIDTHS[1], LEGEND_SIZE)[:LABEL_LINES] for name in leading}
    box = axes.get_position()
    tall, wide = box.height * sheet.height, box.width * sheet.width
    to_axes = axes.transData + axes.transAxes.inverted()
    wanted = {name: float(to_axes.transform(ends[name])[1]) * tall if name in ends else -1e9 for name in leading}
    order = sorted(leading, key=lambda name: -wanted[name])
    heights = [LABEL_HEIGHT * len(labels[name]) + 0.05 for name in order]
    tops = _spread([min(wanted[name] + height / 2, tall + 0.1) for name, height in zip(order, heights)], heights, tall)
    for number, (name, height, top) in enumerate(zip(order, heights, tops)):
        style, middle = styles[name], (top - height / 2) / tall
        if name in ends:
            end = to_axes.transform(ends[name])
            sheet.figure.add_artist(Line2D([end[0], 1 + 0.1 / wide], [end[1], middle], color=style.color, linewidth=0.6, alpha=0.7,
                                           transform=axes.transAxes))
        sample = line_of(style, [1 + 0.12 / wide, 1 + 0.4 / wide, 1 + 0.68 / wide], [middle] * 3, zorder=5)
        sample.set(transform=axes.transAxes, markevery=[1])
        sheet.figure.add_artist(sample)
        sheet.figure.text(1 + 0.76 / wide, middle, "\n".join(labels[name]), transform=axes.transAxes, va="center",
                          fontsize=LEGEND_SIZE, linespacing=1.0, gid=f"label-{number}")


def labels_height(styles: Styles) -> float:
    return sum(LABEL_HEIGHT * len(wrap(style.label, LABEL_WIDTHS[1], LEGEND_SIZE)[:LABEL_LINES]) + 0.05
               for style in styles.values() if style.leads)


def _spread(tops: list[float], heights: list[float], tall: float) -> list[float]:
    """Tops of labels, from the upper one down, moved so that none covers another and the last ends at the bottom if it can."""
    for i in range(1, len(tops)):
        tops[i] = min(tops[i], tops[i - 1] - heights[i - 1])
    floor = min(0.0, tall - sum(heights))
    for i in reversed(range(len(tops))):
        least = floor + sum(heights[i:])
        tops[i] = max(tops[i], least)
    return tops


def clean_sentence(text: str) -> str:
    """The program's own words, which are longer than a name may be."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def legend_height(styles: Styles, columns: int = 1) -> float:
    heights = [0.13 * len(_label_lines(style.label, columns)) + 0.07 for style in styles.values()]
    rows = -(-len(heights) // columns)
    return max((sum(heights[start:start + rows]) for start in range(0, len(heights), rows or 1)), default=0)


def _label_lines(label: str, columns: int) -> list[str]:
    lines = wrap(label, LABEL_WIDTHS[columns], LEGEND_SIZE)
    if len(lines) <= LABEL_LINES:
        return lines
    return lines[:LABEL_LINES - 1] + [shorten(" ".join(lines[LABEL_LINES - 1:]), LABEL_WIDTHS[columns], LEGEND_SIZE)]


def save(figure: Figure, path: Path) -> None:
    """Written without dates or versions, so that the same result gives the same bytes."""
    try:
        figure.savefig(path, metadata={"Date": None})
    except OSError as error:
        raise ResultError(f"cannot write {path}: {error.strerror}") from error
