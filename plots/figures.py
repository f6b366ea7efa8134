#!/usr/bin/python3
"""Draws the figures of a result file: cost over permissible strain and over resolution, each solver at its best step.

    plots/figures.py results/figure4.json [--out DIR] [--format svg,png]

writes <stem>-figure4a.svg and so on, and prints each path it wrote. Needs Debian's python3-matplotlib and nothing else.
Looks are set in style.py; results.py decides what is a curve and what a failure; panels.py draws; caption.py has the words.
"""

from __future__ import annotations

import argparse
import sys
import textwrap
from dataclasses import dataclass
from pathlib import Path

sys.dont_write_bytecode = True  # a look at a result must not leave files in the source tree

try:
    import matplotlib
    from matplotlib.axes import Axes
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
except ImportError:
    print("figures.py: matplotlib is missing (Debian: apt-get install python3-matplotlib)", file=sys.stderr)
    sys.exit(2)

import caption
import panels
from results import FigureData, Json, ResultError, figures_in, load
from style import ALARM, RC, SolverStyle, styles_for

FORMATS = ("svg", "png")
PNG_DPI = 150

# All lengths in inches. Placing by hand keeps the panels' size the same, however long caption and legend are.
LEFT, GAP, RIGHT = 1.2, 0.75, 0.2
MAIN_WIDTH, LEGEND_WIDTH = 4.5, 2.8
MAIN_HEIGHT, STEPS_HEIGHT, ROW_HEIGHT = 3.3, 1.7, 0.16
BETWEEN, X_LABEL, LINE_HEIGHT = 0.14, 0.5, 0.15
TIME_LABEL = "wall seconds per simulated second"
STEP_LABEL = "best time step (s)"


@dataclass
class Sheet:
    """A matplotlib figure that is addressed in inches from its lower left corner."""

    figure: Figure
    width: float
    height: float

    def axes(self, left: float, bottom: float, width: float, height: float, sharex: Axes | None = None) -> Axes:
        box = (left / self.width, bottom / self.height, width / self.width, height / self.height)
        return self.figure.add_axes(box, sharex=sharex)

    def text(self, left: float, bottom: float, words: str, **look: object) -> None:
        self.figure.text(left / self.width, bottom / self.height, words, va="top", **look)


def draw(data: FigureData, document: Json) -> Figure:
    styles = styles_for(data.curves)
    return _draw_strain(data, document, styles) if data.sweep == "strain" else _draw_resolution(data, document, styles)


def _draw_strain(data: FigureData, document: Json, styles: dict[str, SolverStyle]) -> Figure:
    """Cost over strain, log-log; best steps beneath; legend to the right."""
    rows = panels.failed_rows(data, styles, x_factor=100)
    sheet, bottom = _sheet(data, document, LEFT + MAIN_WIDTH + LEGEND_WIDTH, len(rows))
    steps = sheet.axes(LEFT, bottom, MAIN_WIDTH, STEPS_HEIGHT)
    main = sheet.axes(LEFT, bottom + STEPS_HEIGHT + BETWEEN, MAIN_WIDTH, MAIN_HEIGHT, sharex=steps)

    panels.log_x(main, [100 * x for x in _xs(data)], MAIN_WIDTH)
    panels.log_y(main, data)
    panels.draw_curves(main, data, styles, x_factor=100)
    main.set_ylabel(TIME_LABEL)
    main.tick_params(axis="x", which="both", labelbottom=False)
    panels.draw_steps(steps, data, styles, x_factor=100)
    steps.set_ylabel(STEP_LABEL)
    steps.set_xlabel("permissible strain (%)")
    for axes in (main, steps):
        _grid(axes)
    _add_strip(sheet, main, rows, styles, "failed at every step")
    _legend(main, styles, anchor=(1.03, 1.0), columns=1)
    return sheet.figure


