"""Time of a step over vertices, log-log, slopes in the legend: what a step costs as cloth gets finer, whatever steps."""

from __future__ import annotations

import math
import statistics
from dataclasses import replace
from functools import partial
from typing import Callable

from matplotlib.figure import Figure

from parts.best_points import Best, Curve, FigureData, sweeps_in
from parts.caption import caption_of, warnings_of
from parts.curves import Styles, draw_curves, draw_noise, draw_slopes
from parts.failures import add_strip, failed_rows
from parts.legend import Legend
from parts.result_file import Json, noise_factor
from parts.scales import log_x, log_y
from parts.sheet import LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, add_legend, grid, legend_height, make_sheet
from parts.style import styles_for
from parts.words import clean


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(f"{data.name}-growth", partial(draw, data, document, legend)) for data in sweeps_in(document, legend, "resolution")]


def draw(data: FigureData, document: Json, legend: Legend) -> Figure:
    curves = {solver: Curve([_of_step(best) for best in curve.best if best.step], curve.failures)
              for solver, curve in data.curves.items()}
    steps = replace(data, curves=curves)
    styles = styles_for(curves, legend)
    rows = failed_rows(steps, styles)
    sheet = make_sheet(f"{clean(data.scene)}: growth of a step's time with vertices", warnings_of(document),
                       caption_of(steps, document, legend), LEFT + MAIN_WIDTH + LEGEND_WIDTH,
                       MAIN_HEIGHT + ROW_HEIGHT * len(rows), legend_height(styles) - MAIN_HEIGHT)
    main = sheet.axes(LEFT, sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT)
    log_x(main, steps.xs(), MAIN_WIDTH)
    log_y(main, steps)
    draw_slopes(main)
    draw_curves(main, steps, styles)
    draw_noise(main, noise_factor(document))
    main.set_ylabel("wall seconds of a step")
    main.set_xlabel("vertices (log axes; dotted: slopes 1 and 2)")
    grid(main)
    add_strip(sheet, main, rows, styles, "failed at every step")
    add_legend(main, _with_slopes(styles, steps), anchor=(1.03, 1.0))
    return sheet.figure


def _of_step(best: Best) -> Best:
    return replace(best, seconds=best.seconds * best.step, low=best.low * best.step, high=best.high * best.step,
                   ladder_end=0)  # no panel shows it


def _with_slopes(styles: Styles, data: FigureData) -> Styles:
    """Labels with the least-squares slope of log time over log vertices; the terminal's table has its interval."""
    labelled = dict(styles)
    for name, style in styles.items():
        points = [(math.log(best.x), math.log(best.seconds)) for best in data.curves[name].best]
        if len(points) > 2:
            slope = statistics.linear_regression(*zip(*points)).slope
            labelled[name] = replace(style, label=f"{style.label}: {slope:.2f}")
    return labelled
