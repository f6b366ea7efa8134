"""Cost over permissible strain (the paper's Figures 4a and 5a) and over resolution (4b and 5b)."""

from __future__ import annotations

import math
import statistics
from dataclasses import replace

from matplotlib.figure import Figure

import caption
import panels
from results import Best, Curve, FigureData, Json, adaptive
from sheet import (BETWEEN, GAP, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, RIGHT, ROW_HEIGHT, STEPS_HEIGHT, TIME_LABEL,
                   Sheet, add_legend, add_strip, grid, make_sheet)
from style import SolverStyle, styles_for

STEP_LABEL = "best time step (s)"
ADAPTIVE_LABEL = "mean time step (s)"


def draw(data: FigureData, document: Json) -> Figure:
    styles = styles_for(data.curves)
    return _draw_strain(data, document, styles) if data.sweep == "strain" else _draw_resolution(data, document, styles)


def _draw_strain(data: FigureData, document: Json, styles: dict[str, SolverStyle]) -> Figure:
    """Cost over strain, log-log; best steps beneath; legend to the right."""
    rows = panels.failed_rows(data, styles, x_factor=100)
    sheet = _sheet(data, document, LEFT + MAIN_WIDTH + LEGEND_WIDTH, len(rows))
    bottom = sheet.bottom
    steps = sheet.axes(LEFT, bottom, MAIN_WIDTH, STEPS_HEIGHT)
    main = sheet.axes(LEFT, bottom + STEPS_HEIGHT + BETWEEN, MAIN_WIDTH, MAIN_HEIGHT, sharex=steps)

    panels.log_x(main, [100 * x for x in _xs(data)], MAIN_WIDTH)
    panels.log_y(main, data)
    panels.draw_curves(main, data, styles, x_factor=100)
    main.set_ylabel(TIME_LABEL)
    main.tick_params(axis="x", which="both", labelbottom=False)
    panels.draw_steps(steps, data, styles, x_factor=100)
    steps.set_ylabel(ADAPTIVE_LABEL if adaptive(data.points) else STEP_LABEL)
    steps.set_xlabel("permissible strain (%)")
    for axes in (main, steps):
        grid(axes)
    add_strip(sheet, main, rows, styles, "failed at every step")
    add_legend(main, styles, anchor=(1.03, 1.0), columns=1)
    return sheet.figure


def _draw_resolution(data: FigureData, document: Json, styles: dict[str, SolverStyle]) -> Figure:
    """Cost over vertices, linear as in the paper on the left, log-log on the right with the best steps beneath it.

    The legend takes the place beneath the linear panel, where small sizes would lie too close to show their steps."""
    top = panels.linear_top(data, styles)
    rows_linear, rows_log = panels.clipped_rows(data, styles, top), panels.failed_rows(data, styles)
    second = LEFT + MAIN_WIDTH + GAP
    sheet = _sheet(data, document, second + MAIN_WIDTH + RIGHT, max(len(rows_linear), len(rows_log)))
    bottom = sheet.bottom
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
    steps.set_ylabel(ADAPTIVE_LABEL if adaptive(data.points) else STEP_LABEL)
    for axes in (left, right, steps):
        grid(axes)
    off_scale = any(mark.text.startswith(panels.ARROW) for marks in rows_linear.values() for mark in marks)
    add_strip(sheet, left, rows_linear, styles, f"failed at every step, or above the axes ({panels.ARROW})" if off_scale
               else "failed at every step")
    add_strip(sheet, right, rows_log, styles, "failed at every step", names=False)
    add_legend(left, styles, anchor=(0.0, -0.2), columns=1 if len(styles) <= 8 else 2)
    return sheet.figure


def draw_growth(data: FigureData, document: Json) -> Figure:
    """Time of a step over vertices, log-log, slopes in the legend: what a step costs as cloth gets finer, whatever steps."""
    curves = {solver: Curve([_of_step(best) for best in curve.best if best.step], curve.failures)
              for solver, curve in data.curves.items()}
    steps = replace(data, curves=curves)
    styles = styles_for(curves)
    rows = panels.failed_rows(steps, styles)
    sheet = make_sheet(f"{data.scene}: growth of a step's time with vertices", caption.warnings_of(document),
                       caption.caption_of(data, document), LEFT + MAIN_WIDTH + LEGEND_WIDTH,
                       MAIN_HEIGHT + ROW_HEIGHT * len(rows))
    main = sheet.axes(LEFT, sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT)
    panels.log_x(main, _xs(steps), MAIN_WIDTH)
    panels.log_y(main, steps)
    panels.draw_slopes(main)
    panels.draw_curves(main, steps, styles)
    main.set_ylabel("wall seconds of a step")
    main.set_xlabel("vertices (log axes; dotted: slopes 1 and 2)")
    grid(main)
    add_strip(sheet, main, rows, styles, "failed at every step")
    add_legend(main, _with_slopes(styles, steps), anchor=(1.03, 1.0), columns=1)
    return sheet.figure


def _of_step(best: Best) -> Best:
    return replace(best, seconds=best.seconds * best.step, q1=best.q1 * best.step, q3=best.q3 * best.step)


def _with_slopes(styles: dict[str, SolverStyle], data: FigureData) -> dict[str, SolverStyle]:
    """Labels with the least-squares slope of log time over log vertices; the terminal's table has its interval."""
    labelled = dict(styles)
    for name, style in styles.items():
        points = [(math.log(best.x), math.log(best.seconds)) for best in data.curves[name].best]
        if len(points) > 2:
            slope = statistics.linear_regression(*zip(*points)).slope
            labelled[name] = replace(style, label=f"{style.label}: {slope:.2f}")
    return labelled


def _xs(data: FigureData) -> list[float]:
    return sorted({entry.x for curve in data.curves.values() for entry in (*curve.best, *curve.failures)})


def _sheet(data: FigureData, document: Json, width: float, strip_rows: int) -> Sheet:
    return make_sheet(caption.title_of(data), caption.warnings_of(document), caption.caption_of(data, document), width,
                      STEPS_HEIGHT + BETWEEN + MAIN_HEIGHT + ROW_HEIGHT * strip_rows)
