"""The sheet of a figure of cost: time, log-log, with the best steps beneath; where a collider takes part, with the filter's own
time. Where errors are known a second column beside it has the runs whose motion is right; one legend serves both."""

from __future__ import annotations

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.best_points import FigureData
from parts.best_steps import draw_steps, steps_label
from parts.caption import caption_of, percent, title_of, warnings_of
from parts.curves import Styles, draw_curves, draw_noise, draw_slopes, ends_of
from parts.failures import FAILED, FAILED_OR_WRONG, Rows, add_strip, failed_rows, letters_in
from parts.filter_panel import draw_filter
from parts.legend import Legend
from parts.result_file import Json, finding_in, leaders_in, noise_factor
from parts.scales import log_x, log_y
from parts.sheet import (BETWEEN, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, STEPS_HEIGHT, TIME_LABEL, Sheet,
                         grid, label_ends, labels_height, make_sheet)
from parts.style import receding_sentences, styles_for, with_leaders

HEADING = 0.22  # inches, above two columns


@dataclass(frozen=True)
class Axis:
    """The axis of places: its words, what its values are multiplied by, and whether lines of slope 1 and 2 help to read it."""

    label: str
    factor: float = 1.0
    slopes: bool = False


@dataclass(frozen=True)
class Column:
    data: FigureData
    rows: Rows
    left: float
    heading: str


def draw(data: FigureData, document: Json, legend: Legend, axis: Axis) -> Figure:
    styles = with_leaders(styles_for(data.curves, legend), leaders_in(document, data.scene, data.sweep))
    columns = _columns(data, styles, axis)
    letters = {letter for column in columns for letter in letters_in(column.rows)}
    strip = ROW_HEIGHT * max(len(column.rows) for column in columns)
    panels_height = _main_bottom(data) + MAIN_HEIGHT
    right = columns[-1].left + MAIN_WIDTH
    finding = finding_in(document, data.scene, data.sweep, data.fixed if data.sweep == "strain" else None)
    captions = [*receding_sentences(styles.values()), *caption_of(data, document, legend, letters)]
    sheet = make_sheet(title_of(data), warnings_of(document), [words for words in captions if words], right + LEGEND_WIDTH,
                       panels_height + strip + (HEADING if len(columns) > 1 else 0), labels_height(styles) - panels_height,
                       " ".join(finding[:1]))
    mains = [_draw_column(sheet, column, document, styles, axis) for column in columns]
    low, high = min(main.get_ylim()[0] for main in mains), max(main.get_ylim()[1] for main in mains)
    for column, main in zip(columns, mains):
        main.set_ylim(low, high)  # the same scale, so that both columns compare
        draw_noise(main, noise_factor(document))
        if axis.slopes:
            draw_slopes(main)
        add_strip(sheet, main, column.rows, styles, FAILED if column.data.level is None else FAILED_OR_WRONG)
        box = main.get_position()
        if len(columns) > 1:
            sheet.figure.text(box.x0, box.y1 + (strip + 0.17) / sheet.height, column.heading, fontsize=9, fontweight="bold",
                              va="bottom")
    mains[0].set_ylabel(TIME_LABEL)
    label_ends(sheet, mains[-1], ends_of(columns[-1].data, axis.factor), styles)
    return sheet.figure


def _columns(data: FigureData, styles: Styles, axis: Axis) -> list[Column]:
    columns = [Column(data, failed_rows(data, styles, axis.factor), LEFT, "any motion: the paper's question")]
    if data.within:
        columns.append(Column(data.within, failed_rows(data.within, styles, axis.factor), 2 * LEFT + MAIN_WIDTH,
                              f"error at most {percent(data.within.level or 0)} of the scene's size"))
    return columns


def _main_bottom(data: FigureData) -> float:
    return (STEPS_HEIGHT + BETWEEN) * (2 if data.has_filter else 1)


def _draw_column(sheet: Sheet, column: Column, document: Json, styles: Styles, axis: Axis) -> Axes:
    """Returns the main panel."""
    data, bottom = column.data, sheet.bottom
    steps = sheet.axes(column.left, bottom, MAIN_WIDTH, STEPS_HEIGHT)
    main = sheet.axes(column.left, bottom + _main_bottom(data), MAIN_WIDTH, MAIN_HEIGHT, sharex=steps)
    log_x(main, [axis.factor * x for x in data.xs()], MAIN_WIDTH)
    log_y(main, data)
    draw_curves(main, data, styles, axis.factor)
    upper = [main]
    if data.has_filter:
        upper.append(sheet.axes(column.left, bottom + STEPS_HEIGHT + BETWEEN, MAIN_WIDTH, STEPS_HEIGHT, sharex=steps))
        draw_filter(upper[-1], data, styles, axis.factor)
    for axes in upper:
        axes.tick_params(axis="x", which="both", labelbottom=False)
    draw_steps(steps, data, styles, axis.factor)
    steps.set_ylabel(steps_label(data))
    steps.set_xlabel(axis.label)
    for axes in (*upper, steps):
        grid(axes)
    return main
