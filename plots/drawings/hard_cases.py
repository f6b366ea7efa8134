"""Draws a stability result: the matrix of solvers and hard cases."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from parts.result import Figures, Json, Result
from parts.sheet import MARGIN, make_sheet
from parts.style import ALARM, styles_for
from parts.words import clean, inches, short, shorten

# From the mildest outcome to the gravest: letter, meaning, and a colour that differs in lightness too, for gray prints.
OUTCOMES = {
    "survived": ("S", "survived", "#FFFFFF"), "survived_smaller": ("s", "survived with smaller steps", "#DCEBF7"),
    "refused": ("R", "refused cleanly", "#B8D0E6"), "timeout": ("T", "took too long", "#F2D38B"), "diverged": ("D", "diverged", "#C2553B"),
    "wrong": ("W", "wrong: claimed success, and a check says otherwise", ALARM), "crashed": ("C", "took its process with it", "#5C1A00")}
GRAVE = ("diverged", "wrong", "crashed")
CELL_WIDTH, CELL_HEIGHT, LABEL_WIDTH, TEXT_SIZE = 0.27, 0.19, 3.3, 8  # LABEL_WIDTH: of solvers' names


def figures_of(result: Result, every: bool = False) -> Figures:
    return [("matrix", draw, result)] if result.document.get("matrix") else []


def draw(result: Result) -> Figure:
    cells = result.document["matrix"]
    styles = styles_for([cell["solver"] for cell in cells], result)
    rows = list(dict.fromkeys(cell["row"] for cell in cells))
    cases = [shorten(clean(row), 1.6, TEXT_SIZE) for row in rows]
    names = [shorten(short(style.label), LABEL_WIDTH - 0.1, TEXT_SIZE) for style in styles.values()]
    sound = styles.keys() - {cell["solver"] for cell in cells if cell["outcome"] in GRAVE}
    header = 0.87 * max(inches(case, TEXT_SIZE) for case in cases)
    sheet = make_sheet(result, f"Hard cases: {len(sound)} of {len(names)} methods never diverge, crash or claim a wrong result", [_caption(cells)],
                       MARGIN + LABEL_WIDTH + max(CELL_WIDTH * len(rows), 4) + 0.9, CELL_HEIGHT * len(names) - 0.3 + header)
    axes = sheet.axes(MARGIN + LABEL_WIDTH, sheet.bottom - 0.3, CELL_WIDTH * len(rows), CELL_HEIGHT * len(names))
    axes.set(xlim=(0, len(rows)), ylim=(len(names), 0))
    axes.spines[:].set_visible(False)
    axes.xaxis.tick_top()
    axes.tick_params(length=0, labelsize=TEXT_SIZE)
    axes.set_xticks([k + 0.5 for k in range(len(rows))], cases, rotation=60, ha="left", rotation_mode="anchor")
    axes.set_yticks([k + 0.5 for k in range(len(names))], names)
    places: dict[tuple[int, int], list[Json]] = {}
    for cell in cells:
        places.setdefault((rows.index(cell["row"]), list(styles).index(cell["solver"])), []).append(cell)
    for place, here in places.items():
        _draw_cell(axes, *place, here)
    return sheet.figure


def _draw_cell(axes: Axes, column: int, row: int, cells: list[Json]) -> None:
    """The worst outcome of the row's cases."""
    worst = max((cell["outcome"] for cell in cells), key=list(OUTCOMES).index)
    letter, _, color = OUTCOMES[worst]
    framed = not all(cell["as_expected"] for cell in cells)
    axes.add_patch(Rectangle((column, row), 1, 1, facecolor=color, edgecolor="black" if framed else "#999999",
                             linewidth=1.6 if framed else 0.5, clip_on=False, zorder=2 if framed else 1))
    axes.text(column + 0.5, row + 0.5, letter, ha="center", va="center", color="white" if worst in GRAVE else "black", fontsize=TEXT_SIZE - 1)


def _caption(cells: list[Json]) -> str:
    letters = ", ".join(f"{letter} = {meaning}" for letter, meaning, _ in OUTCOMES.values())
    unexpected = sum(not cell["as_expected"] for cell in cells)
    known = sum(cell["known_difference"] for cell in cells)
    return (f"{len({cell['case'] for cell in cells})} cases at one fixed step each, once more with smaller steps where refused; a cell has the worst "
            f"outcome of its cases (bench show has each): {letters}. Thick frame: an outcome that its case does not expect, {unexpected} in all, "
            f"{known} of them known and explained in the result file.")
