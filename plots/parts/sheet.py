"""A sheet that panels are placed on by inches, with title, warnings, caption and legend; and how it is saved."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from parts.curves import Styles, line_of
from parts.result_file import ResultError
from parts.style import ALARM
from parts.words import shorten, wrap

PNG_DPI = 150

# All lengths in inches. Placing by hand keeps the panels' size the same, however long caption and legend are.
LEFT, GAP, RIGHT = 1.45, 0.75, 0.2
MAIN_WIDTH, LEGEND_WIDTH = 4.5, 3.0
MAIN_HEIGHT, STEPS_HEIGHT, ROW_HEIGHT = 3.3, 1.7, 0.16
BETWEEN, X_LABEL, LINE_HEIGHT = 0.14, 0.5, 0.15
MARGIN = 0.2
TIME_LABEL = "wall seconds per simulated second"

TITLE_SIZE, WARNING_SIZE, CAPTION_SIZE, LEGEND_SIZE = 11, 9.5, 7.5, 8
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
               hanging: float = 0) -> Sheet:
    """An empty sheet with title, warnings and caption on it; `panels_height` is what all panels and strips need, `hanging`
    how far a legend hangs below them."""
    room = width - 2 * MARGIN
    lines = [line for paragraph in paragraphs for line in wrap(paragraph, room, CAPTION_SIZE)]
    titles = wrap(title, room, TITLE_SIZE, "bold")
    if len(titles) > 2:
        titles = [titles[0], shorten(" ".join(titles[1:]), room, TITLE_SIZE, "bold")]
    bottom = 0.15 + LINE_HEIGHT * len(lines) + max(X_LABEL, hanging + 0.1)
    height = bottom + panels_height + 0.3 + 0.2 * (len(titles) + len(warnings))
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    sheet = Sheet(figure, width, height, bottom)
    for number, line in enumerate(titles):
        sheet.text(MARGIN, height - 0.12 - 0.2 * number, line, fontsize=TITLE_SIZE, fontweight="bold")
    for number, warning in enumerate(warnings, len(titles) - 1):
        sheet.text(MARGIN, height - 0.36 - 0.2 * number, warning, fontsize=WARNING_SIZE, fontweight="bold", color=ALARM)
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
    metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
    try:
        figure.savefig(path, dpi=PNG_DPI, metadata=metadata)
    except OSError as error:
        raise ResultError(f"cannot write {path}: {error.strerror}") from error
