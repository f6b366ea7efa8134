"""The plane strain x error of each scene and size: the fastest within both, and its lead over the best of the paper's six."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from parts.result import Figures, Json, Result
from parts.sheet import RIGHT, make_sheet
from parts.style import DARK_GREY, LIGHT_GREY, Styles, styles_for
from parts.words import clean, percent, place_part, shorten, subject, wrap

CELL_WIDTH, CELL_HEIGHT, NAME_SIZE, SMALL = 1.62, 0.72, 7.5, 6.5
NARROW = 1.0  # the column of limits' words


def figures_of(result: Result, every: bool = False) -> Figures:
    planes = [plane for plane in result.analysis.get("planes", []) if plane["sweep"] == "strain"]
    return [(f"plane-{place_part(plane, planes)}", draw, plane, result) for plane in planes]


def draw(plane: Json, result: Result) -> Figure:
    limits, levels = plane["strain_limits"], plane["error_levels"]
    styles = styles_for([cell["first"] for cell in plane["cells"] if cell["first"]], result)
    width, height = CELL_WIDTH * len(levels), CELL_HEIGHT * len(limits)
    caption = ("Fastest method with a run at this limit or a tighter one, bold if faster than each other one beyond the noise; its time for a "
               "simulated second and its error; and how many times as long the best of the paper's six takes.")
    sheet = make_sheet(result, result.headline(subject(plane["scene"], plane["vertices"]), plane["scene"], plane["sweep"], plane["vertices"]),
                       [caption], NARROW + width + RIGHT, height + 0.3)
    axes = sheet.axes(NARROW, sheet.bottom, width, height)
    axes.set(xlim=(0, len(levels)), ylim=(len(limits), 0), xlabel="motion error over the scene's size", ylabel="strain limit")
    for number, cell in enumerate(plane["cells"]):
        row, column = divmod(number, len(levels))
        _draw_cell(axes, column, row, cell, styles, result)
    axes.set_xticks([k + 0.5 for k in range(len(levels))],
                    ["any motion" if level is None else f"at most {percent(level)}" for level in levels])
    axes.set_yticks([k + 0.5 for k in range(len(limits))], [percent(limit) for limit in limits])
    axes.xaxis.tick_top()
    axes.tick_params(length=0)
    axes.xaxis.set_label_position("bottom")
    axes.spines[:].set_visible(False)
    return sheet.figure


def _draw_cell(axes: Axes, column: int, row: int, cell: Json, styles: Styles, result: Result) -> None:
    name = cell["first"]
    color = styles[name].color if name else LIGHT_GREY
    axes.add_patch(Rectangle((column, row), 1, 1, facecolor=color, alpha=0.22 if name else 1, edgecolor="none"))
    axes.add_patch(Rectangle((column, row), 1, 1, fill=False, edgecolor="white", linewidth=1.5))
    if not name:
        axes.text(column + 0.5, row + 0.5, "\n".join(wrap(clean(cell["empty_because"]), CELL_WIDTH - 0.15, SMALL)), ha="center",
                  va="center", fontsize=SMALL, color=DARK_GREY)
        return
    weight = "bold" if cell["clear"] else "normal"
    lines = wrap(result.title(name), CELL_WIDTH - 0.12, NAME_SIZE, weight)[:2]
    axes.text(column + 0.5, row + 0.06, "\n".join(lines), ha="center", va="top", fontsize=NAME_SIZE, fontweight=weight,
              linespacing=1.0)
    first = next(entry for entry in cell["entries"] if entry["counts"])
    lead, paper = cell["lead_over_paper_best"], cell["paper_best"]
    words = (f"{1e3 * first['seconds']:.3g} ms" + ("" if first["error"] is None else f", off by {100 * first['error']:.2g} %"),
             f"{lead['value']:.2g} x: {result.title(paper)}" if lead else
             "one of the paper's six" if paper == name else "none of the paper's six")
    axes.text(column + 0.5, row + 0.94, "\n".join(shorten(line, CELL_WIDTH - 0.06, SMALL) for line in words), ha="center", va="bottom",
              fontsize=SMALL, linespacing=1.1)
