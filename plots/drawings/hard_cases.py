"""Draws a stability result: the matrix of hard cases and solvers."""

import itertools
import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from parts.result import Figures, Json, Result
from parts.sheet import make_sheet
from parts.style import ALARM, styles_for
from parts.words import clean, inches, shorten

# From the mildest outcome to the gravest: letter, meaning, and a colour that differs in lightness too, for gray prints.
OUTCOMES = {
    "survived": ("S", "survived", "#FFFFFF"), "survived_smaller": ("s", "survived with smaller steps", "#DCEBF7"),
    "refused": ("R", "refused cleanly", "#B8D0E6"), "timeout": ("T", "took too long", "#F2D38B"), "diverged": ("D", "diverged", "#C2553B"),
    "wrong": ("W", "wrong: claimed success, and a check says otherwise", ALARM), "crashed": ("C", "took its process with it", "#5C1A00"),
}
DARK = ("diverged", "wrong", "crashed")
CELL_WIDTH, CELL_HEIGHT = 1.0, 0.22
LABEL_WIDTH, NAME_WIDTH = 1.75, 2.6  # of rows' and of solvers' names
SLOPE = math.radians(32)  # of solvers' names
TEXT_SIZE, CELL_SIZE = 8, 6.8
TOLD_GAIN = 0.05  # energy gained, over its scale, from which on a cell says so


def figures_of(result: Result) -> Figures:
    return [("matrix", draw, result)] if result.document.get("matrix") else []


def draw(result: Result) -> Figure:
    cells = result.document["matrix"]
    styles = styles_for([cell["solver"] for cell in cells], result)
    rows = list(dict.fromkeys(cell["row"] for cell in cells))
    names = [shorten(style.label.split(" (")[0], NAME_WIDTH, TEXT_SIZE) for style in styles.values()]
    # Names of the last columns run out at the right edge.
    ends = [CELL_WIDTH * (number + 0.5) + inches(name, TEXT_SIZE) * math.cos(SLOPE) + 0.2 for number, name in enumerate(names)]
    width = LABEL_WIDTH + max(CELL_WIDTH * len(styles) + 0.3, *ends)
    header = math.sin(SLOPE) * max(inches(name, TEXT_SIZE) for name in names)
    sheet = make_sheet(result, "Hard cases: where each solver breaks", [_caption(cells)], width,
                       header + CELL_HEIGHT * len(rows))
    axes = sheet.axes(LABEL_WIDTH, sheet.bottom - 0.35, CELL_WIDTH * len(names), CELL_HEIGHT * len(rows))
    axes.set(xlim=(0, len(names)), ylim=(len(rows), 0))
    axes.spines[:].set_visible(False)
    axes.xaxis.tick_top()
    axes.tick_params(length=0, labelsize=TEXT_SIZE)
    axes.set_xticks([k + 0.5 for k in range(len(names))], names, rotation=math.degrees(SLOPE), ha="left", rotation_mode="anchor")
    axes.set_yticks([k + 0.5 for k in range(len(rows))], [shorten(clean(row), LABEL_WIDTH - 0.35, TEXT_SIZE) for row in rows])
    for place in itertools.product(range(len(names)), range(len(rows))):
        solver, row = list(styles)[place[0]], rows[place[1]]
        if here := [cell for cell in cells if (cell["row"], cell["solver"]) == (row, solver)]:
            _draw_outcomes(axes, *place, here)
    return sheet.figure


def _draw_cell(axes: Axes, column: int, row: int, text: str, face: object, dark: bool = False, framed: bool = False) -> None:
    axes.add_patch(Rectangle((column, row), 1, 1, facecolor=face, edgecolor="black" if framed else "#999999",
                             linewidth=2.0 if framed else 0.5, clip_on=False, zorder=2 if framed else 1))
    axes.text(column + 0.5, row + 0.5, text, ha="center", va="center", color="white" if dark else "black",
              fontsize=CELL_SIZE * min(1, (CELL_WIDTH - 0.06) / inches(text, CELL_SIZE)))


def _draw_outcomes(axes: Axes, column: int, row: int, cells: list[Json]) -> None:
    """Coloured by the worst outcome of the row's cases; the text counts them where they differ."""
    counts = {name: count for name in OUTCOMES if (count := sum(cell["outcome"] == name for cell in cells))}
    text = " ".join(OUTCOMES[name][0] + (str(count) if count < len(cells) else "") for name, count in counts.items())
    gain = max(cell["energy_gain"] or 0 for cell in cells)
    if gain > TOLD_GAIN:
        text += f"  E{gain:,.0f}" if 10 <= gain < 1e6 else f"  E{gain:.2g}"
    unexpected = not all(cell["as_expected"] for cell in cells)
    worst = list(counts)[-1]
    _draw_cell(axes, column, row, text + (" !" if unexpected else ""), OUTCOMES[worst][2], worst in DARK, unexpected)


def _caption(cells: list[Json]) -> str:
    letters = ", ".join(f"{letter} = {meaning}" for letter, meaning, _ in OUTCOMES.values())
    unexpected = sum(not cell["as_expected"] for cell in cells)
    known = sum(cell["known_difference"] for cell in cells)
    two = sum(cell["admitted_beside"] is not None for cell in cells)
    verdict = "every outcome is the one that its case expects, or admitted beside it" if unexpected == 0 else \
        f"{unexpected} outcomes are not as their cases expect (marked !, thick frame)" + \
        (f", {known} of them known and explained in the result file" if known else "")
    return (f"{len({cell['case'] for cell in cells})} cases, each at one fixed step; a refused one once more with a step controller that halves "
            f"the step. A cell has the worst outcome of its row's cases, with counts where they differ: {letters}; "
            "E = largest energy gain over weight times size plus kinetic energy at the start, if above 0.05 and within what "
            f"the case's slack permits. Here {verdict}; {len(cells) - two} of {len(cells)} admit one outcome only, {two} two.")
