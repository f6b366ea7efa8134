"""Draws a stability result: the matrix of hard cases and solvers, and the largest stable steps beneath it."""

from __future__ import annotations

import math
from functools import partial
from typing import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from parts.caption import origin_sentence, warnings_of
from parts.colors import ALARM
from parts.curves import Styles
from parts.legend import Legend, Status, made_up
from parts.result_file import STABILITY_SCHEMA, Json, ResultError, is_number, positive
from parts.sheet import make_sheet
from parts.style import styles_for
from parts.words import clean, inches, shorten

# For files whose legend does not name the outcomes: from the mildest to the gravest.
OUTCOMES = {
    "survived": Status("S", "survived"), "survived_smaller": Status("s", "survived with smaller steps"),
    "refused": Status("R", "refused cleanly"), "timeout": Status("T", "took too long"), "diverged": Status("D", "diverged"),
    "wrong": Status("W", "wrong: claimed success, and a check says otherwise"),
    "crashed": Status("C", "took its process with it"),
}
# From the mildest outcome to the gravest: distinguished by letter and by lightness, for gray prints.
COLORS = ("#FFFFFF", "#DCEBF7", "#B8D0E6", "#F2D38B", "#C2553B", ALARM, "#5C1A00")
DARK = COLORS[4:]
CELL_WIDTH, CELL_HEIGHT = 1.0, 0.22
LABEL_WIDTH, NAME_WIDTH = 1.75, 2.6  # of rows' and of solvers' names
SLOPE = math.radians(32)  # of solvers' names
TEXT_SIZE, CELL_SIZE = 8, 6.8
STEPS_TITLE = "largest step (s) at which one simulated second is survived, strain limit 1 %"
TOLD_GAIN = 0.05  # energy gained, over its scale, from which on a cell says so

Outcomes = dict[str, Status]


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [("matrix", partial(draw, document, legend))] if document["schema"] == STABILITY_SCHEMA else []


def draw(document: Json, legend: Legend) -> Figure:
    cells, steps = document["matrix"], document["largest_steps"]
    if not cells and not steps:
        raise ResultError("nothing to draw: no case was run")
    styles = styles_for((entry["solver"] for entry in cells + steps), legend)
    outcomes = _outcomes(cells, legend)
    rows = list(dict.fromkeys(cell["row"] for cell in cells))
    scenes = list(dict.fromkeys(entry["scene"] for entry in steps))
    names = [shorten(style.label.split(" (")[0], NAME_WIDTH, TEXT_SIZE)
             for style in styles.values()]
    header = 0.3 + math.sin(SLOPE) * max(inches(name, TEXT_SIZE) for name in names)
    panel = header + CELL_HEIGHT * len(rows) + (0.45 + CELL_HEIGHT * len(scenes) if scenes else 0)
    width = LABEL_WIDTH + max(CELL_WIDTH * len(styles) + _beyond(names), inches(STEPS_TITLE, TEXT_SIZE, "bold") + 0.2)
    sheet = make_sheet("Hard cases: where each solver breaks", warnings_of(document), _caption(document, cells, outcomes),
                       width, panel - 0.35)
    axes = sheet.axes(0.2, sheet.bottom - 0.35, width - 0.4, panel)
    axes.set_xlim(0, width - 0.4)
    axes.set_ylim(panel + 0.02, 0)  # room for the last frame
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
            _draw_cell(axes, left + CELL_WIDTH * number, top, here, outcomes)
    if scenes:
        top = header + CELL_HEIGHT * len(rows) + 0.45
        axes.text(left, top - 0.08, STEPS_TITLE, fontsize=TEXT_SIZE, fontweight="bold", ha="left", va="bottom")
        _draw_steps(axes, left, top, styles, scenes, steps)
    return sheet.figure


def _outcomes(cells: list[Json], legend: Legend) -> Outcomes:
    """By name, from the mildest to the gravest. One that nobody has heard of is taken for the gravest."""
    seen = sorted({cell["outcome"] for cell in cells})
    known = legend.statuses if seen and all(name in legend.statuses for name in seen) else OUTCOMES
    return {**known, **{name: made_up(name) for name in seen if name not in known}}


def _beyond(names: list[str]) -> float:
    """Room at the right edge for names that run out of the last columns."""
    ends = [CELL_WIDTH * (number + 0.5) + inches(name, TEXT_SIZE) * math.cos(SLOPE) + 0.1
            for number, name in enumerate(names)]
    return max(0.3, max(ends) - CELL_WIDTH * len(names) + 0.1)


