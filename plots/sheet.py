"""A sheet that panels are placed on by inches, with title, warnings and caption; and what all figures share."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import panels
from results import ResultError
from style import ALARM, SolverStyle

PNG_DPI = 150

# All lengths in inches. Placing by hand keeps the panels' size the same, however long caption and legend are.
LEFT, GAP, RIGHT = 1.45, 0.75, 0.2
MAIN_WIDTH, LEGEND_WIDTH = 4.5, 2.8
MAIN_HEIGHT, STEPS_HEIGHT, ROW_HEIGHT = 3.3, 1.7, 0.16
BETWEEN, X_LABEL, LINE_HEIGHT = 0.14, 0.5, 0.15
TIME_LABEL = "wall seconds per simulated second"


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


def make_sheet(title: str, warnings: list[str], paragraphs: list[str], width: float, panels_height: float) -> Sheet:
    """An empty sheet with title, warnings and caption on it; `panels_height` is what all panels and strips need."""
    lines = [line for paragraph in paragraphs for line in textwrap.wrap(paragraph, int(16.2 * (width - 0.4)))]
    bottom = 0.15 + LINE_HEIGHT * len(lines) + X_LABEL
    height = bottom + panels_height + 0.5 + 0.2 * len(warnings)
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    sheet = Sheet(figure, width, height, bottom)
    sheet.text(0.2, height - 0.12, title, fontsize=11, fontweight="bold")
    for number, warning in enumerate(warnings):
        sheet.text(0.2, height - 0.36 - 0.2 * number, warning, fontsize=9.5, fontweight="bold", color=ALARM)
    for number, line in enumerate(lines):
        sheet.text(0.2, 0.1 + LINE_HEIGHT * (len(lines) - number), line, fontsize=7.5)
    return sheet


def grid(axes: Axes) -> None:
    axes.grid(which="major", color="#DDDDDD", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines["top"].set_visible(False)


def add_strip(sheet: Sheet, main: Axes, rows: panels.Rows, styles: dict[str, SolverStyle], title: str,
              names: bool = True) -> None:
    if not rows:
        return
    box = main.get_position()
    strip = sheet.axes(box.x0 * sheet.width, box.y1 * sheet.height, box.width * sheet.width, ROW_HEIGHT * len(rows))
    panels.draw_strip(strip, main, rows, styles, names)
    strip.set_title(title, loc="right", fontsize=7, pad=2, color="#555555")


def add_legend(axes: Axes, styles: dict[str, SolverStyle], anchor: tuple[float, float], columns: int) -> None:
    handles = [panels.line_of(style, [], []) for style in styles.values()]
    labels = [textwrap.fill(style.label, 36 if columns == 1 else 27) for style in styles.values()]
    axes.legend(handles, labels, loc="upper left", bbox_to_anchor=anchor,
                borderaxespad=0, frameon=False, fontsize=8, handlelength=4.2, labelspacing=0.55,
                ncol=columns, columnspacing=1.2)


def save(figure: Figure, path: Path) -> None:
    """Written without dates or versions, so that the same result gives the same bytes."""
    metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
    try:
        figure.savefig(path, dpi=PNG_DPI, metadata=metadata)
    except OSError as error:
        raise ResultError(f"cannot write {path}: {error.strerror}") from error
