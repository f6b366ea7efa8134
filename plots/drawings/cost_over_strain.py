"""Cost over permissible strain (the paper's Figures 4a and 5a), log-log, with the best steps beneath; where a collider takes
part, with the filter's own time, and a second time over the strain after collisions."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib.figure import Figure

from parts.best_points import FigureData, delivered_in, sweeps_in
from parts.best_steps import draw_steps, steps_label
from parts.caption import caption_of, title_of, warnings_of
from parts.curves import draw_curves, draw_noise
from parts.failures import FAILED, NOT_REACHED, add_strip, failed_rows
from parts.filter_panel import draw_filter
from parts.legend import Legend
from parts.result_file import Json, noise_factor
from parts.scales import log_x, log_y
from parts.sheet import (BETWEEN, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, STEPS_HEIGHT, TIME_LABEL,
                         add_legend, grid, legend_height, make_sheet)
from parts.style import styles_for


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(data.name, partial(draw, data, document, legend))
            for data in sweeps_in(document, legend, "strain") + delivered_in(document, legend, "strain")]


def draw(data: FigureData, document: Json, legend: Legend) -> Figure:
    styles = styles_for(data.curves, legend)
    rows = failed_rows(data, styles, x_factor=100)
    beneath = STEPS_HEIGHT + BETWEEN
    main_bottom = beneath * (2 if data.has_filter else 1)
    panels_height = main_bottom + MAIN_HEIGHT
    sheet = make_sheet(title_of(data), warnings_of(document), caption_of(data, document, legend),
                       LEFT + MAIN_WIDTH + LEGEND_WIDTH, panels_height + ROW_HEIGHT * len(rows),
                       legend_height(styles) - panels_height)
    bottom = sheet.bottom
    steps = sheet.axes(LEFT, bottom, MAIN_WIDTH, STEPS_HEIGHT)
    main = sheet.axes(LEFT, bottom + main_bottom, MAIN_WIDTH, MAIN_HEIGHT, sharex=steps)

    log_x(main, [100 * x for x in data.xs()], MAIN_WIDTH)
    log_y(main, data)
    draw_curves(main, data, styles, x_factor=100)
    draw_noise(main, noise_factor(document))
    main.set_ylabel(TIME_LABEL)
    upper = [main]
    if data.has_filter:
        upper.append(sheet.axes(LEFT, bottom + beneath, MAIN_WIDTH, STEPS_HEIGHT, sharex=steps))
        draw_filter(upper[-1], data, styles, x_factor=100)
    for axes in upper:
        axes.tick_params(axis="x", which="both", labelbottom=False)
    draw_steps(steps, data, styles, x_factor=100)
    steps.set_ylabel(steps_label(data))
    steps.set_xlabel("largest strain after collisions (%)" if data.delivered else "permissible strain (%)")
    for axes in (*upper, steps):
        grid(axes)
    add_strip(sheet, main, rows, styles, NOT_REACHED if data.delivered else FAILED)
    add_legend(main, styles, anchor=(1.03, 1.0))
    return sheet.figure
