"""Cost over resolution (the paper's Figures 4b and 5b): linear as in the paper on the left, log-log on the right, with the
best steps beneath."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib.figure import Figure

from parts.best_points import FigureData, delivered_in, sweeps_in
from parts.best_steps import draw_steps, steps_label
from parts.caption import caption_of, title_of, warnings_of
from parts.curves import draw_curves, draw_noise, draw_slopes
from parts.failures import ARROW, FAILED, NOT_REACHED, add_strip, clipped_rows, failed_rows, linear_top
from parts.filter_panel import draw_filter
from parts.legend import Legend
from parts.result_file import Json, noise_factor
from parts.scales import linear_scales, log_x, log_y
from parts.sheet import (BETWEEN, GAP, LEFT, MAIN_HEIGHT, MAIN_WIDTH, RIGHT, ROW_HEIGHT, STEPS_HEIGHT, TIME_LABEL,
                         add_legend, grid, legend_height, make_sheet)
from parts.style import styles_for

LEGEND_DROP = 0.2  # of the main panel's height, below its axis


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(data.name, partial(draw, data, document, legend))
            for data in sweeps_in(document, legend, "resolution") + delivered_in(document, legend, "resolution")]


def draw(data: FigureData, document: Json, legend: Legend) -> Figure:
    """The legend takes the place beneath the linear panel, where small sizes would lie too close to show their steps."""
    styles = styles_for(data.curves, legend)
    columns = 1 if len(styles) <= 8 else 2
    top = linear_top(data, styles)
    rows_linear, rows_log = clipped_rows(data, styles, top), failed_rows(data, styles)
    second = LEFT + MAIN_WIDTH + GAP
    beneath = STEPS_HEIGHT + BETWEEN
    main_bottom = beneath * (2 if data.has_filter else 1)
    panels_height = main_bottom + MAIN_HEIGHT + ROW_HEIGHT * max(len(rows_linear), len(rows_log))
    sheet = make_sheet(title_of(data), warnings_of(document), caption_of(data, document, legend),
                       second + MAIN_WIDTH + RIGHT, panels_height,
                       legend_height(styles, columns) - (main_bottom - LEGEND_DROP * MAIN_HEIGHT))
    bottom = sheet.bottom
    above = bottom + main_bottom
    steps = sheet.axes(second, bottom, MAIN_WIDTH, STEPS_HEIGHT)
    right = sheet.axes(second, above, MAIN_WIDTH, MAIN_HEIGHT, sharex=steps)
    left = sheet.axes(LEFT, above, MAIN_WIDTH, MAIN_HEIGHT)

    linear_scales(left, data, data.xs(), top)
    draw_curves(left, data, styles)
    left.set_ylabel(TIME_LABEL)
    left.set_xlabel("vertices (linear axes)")
    log_x(right, data.xs(), MAIN_WIDTH)
    log_y(right, data)
    draw_slopes(right)
    draw_curves(right, data, styles)
    draw_noise(right, noise_factor(document))
    upper = [right]
    if data.has_filter:
        upper.append(sheet.axes(second, bottom + beneath, MAIN_WIDTH, STEPS_HEIGHT, sharex=steps))
        draw_filter(upper[-1], data, styles)
    for axes in upper:
        axes.tick_params(axis="x", which="both", labelbottom=False)
    draw_steps(steps, data, styles)
    steps.set_xlabel("vertices (log axes; dotted: slopes 1 and 2)")
    steps.set_ylabel(steps_label(data))
    for axes in (left, *upper, steps):
        grid(axes)
    failed = NOT_REACHED if data.delivered else FAILED
    off_scale = any(mark.text.startswith(ARROW) for marks in rows_linear.values() for mark in marks)
    add_strip(sheet, left, rows_linear, styles, f"{failed}, or above the axes ({ARROW})" if off_scale else failed)
    add_strip(sheet, right, rows_log, styles, failed, names=False)
    add_legend(left, styles, anchor=(0.0, -LEGEND_DROP), columns=columns)
    return sheet.figure
