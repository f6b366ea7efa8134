"""Deviation from answers that theory knows, over the step: one panel an answer, orders of accuracy as slopes. The complete figure has every
solver."""

from collections import Counter

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.axes import draw_slopes, grid, log_log, steps_on_x
from parts.result import Figures, Json, Result
from parts.sheet import NARROW, RIGHT, X_LABEL, make_sheet
from parts.style import Styles, line_of, styles_for
from parts.words import clean, printable, short, shorten, wrap

COLUMNS = 4
WIDTH, HEIGHT = 1.9, 1.5  # of a panel, inches
ACROSS, DOWN = 0.55, 0.95  # between panels
TITLE_SIZE, NAMES = 7, 3  # names of solvers beside each other, beneath the panels


def figures_of(result: Result, every: bool = False) -> Figures:
    return [("deviations" + ("-all" if complete else ""), draw, result, complete) for complete in (False, True)[:1 + every] if _answers(result)]


def _answers(result: Result) -> list[Json]:
    """Those with a deviation to show."""
    found = {row["answer"] for row in result.document.get("rows", []) if row["deviation"]}
    return [answer for answer in result.document.get("answers", []) if answer["name"] in found]


def draw(result: Result, complete: bool = False) -> Figure:
    answers = _answers(result)
    closest = _closest(result.document["rows"])
    names = list(dict.fromkeys(row["solver"] for row in result.document["rows"]))
    styles = styles_for(names if complete else result.few(names, {name: -count for name, count in closest.items()}), result)
    rows, columns, lines = -(-len(answers) // COLUMNS), min(COLUMNS, len(answers)), -(-len(styles) // NAMES)
    caption = ("A run's deviation from the exact value (over it, unless it is 0); dotted: slopes 1 and 2, orders of accuracy. Where the answer is a "
               "continuum's, curves end at the chain's or net's distance from it. Without a mark: refused, or took too long.")
    best, count = [*closest.most_common(1), ("no method", 0)][0]
    title = f"Known answers: at the smallest step {result.title(best)} comes closest in {count} of {len(answers)}"
    sheet = make_sheet(result, title, [caption], NARROW + columns * WIDTH + (columns - 1) * ACROSS + RIGHT,
                       rows * HEIGHT + (rows - 1) * DOWN + 0.35, X_LABEL + 0.19 * lines)
    for number, answer in enumerate(answers):
        row, column = divmod(number, COLUMNS)
        axes = sheet.axes(NARROW + column * (WIDTH + ACROSS), sheet.bottom + (rows - 1 - row) * (HEIGHT + DOWN), WIDTH, HEIGHT)
        alone = sum((answer["scene"], answer["quantity"]) == (other["scene"], other["quantity"]) for other in answers) == 1
        shown = [row for row in result.document["rows"] if row["answer"] == answer["name"] and row["solver"] in styles]
        _draw_answer(axes, answer["scene" if alone else "name"], answer, shown, styles)
        axes.set(xlabel="time step (s)", ylabel="" if column else "|deviation|")
    sheet.figure.legend([line_of(style, [], []) for style in styles.values()],
                        [shorten(short(style.label), 2.7, TITLE_SIZE) for style in styles.values()], loc="upper center", ncol=NAMES,
                        bbox_to_anchor=(0.5, (sheet.bottom - X_LABEL) / sheet.height), frameon=False, fontsize=TITLE_SIZE, handlelength=3)
    return sheet.figure


def _closest(rows: list[Json]) -> Counter[str]:
    """In how many answers a solver's deviation at the smallest step is the least, or within 1 % of it."""
    found: Counter[str] = Counter()
    for answer in dict.fromkeys(row["answer"] for row in rows):
        own = [row for row in rows if row["answer"] == answer]
        last = {row["solver"]: abs(row["deviation"]) for row in own
                if row["step"] == min(row["step"] for row in own) and row["deviation"] is not None}
        found.update(name for name, deviation in last.items() if deviation <= 1.01 * min(last.values()))
    return found


def _draw_answer(axes: Axes, name: str, answer: Json, rows: list[Json], styles: Styles) -> None:
    found = sorted((row for row in rows if row["deviation"]), key=lambda row: row["step"])
    log_log(axes, [row["step"] for row in rows], [abs(row["deviation"]) for row in found] or [1.0])
    steps_on_x(axes, [row["step"] for row in rows])
    for order, (solver, style) in enumerate(styles.items()):
        own = [(row["step"], abs(row["deviation"])) for row in found if row["solver"] == solver]
        axes.add_line(line_of(style, [x for x, _ in own], [y for _, y in own], zorder=10 + len(styles) - order))
    draw_slopes(axes)
    title = wrap(f"{clean(name).replace('_', ' ')}: {printable(answer['quantity'])}", WIDTH + 0.15, TITLE_SIZE)
    axes.set_title("\n".join(title[:3]), fontsize=TITLE_SIZE, loc="left")
    grid(axes)
