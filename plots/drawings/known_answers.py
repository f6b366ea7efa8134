"""Deviation from answers that theory knows, over the step: one panel an answer, orders of accuracy as slopes."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.axes import draw_slopes, grid, log_log, steps_on_x
from parts.result import Figures, Json, Result
from parts.sheet import LEFT, LEGEND_WIDTH, X_LABEL, add_legend, legend_height, make_sheet
from parts.style import Styles, line_of, styles_for
from parts.words import clean, wrap

COLUMNS = 3
WIDTH, HEIGHT = 2.5, 2.0  # of a panel, inches
ACROSS, DOWN = 0.75, 0.95  # between panels
TITLE_SIZE = 7.5


def figures_of(result: Result) -> Figures:
    return [("deviations", draw, result)] if _answers(result) else []


def _answers(result: Result) -> list[Json]:
    """Those with a deviation to show."""
    found = {row["answer"] for row in result.document.get("rows", []) if row["deviation"]}
    return [answer for answer in result.document.get("answers", []) if answer["name"] in found]


def draw(result: Result) -> Figure:
    answers = _answers(result)
    styles = styles_for([row["solver"] for row in result.document["rows"]], result)
    rows, columns = -(-len(answers) // COLUMNS), min(COLUMNS, len(answers))
    panels = rows * HEIGHT + (rows - 1) * DOWN + 0.45
    caption = ("Deviation of what was read off a run from the exact value (over it, unless it is 0), at ever smaller steps. An order of "
               "accuracy is a slope (dotted: 1 and 2). Where the answer is a continuum's, curves end at the distance of the "
               "chain or net from it. A solver without a mark at a step refused it or took too long.")
    sheet = make_sheet(result, "Known answers: how far off each solver is", [caption],
                       LEFT + columns * WIDTH + (columns - 1) * ACROSS + LEGEND_WIDTH, panels,
                       max(X_LABEL, legend_height(styles) - panels))
    for number, answer in enumerate(answers):
        row, column = divmod(number, COLUMNS)
        axes = sheet.axes(LEFT + column * (WIDTH + ACROSS), sheet.bottom + (rows - 1 - row) * (HEIGHT + DOWN), WIDTH, HEIGHT)
        _draw_answer(axes, answer, [row for row in result.document["rows"] if row["answer"] == answer["name"]], styles)
        axes.set(xlabel="time step (s)", ylabel="" if column else "|deviation|")
        if number == columns - 1:
            add_legend(axes, styles)
    return sheet.figure


def _draw_answer(axes: Axes, answer: Json, rows: list[Json], styles: Styles) -> None:
    found = sorted((row for row in rows if row["deviation"]), key=lambda row: row["step"])
    log_log(axes, [row["step"] for row in rows], [abs(row["deviation"]) for row in found])
    steps_on_x(axes, [row["step"] for row in rows])
    for order, (solver, style) in enumerate(styles.items()):
        own = [(row["step"], abs(row["deviation"])) for row in found if row["solver"] == solver]
        axes.add_line(line_of(style, [x for x, _ in own], [y for _, y in own], zorder=10 + len(styles) - order))
    draw_slopes(axes, from_right=True)
    title = wrap(f"{clean(answer['scene'])}: {clean(answer['quantity'])}", WIDTH + 0.4, TITLE_SIZE)
    axes.set_title("\n".join(title[:3]), fontsize=TITLE_SIZE, loc="left")
    grid(axes)
