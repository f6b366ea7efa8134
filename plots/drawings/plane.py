"""The plane strain x error of each scene and size: who is fastest within a strain limit and an error, and how far ahead of the best
of the paper's six. Drawn from the program's analysis alone."""

from __future__ import annotations

from functools import partial
from typing import Any, Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from parts.caption import SUBJECTS, origin_sentence, percent, warnings_of
from parts.colors import DARK_GREY, LIGHT_GREY
from parts.legend import Legend
from parts.result_file import Json, finding_in
from parts.sheet import LEFT, RIGHT, make_sheet
from parts.style import SolverStyle, styles_for
from parts.words import clean, place_part, scene_words, wrap

CELL_WIDTH, CELL_HEIGHT, NAME_SIZE, SMALL = 1.75, 0.72, 7.5, 6.5
NARROW = 1.0  # the column of limits' words


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    analysis = document.get("analysis")
    if not isinstance(analysis, dict):
        return []
    planes = [plane for plane in analysis["planes"] if plane["sweep"] == "strain"]
    return [(f"plane-{place_part(plane, planes)}", partial(draw, plane, document, legend)) for plane in planes]


def draw(plane: Json, document: Json, legend: Legend) -> Figure:
    limits, levels = plane["strain_limits"], plane["error_levels"]
    scene = SUBJECTS.get(plane["scene"], scene_words(plane["scene"]))
    title = f"{scene}, {plane['vertices']:,} vertices: who is fastest within a strain and an error"
    styles = styles_for(dict.fromkeys(cell["first"] for cell in plane["cells"] if cell["first"]), legend)
    width, height = CELL_WIDTH * len(levels), CELL_HEIGHT * len(limits)
    sheet = make_sheet(title, warnings_of(document), _caption(document), NARROW + LEFT / 2 + width + RIGHT, height + 0.3,
                       finding=" ".join(finding_in(document, plane["scene"], plane["sweep"], plane["vertices"])))
    axes = sheet.axes(NARROW, sheet.bottom, width, height)
    axes.set(xlim=(0, len(levels)), ylim=(len(limits), 0))
    for number, cell in enumerate(plane["cells"]):
        _draw_cell(axes, number % len(levels), number // len(levels), cell, styles, legend)
    axes.set_xticks([k + 0.5 for k in range(len(levels))], [_level(level) for level in levels])
    axes.set_yticks([k + 0.5 for k in range(len(limits))], [percent(limit) for limit in limits])
    axes.xaxis.tick_top()
    axes.tick_params(length=0)
    axes.set_ylabel("strain limit")
    axes.set_xlabel("error over the scene's size")
    axes.xaxis.set_label_position("bottom")
    for spine in axes.spines.values():
        spine.set_visible(False)
    return sheet.figure


def _level(level: float | None) -> str:
    return "any motion" if level is None else f"at most {percent(level)}"


def _caption(document: Json) -> list[str]:
    return ["In each cell the contestant that is fastest with its best run at this limit or a tighter one, bold if it is faster than each other one beyond the noise; "
            "its time for one simulated second, and its error; and how many times as long the best of the paper's six methods takes.",
            origin_sentence(document)]


def _draw_cell(axes: Axes, column: int, row: int, cell: Json, styles: dict[str, SolverStyle], legend: Legend) -> None:
    name = cell["first"]
    color = styles[name].color if name else LIGHT_GREY
    axes.add_patch(Rectangle((column, row), 1, 1, facecolor=color, alpha=0.22 if name else 1, edgecolor="none"))
    axes.add_patch(Rectangle((column, row), 1, 1, fill=False, edgecolor="white", linewidth=1.5))
    if not name:
        axes.text(column + 0.5, row + 0.5, "\n".join(wrap(clean(cell["empty_because"]), CELL_WIDTH - 0.15, SMALL)), ha="center",
                  va="center", fontsize=SMALL, color=DARK_GREY)
        return
    weight = "bold" if cell["clear"] else "normal"
    lines = wrap(clean(legend.label(name)), CELL_WIDTH - 0.12, NAME_SIZE, weight)[:2]
    axes.text(column + 0.5, row + 0.06, "\n".join(lines), ha="center", va="top", fontsize=NAME_SIZE, fontweight=weight,
              linespacing=1.0)
    axes.text(column + 0.5, row + 0.94, "\n".join(_figures(cell, legend)), ha="center", va="bottom", fontsize=SMALL, linespacing=1.1)


def _figures(cell: Json, legend: Legend) -> list[str]:
    first: dict[str, Any] = next(entry for entry in cell["entries"] if entry["counts"])
    error = "" if first["error"] is None else f", off by {100 * first['error']:.2g} %"
    lines = [f"{1e3 * first['seconds']:.3g} ms{error}"]
    lead, paper = cell["lead_over_paper_best"], cell["paper_best"]
    if lead:
        lines.append(f"{lead['value']:.2g} x: {clean(paper.replace('_', ' '))}")
    elif paper == cell["first"]:
        lines.append("one of the paper's six")
    else:
        lines.append("none of the paper's six")
    return lines
