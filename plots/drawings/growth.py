"""Time of a step over vertices, log-log, exponents in the labels: what a step costs as cloth gets finer, whatever steps."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Callable

from matplotlib.figure import Figure

from parts.best_points import Best, Curve, FigureData, sweeps_in
from parts.caption import caption_of, warnings_of
from parts.curves import Styles, draw_curves, draw_noise, draw_slopes, ends_of
from parts.failures import add_strip, failed_rows, letters_in
from parts.legend import Legend
from parts.result_file import Json, finding_in, leaders_in, noise_factor, object_in
from parts.scales import log_x, log_y
from parts.sheet import (LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, grid, label_ends, labels_height, make_sheet)
from parts.style import receding_sentences, styles_for, with_leaders
from parts.words import scene_words


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(f"{data.name}-growth", partial(draw, data, document, legend)) for data in sweeps_in(document, legend, "resolution")]


def draw(data: FigureData, document: Json, legend: Legend) -> Figure:
    curves = {solver: Curve([_of_step(best) for best in curve.best if best.step], curve.failures)
              for solver, curve in data.curves.items()}
    steps = replace(data, curves=curves)
    styles = _with_slopes(with_leaders(styles_for(curves, legend), leaders_in(document, data.scene, data.sweep)), data, document)
    rows = failed_rows(steps, styles)
    captions = [*receding_sentences(styles.values()), *caption_of(steps, document, legend, letters_in(rows))]
    sheet = make_sheet(f"{scene_words(data.scene)}: growth of a step's time with vertices", warnings_of(document),
                       [words for words in captions if words], LEFT + MAIN_WIDTH + LEGEND_WIDTH,
                       MAIN_HEIGHT + ROW_HEIGHT * len(rows), labels_height(styles) - MAIN_HEIGHT,
                       " ".join(words for words in finding_in(document, data.scene, data.sweep) if words.startswith("From ")))
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
    label_ends(sheet, main, ends_of(steps), styles)
    return sheet.figure


def _of_step(best: Best) -> Best:
    return replace(best, seconds=best.seconds * best.step, low=best.low * best.step, high=best.high * best.step,
                   ladder_end=0)  # no panel shows it


def _with_slopes(styles: Styles, data: FigureData, document: Json) -> Styles:
    """Labels with the exponent that the program's analysis found; the terminal's table has its interval."""
    slopes = {row["row"]: row["exponent"] for growth in object_in(document, "analysis").get("growth", [])
              if growth["scene"] == data.scene and math.isclose(growth["strain_limit"], data.fixed) for row in growth["rows"]
              if row["sizes"] > 2}
    return {name: replace(style, label=f"{style.label}: {slopes[name]:.2f}") if name in slopes and style.leads else style
            for name, style in styles.items()}
