"""Draws a stability result: the matrix of hard cases and solvers, and the largest stable steps beneath it."""

import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from parts.colors import ALARM
from parts.result import Figures, Json, Result
from parts.sheet import make_sheet
from parts.style import Styles, styles_for
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
STEPS_TITLE = "largest step (s) at which one simulated second is survived, strain limit 1 %"
TOLD_GAIN = 0.05  # energy gained, over its scale, from which on a cell says so


def figures_of(result: Result) -> Figures:
    document = result.document
    return [("matrix", draw, result)] if document.get("matrix") or document.get("largest_steps") else []


def draw(result: Result) -> Figure:
    cells, steps = result.document["matrix"], result.document["largest_steps"]
    styles = styles_for([entry["solver"] for entry in cells + steps], result)
    rows = list(dict.fromkeys(cell["row"] for cell in cells))
    scenes = list(dict.fromkeys(entry["scene"] for entry in steps))
    names = [shorten(style.label.split(" (")[0], NAME_WIDTH, TEXT_SIZE) for style in styles.values()]
    header = 0.3 + math.sin(SLOPE) * max(inches(name, TEXT_SIZE) for name in names)
    panel = header + CELL_HEIGHT * len(rows) + (0.45 + CELL_HEIGHT * len(scenes) if scenes else 0)
    # Names of the last columns run out at the right edge.
    ends = [CELL_WIDTH * (number + 0.5) + inches(name, TEXT_SIZE) * math.cos(SLOPE) + 0.2 for number, name in enumerate(names)]
    width = LABEL_WIDTH + max(CELL_WIDTH * len(styles) + 0.3, *ends, inches(STEPS_TITLE, TEXT_SIZE, "bold") + 0.2)
    sheet = make_sheet(result, "Hard cases: where each solver breaks", [_caption(cells)], width, panel - 0.35)
    axes = sheet.axes(0.2, sheet.bottom - 0.35, width - 0.4, panel)
    axes.set(xlim=(0, width - 0.4), ylim=(panel + 0.02, 0))  # room for the last frame
    axes.axis("off")
    left = LABEL_WIDTH - 0.2
    for number, name in enumerate(names):
        axes.text(left + CELL_WIDTH * (number + 0.5), header - 0.08, name, rotation=math.degrees(SLOPE), ha="left", va="bottom",
                  fontsize=TEXT_SIZE, rotation_mode="anchor")
    for row_number, row in enumerate(rows):
        top = header + CELL_HEIGHT * row_number
        _draw_row_name(axes, left, top, row)
        for number, solver in enumerate(styles):
            here = [cell for cell in cells if cell["row"] == row and cell["solver"] == solver]
            if here:
                _draw_outcomes(axes, left + CELL_WIDTH * number, top, here)
    if scenes:
        top = header + CELL_HEIGHT * len(rows) + 0.45
        axes.text(left, top - 0.08, STEPS_TITLE, fontsize=TEXT_SIZE, fontweight="bold", ha="left", va="bottom")
        _draw_steps(axes, left, top, styles, scenes, steps)
    return sheet.figure


def _draw_row_name(axes: Axes, left: float, top: float, row: str) -> None:
    axes.text(left - 0.08, top + CELL_HEIGHT / 2, shorten(clean(row), LABEL_WIDTH - 0.35, TEXT_SIZE), ha="right",
              va="center", fontsize=TEXT_SIZE)


def _draw_cell(axes: Axes, x: float, y: float, text: str, face: object, dark: bool = False, framed: bool = False) -> None:
    axes.add_patch(Rectangle((x, y), CELL_WIDTH, CELL_HEIGHT, facecolor=face, edgecolor="black" if framed else "#999999",
                             linewidth=2.0 if framed else 0.5))
    axes.text(x + CELL_WIDTH / 2, y + CELL_HEIGHT / 2, text, ha="center", va="center", color="white" if dark else "black",
              fontsize=CELL_SIZE * min(1, (CELL_WIDTH - 0.06) / inches(text, CELL_SIZE)))


def _draw_outcomes(axes: Axes, x: float, y: float, cells: list[Json]) -> None:
    """Coloured by the worst outcome of the row's cases; the text counts them where they differ."""
    counts = {name: count for name in OUTCOMES if (count := sum(cell["outcome"] == name for cell in cells))}
    text = " ".join(OUTCOMES[name][0] + (str(count) if count < len(cells) else "") for name, count in counts.items())
    gain = max(cell["energy_gain"] or 0 for cell in cells)
    if gain > TOLD_GAIN:
        text += f"  E{gain:,.0f}" if 10 <= gain < 1e6 else f"  E{gain:.2g}"
    unexpected = not all(cell["as_expected"] for cell in cells)
    worst = list(counts)[-1]
    _draw_cell(axes, x, y, text + (" !" if unexpected else ""), OUTCOMES[worst][2], worst in DARK, unexpected)


def _draw_steps(axes: Axes, left: float, top: float, solvers: Styles, scenes: list[str], steps: list[Json]) -> None:
    known = [math.log(entry["step"]) for entry in steps if entry["step"]]
    low, high = min(known, default=0), max(known, default=1)
    for row, scene in enumerate(scenes):
        y = top + CELL_HEIGHT * row
        _draw_row_name(axes, left, y, scene)
        for number, solver in enumerate(solvers):
            for step in (entry["step"] for entry in steps if (entry["scene"], entry["solver"]) == (scene, solver)):
                size = (math.log(step) - low) / (high - low) if step and high > low else 0.0
                shade = 0.55 + 0.45 * size if step else 0.45  # the darker the smaller the step
                text = "none" if not step else f"1/{1 / step:.0f}" if step < 1 else f"{step:g}"
                _draw_cell(axes, left + CELL_WIDTH * number, y, text, (shade, shade, min(1.0, shade + 0.08)))


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
