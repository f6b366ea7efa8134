"""Cost over permissible strain (the paper's Figures 4a and 5a), log-log, with the best steps beneath."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib.figure import Figure

from parts.best_points import FigureData, sweeps_in
from parts.best_steps import draw_steps, steps_label
from parts.caption import caption_of, title_of, warnings_of
from parts.curves import draw_curves
from parts.failures import add_strip, failed_rows
from parts.legend import Legend
from parts.result_file import Json
from parts.scales import log_x, log_y
from parts.sheet import (BETWEEN, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, STEPS_HEIGHT, TIME_LABEL,
                         add_legend, grid, legend_height, make_sheet)
from parts.style import styles_for


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(data.name, partial(draw, data, document, legend)) for data in sweeps_in(document, legend, "strain")]


def draw(data: FigureData, document: Json, legend: Legend) -> Figure:
    styles = styles_for(data.curves, legend)
    rows = failed_rows(data, styles, x_factor=100)
    panels_height = STEPS_HEIGHT + BETWEEN + MAIN_HEIGHT
    sheet = make_sheet(title_of(data), warnings_of(document), caption_of(data, document, legend),
                       LEFT + MAIN_WIDTH + LEGEND_WIDTH, panels_height + ROW_HEIGHT * len(rows),
                       legend_height(styles) - panels_height)
    bottom = sheet.bottom
    steps = sheet.axes(LEFT, bottom, MAIN_WIDTH, STEPS_HEIGHT)
    main = sheet.axes(LEFT, bottom + STEPS_HEIGHT + BETWEEN, MAIN_WIDTH, MAIN_HEIGHT, sharex=steps)

    log_x(main, [100 * x for x in data.xs()], MAIN_WIDTH)
    log_y(main, data)
    draw_curves(main, data, styles, x_factor=100)
    main.set_ylabel(TIME_LABEL)
    main.tick_params(axis="x", which="both", labelbottom=False)
    draw_steps(steps, data, styles, x_factor=100)
    steps.set_ylabel(steps_label(data))
    steps.set_xlabel("permissible strain (%)")
    for axes in (main, steps):
        grid(axes)
    add_strip(sheet, main, rows, styles, "failed at every step")
    add_legend(main, styles, anchor=(1.03, 1.0))
    return sheet.figure