def _draw_row_name(axes: Axes, left: float, top: float, name: str) -> None:
    axes.text(left - 0.08, top + CELL_HEIGHT / 2, shorten(clean(name), LABEL_WIDTH - 0.35, TEXT_SIZE), ha="right",
              va="center", fontsize=TEXT_SIZE)


def _draw_cell(axes: Axes, x: float, y: float, cells: list[Json], outcomes: Outcomes) -> None:
    """Coloured by the worst outcome of the row's cases; the text counts them where they differ."""
    if not cells:
        return
    order = list(outcomes)
    counts = {name: sum(cell["outcome"] == name for cell in cells) for name in order}
    worst = max((place for place, name in enumerate(order) if counts[name]))
    text = " ".join(outcomes[name].letter + (str(counts[name]) if counts[name] < len(cells) else "")
                    for name in order if counts[name])
    gain = max((cell["energy_gain"] for cell in cells if is_number(cell.get("energy_gain"))), default=0.0)
    unexpected = any(cell.get("as_expected") is False for cell in cells)
    face = COLORS[round(worst * (len(COLORS) - 1) / max(1, len(order) - 1))]
    axes.add_patch(Rectangle((x, y), CELL_WIDTH, CELL_HEIGHT, facecolor=face,
                             edgecolor="black" if unexpected else "#999999", linewidth=2.0 if unexpected else 0.5))
    if gain > TOLD_GAIN:
        text += f"  E{gain:,.0f}" if 10 <= gain < 1e6 else f"  E{gain:.2g}"
    text += " !" if unexpected else ""
    size = CELL_SIZE * min(1, (CELL_WIDTH - 0.06) / inches(text, CELL_SIZE))
    axes.text(x + CELL_WIDTH / 2, y + CELL_HEIGHT / 2, text, ha="center", va="center", fontsize=size,
              color="white" if face in DARK else "black")


def _draw_steps(axes: Axes, left: float, top: float, solvers: Styles, scenes: list[str], steps: list[Json]) -> None:
    found = {(entry["scene"], entry["solver"]): entry.get("step") for entry in steps}
    known = [step for step in found.values() if positive(step)]
    low, high = (math.log(min(known)), math.log(max(known))) if known else (0.0, 1.0)
    for row_number, scene in enumerate(scenes):
        y = top + CELL_HEIGHT * row_number
        _draw_row_name(axes, left, y, scene)
        for number, solver in enumerate(solvers):
            if (scene, solver) not in found:
                continue
            step = found[scene, solver]
            size = (math.log(step) - low) / (high - low) if positive(step) and high > low else 0.0
            shade = 1 - 0.45 * (1 - size) if positive(step) else 0.45  # the darker the smaller the step
            x = left + CELL_WIDTH * number
            axes.add_patch(Rectangle((x, y), CELL_WIDTH, CELL_HEIGHT, facecolor=(shade, shade, min(1.0, shade + 0.08)),
                                     edgecolor="#999999", linewidth=0.5))
            axes.text(x + CELL_WIDTH / 2, y + CELL_HEIGHT / 2, _step_name(step),
                      ha="center", va="center", fontsize=CELL_SIZE)


def _step_name(step: object) -> str:
    if not positive(step):
        return "none"
    return f"1/{1 / step:.0f}" if 1e-6 < step < 1 else f"{step:g}"


def _caption(document: Json, cells: list[Json], outcomes: Outcomes) -> list[str]:
    letters = ", ".join(f"{outcome.letter} = {outcome.meaning}" for outcome in outcomes.values())
    unexpected = sum(cell.get("as_expected") is False for cell in cells)
    known = sum(cell.get("known_difference") is True for cell in cells)
    count = len({cell["case"] for cell in cells})
    verdict = "every outcome is the one that its case expects, or admitted beside it" if unexpected == 0 else \
        f"{unexpected} outcomes are not as their cases expect (marked !, thick frame)" + \
        (f", {known} of them known and explained in the result file" if known else "")
    two = sum(cell.get("admitted_beside") is not None for cell in cells)
    verdict += f"; {len(cells) - two} of {len(cells)} admit one outcome only, {two} two"
    return [f"{count} cases, each at one fixed step; a refused one once more with a step controller that halves the step. "
            f"A cell has the worst outcome of its row's cases, with counts where they differ: {letters}; "
            "E = largest energy gain over weight times size plus kinetic energy at the start, if above 0.05 and within what "
            f"the case's slack permits. Here {verdict}.",
            origin_sentence(document)]
