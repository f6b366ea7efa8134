"""Deviation from answers that theory knows, over the step: one panel an answer, orders of accuracy as slopes."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib.figure import Figure

from parts.caption import origin_sentence, warnings_of
from parts.colors import GREY
from parts.curves import Styles, line_of
from parts.legend import Legend
from parts.result_file import ANSWERS_SCHEMA, Json, positive
from parts.scales import log_log, step_axis
from parts.sheet import LEFT, LEGEND_WIDTH, X_LABEL, add_legend, grid, legend_height, make_sheet
from parts.style import styles_for
from parts.words import clean, wrap

COLUMNS = 3
WIDTH, HEIGHT = 2.5, 2.0  # of a panel, inches
ACROSS, DOWN = 0.75, 0.95  # between panels
TITLE_SIZE = 7.5


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    if document["schema"] != ANSWERS_SCHEMA or not document["answers"]:
        return []
    return [("deviations", partial(draw, document, legend))]


def draw(document: Json, legend: Legend) -> Figure:
    answers = document["answers"]
    styles = styles_for((row["solver"] for row in document["rows"]), legend)
    rows = -(-len(answers) // COLUMNS)
    columns = min(COLUMNS, len(answers))
    panels = rows * HEIGHT + (rows - 1) * DOWN + 0.45
    words = ["Deviation of what was read off a run from the exact value (over it, unless it is 0), at ever smaller steps. An order of "
             "accuracy is a slope (dotted: 1 and 2). Where the answer is a continuum's, curves end at the distance of the "
             "chain or net from it. A solver without a mark at a step refused it or took too long.", origin_sentence(document)]
    sheet = make_sheet("Known answers: how far off each solver is", warnings_of(document), words,
                       LEFT + columns * WIDTH + (columns - 1) * ACROSS + LEGEND_WIDTH, panels,
                       max(X_LABEL, legend_height(styles) - panels))
    for number, answer in enumerate(answers):
        row, column = divmod(number, COLUMNS)
        axes = sheet.axes(LEFT + column * (WIDTH + ACROSS), sheet.bottom + (rows - 1 - row) * (HEIGHT + DOWN), WIDTH, HEIGHT)
        _draw_answer(axes, answer, document["rows"], styles)
        if column == 0:
            axes.set_ylabel("|deviation|")
        axes.set_xlabel("time step (s)")
        if number == columns - 1:
            add_legend(axes, styles, anchor=(1.12, 1.0))
    return sheet.figure


def _draw_answer(axes, answer: Json, rows: list[Json], styles: Styles) -> None:
    mine = [row for row in rows if row["answer"] == answer["name"]]
    found = [row for row in mine if positive(abs(row["deviation"] or 0))]
    log_log(axes, [row["step"] for row in mine], [abs(row["deviation"]) for row in found])
    step_axis(axes, [row["step"] for row in mine])
    for order, (solver, style) in enumerate(styles.items()):
        path = sorted((row for row in found if row["solver"] == solver), key=lambda row: row["step"])
        axes.add_line(line_of(style, [row["step"] for row in path], [abs(row["deviation"]) for row in path],
                              zorder=10 + len(styles) - order))
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    for power in (1, 2):
        end = max(left, right * (low / high) ** (1 / power))
        axes.plot([end, right], [high * (end / right) ** power, high], color=GREY, linewidth=0.6, linestyle=(0, (1, 3)), zorder=1)
    title = wrap(f"{clean(answer['scene'])}: {clean(answer['quantity'])}", WIDTH + 0.4, TITLE_SIZE)
    axes.set_title("\n".join(title[:3]), fontsize=TITLE_SIZE, loc="left")
    grid(axes)