def _draw_resolution(data: FigureData, document: Json, styles: dict[str, SolverStyle]) -> Figure:
    """Cost over vertices, linear as in the paper on the left, log-log on the right with the best steps beneath it.

    The legend takes the place beneath the linear panel, where small sizes would lie too close to show their steps."""
    top = panels.linear_top(data, styles)
    rows_linear, rows_log = panels.clipped_rows(data, styles, top), panels.failed_rows(data, styles)
    second = LEFT + MAIN_WIDTH + GAP
    sheet, bottom = _sheet(data, document, second + MAIN_WIDTH + RIGHT, max(len(rows_linear), len(rows_log)))
    above = bottom + STEPS_HEIGHT + BETWEEN
    steps = sheet.axes(second, bottom, MAIN_WIDTH, STEPS_HEIGHT)
    right = sheet.axes(second, above, MAIN_WIDTH, MAIN_HEIGHT, sharex=steps)
    left = sheet.axes(LEFT, above, MAIN_WIDTH, MAIN_HEIGHT)

    panels.linear_scales(left, data, _xs(data), top)
    panels.draw_curves(left, data, styles)
    left.set_ylabel(TIME_LABEL)
    left.set_xlabel("vertices (linear axes)")
    panels.log_x(right, _xs(data), MAIN_WIDTH)
    panels.log_y(right, data)
    panels.draw_slopes(right)
    panels.draw_curves(right, data, styles)
    right.tick_params(axis="x", which="both", labelbottom=False)
    panels.draw_steps(steps, data, styles)
    steps.set_xlabel("vertices (log axes; dotted: slopes 1 and 2)")
    steps.set_ylabel(STEP_LABEL)
    for axes in (left, right, steps):
        _grid(axes)
    off_scale = any(mark.text.startswith(panels.ARROW) for marks in rows_linear.values() for mark in marks)
    _add_strip(sheet, left, rows_linear, styles, f"failed at every step, or above the axes ({panels.ARROW})" if off_scale
               else "failed at every step")
    _add_strip(sheet, right, rows_log, styles, "failed at every step", names=False)
    _legend(left, styles, anchor=(0.0, -0.2), columns=1 if len(styles) <= 8 else 2)
    return sheet.figure


def _xs(data: FigureData) -> list[float]:
    return sorted({entry.x for curve in data.curves.values() for entry in (*curve.best, *curve.failures)})


def _sheet(data: FigureData, document: Json, width: float, strip_rows: int) -> tuple[Sheet, float]:
    """An empty sheet with title, warnings and caption on it, and the height at which the lowest panel starts."""
    lines = [line for paragraph in caption.caption_of(data, document)
             for line in textwrap.wrap(paragraph, int(16.2 * (width - 0.4)))]
    warnings = caption.warnings_of(document)
    bottom = 0.15 + LINE_HEIGHT * len(lines) + X_LABEL
    panels_top = bottom + STEPS_HEIGHT + BETWEEN + MAIN_HEIGHT + ROW_HEIGHT * strip_rows
    height = panels_top + 0.5 + 0.2 * len(warnings)
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    sheet = Sheet(figure, width, height)
    sheet.text(0.2, height - 0.12, caption.title_of(data), fontsize=11, fontweight="bold")
    for number, warning in enumerate(warnings):
        sheet.text(0.2, height - 0.36 - 0.2 * number, warning, fontsize=9.5, fontweight="bold", color=ALARM)
    for number, line in enumerate(lines):
        sheet.text(0.2, 0.1 + LINE_HEIGHT * (len(lines) - number), line, fontsize=7.5)
    return sheet, bottom


def _grid(axes: Axes) -> None:
    axes.grid(which="major", color="#DDDDDD", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines["top"].set_visible(False)


def _add_strip(sheet: Sheet, main: Axes, rows: panels.Rows, styles: dict[str, SolverStyle], title: str,
               names: bool = True) -> None:
    if not rows:
        return
    box = main.get_position()
    strip = sheet.axes(box.x0 * sheet.width, box.y1 * sheet.height, box.width * sheet.width, ROW_HEIGHT * len(rows))
    panels.draw_strip(strip, main, rows, styles, names)
    strip.set_title(title, loc="right", fontsize=7, pad=2, color="#555555")


def _legend(axes: Axes, styles: dict[str, SolverStyle], anchor: tuple[float, float], columns: int) -> None:
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


def formats(text: str) -> list[str]:
    wanted = [part.strip().lower() for part in text.split(",") if part.strip()]
    unknown = [part for part in wanted if part not in FORMATS]
    if unknown or not wanted:
        raise argparse.ArgumentTypeError(f"'{text}': give one or more of {', '.join(FORMATS)}")
    return wanted


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="figures.py", description="Draws the figures of a result file.")
    parser.add_argument("result", type=Path, help="result file of the bench program (JSON)")
    parser.add_argument("--out", type=Path, help="folder for the figures (default: the result file's folder)")
    parser.add_argument("--format", type=formats, default=list(FORMATS), metavar="svg,png",
                        help="file formats (default: both)")
    return parser.parse_args(arguments)


def run(arguments: list[str]) -> None:
    options = parse(arguments)
    document = load(options.result)
    figures = figures_in(document)
    if not figures:
        raise ResultError(f"{options.result}: no points to draw (none belongs to a strain or resolution sweep)")
    folder = options.out or options.result.parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ResultError(f"cannot make folder {folder}: {error.strerror}") from error
    with matplotlib.rc_context(RC):
        for data in figures:
            figure = draw(data, document)
            for suffix in options.format:
                path = folder / f"{options.result.stem}-{data.name}.{suffix}"
                save(figure, path)
                print(path, flush=True)


def main() -> int:
    try:
        run(sys.argv[1:])
    except ResultError as error:
        print(f"figures.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
