"""Draws a stability result: the matrix of hard cases and solvers, and the largest stable steps beneath it."""

from __future__ import annotations

import math
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from caption import origin_sentence, warnings_of
from results import Json, ResultError, is_number
from sheet import make_sheet
from style import styles_for

# Letter, meaning, colour and how dark it is: told apart by letter and by lightness, so that grey prints read as well.
OUTCOMES: dict[str, tuple[str, str, str]] = {
    "survived": ("S", "survived", "#FFFFFF"),
    "survived_smaller": ("s", "survived with smaller steps", "#DCEBF7"),
    "refused": ("R", "refused cleanly", "#B8D0E6"),
    "timeout": ("T", "took too long", "#F2D38B"),
    "diverged": ("D", "diverged", "#C2553B"),
    "wrong": ("W", "wrong: claimed success, and a check says otherwise", "#A32D00"),
    "crashed": ("C", "took its process with it", "#5C1A00"),
}
DARK = ("diverged", "wrong", "crashed")
CELL_WIDTH, CELL_HEIGHT = 1.0, 0.22
LABEL_WIDTH, HEADER = 1.75, 1.05
TOLD_GAIN = 0.05  # energy gained, over its scale, from which on a cell says so


def draw(document: Json) -> Figure:
    cells, steps = document["matrix"], document.get("largest_steps", [])
    if not cells and not steps:
        raise ResultError("nothing to draw: no case was run")
    solvers = list(styles_for(entry["solver"] for entry in cells + steps))
    rows = list(dict.fromkeys(cell["row"] for cell in cells))
    scenes = list(dict.fromkeys(entry["scene"] for entry in steps))
    panel = HEADER + CELL_HEIGHT * len(rows) + (0.45 + CELL_HEIGHT * len(scenes) if scenes else 0)
    width = LABEL_WIDTH + CELL_WIDTH * len(solvers) + 0.3
    sheet = make_sheet("Hard cases: where each solver breaks", warnings_of(document), _caption(document, cells), width,
                       panel - 0.35)
    axes = sheet.axes(0.2, sheet.bottom - 0.35, width - 0.4, panel)
    axes.set_xlim(0, width - 0.4)
    axes.set_ylim(panel + 0.02, 0)  # room for the last frame
    axes.axis("off")
    left = LABEL_WIDTH - 0.2
    labels = styles_for(solvers)
    for number, solver in enumerate(solvers):
        axes.text(left + CELL_WIDTH * (number + 0.5), HEADER - 0.08, labels[solver].label.split(" (")[0], rotation=32,
                  ha="left", va="bottom", fontsize=8, rotation_mode="anchor")
    for row_number, row in enumerate(rows):
        top = HEADER + CELL_HEIGHT * row_number
        axes.text(left - 0.08, top + CELL_HEIGHT / 2, row, ha="right", va="center", fontsize=8)
        for number, solver in enumerate(solvers):
            here = [cell for cell in cells if cell["row"] == row and cell["solver"] == solver]
            _draw_cell(axes, left + CELL_WIDTH * number, top, here)
    if scenes:
        top = HEADER + CELL_HEIGHT * len(rows) + 0.45
        axes.text(left, top - 0.08, "largest step (s) at which one simulated second is survived, strain limit 1 %",
                  fontsize=8, fontweight="bold", ha="left", va="bottom")
        _draw_steps(axes, left, top, solvers, scenes, steps)
    return sheet.figure


def _draw_cell(axes: Axes, x: float, y: float, cells: list[Json]) -> None:
    """Coloured by the worst outcome of the row's cases; the text counts them where they differ."""
    if not cells:
        return
    order = list(OUTCOMES)
    counts = {name: sum(cell["outcome"] == name for cell in cells) for name in order}
    worst = max((name for name in order if counts[name]), key=order.index)
    text = " ".join(OUTCOMES[name][0] + (str(counts[name]) if counts[name] < len(cells) else "")
                    for name in order if counts[name])
    gain = max((cell["energy_gain"] for cell in cells if is_number(cell.get("energy_gain"))), default=0.0)
    unexpected = any(cell.get("as_expected") is False for cell in cells)
    axes.add_patch(Rectangle((x, y), CELL_WIDTH, CELL_HEIGHT, facecolor=OUTCOMES[worst][2],
                             edgecolor="black" if unexpected else "#999999", linewidth=2.0 if unexpected else 0.5))
    color = "white" if worst in DARK else "black"
    if gain > TOLD_GAIN:
        text += f"  E{gain:,.0f}" if gain >= 10 else f"  E{gain:.2g}"
    axes.text(x + CELL_WIDTH / 2, y + CELL_HEIGHT / 2, text + (" !" if unexpected else ""), ha="center", va="center",
              fontsize=6.8, color=color)


def _draw_steps(axes: Axes, left: float, top: float, solvers: list[str], scenes: list[str], steps: list[Json]) -> None:
    found: dict[tuple[str, str], Any] = {(entry["scene"], entry["solver"]): entry.get("step") for entry in steps}
    known = [step for step in found.values() if is_number(step) and step > 0]
    low, high = (math.log(min(known)), math.log(max(known))) if known else (0.0, 1.0)
    for row_number, scene in enumerate(scenes):
        y = top + CELL_HEIGHT * row_number
        axes.text(left - 0.08, y + CELL_HEIGHT / 2, scene, ha="right", va="center", fontsize=8)
        for number, solver in enumerate(solvers):
            if (scene, solver) not in found:
                continue
            step = found[scene, solver]
            size = (math.log(step) - low) / (high - low) if is_number(step) and high > low else 0.0
            shade = 1 - 0.45 * (1 - size) if is_number(step) else 0.45  # the darker the smaller the step
            x = left + CELL_WIDTH * number
            axes.add_patch(Rectangle((x, y), CELL_WIDTH, CELL_HEIGHT, facecolor=(shade, shade, min(1.0, shade + 0.08)),
                                     edgecolor="#999999", linewidth=0.5))
            axes.text(x + CELL_WIDTH / 2, y + CELL_HEIGHT / 2, f"1/{1 / step:.0f}" if is_number(step) else "none",
                      ha="center", va="center", fontsize=6.8)


def _caption(document: Json, cells: list[Json]) -> list[str]:
    letters = ", ".join(f"{letter} = {meaning}" for letter, meaning, _ in OUTCOMES.values())
    unexpected = sum(cell.get("as_expected") is False for cell in cells)
    count = len({cell["case"] for cell in cells})
    verdict = "every outcome is one that its case expects" if unexpected == 0 else \
        f"{unexpected} outcomes are not as their cases expect (marked !, thick frame)"
    return [f"{count} cases, each at one fixed step; a refused one once more with a step controller that halves the step. "
            f"A cell has the worst outcome of its row's cases, with counts where they differ: {letters}; "
            "E = largest energy gain over weight times size plus kinetic energy at the start, if above 0.05 and within what "
            f"the case's slack permits. Here {verdict}.",
            origin_sentence(document)]
