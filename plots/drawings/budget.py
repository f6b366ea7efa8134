"""What a frame costs: from which time a frame on each method keeps each strain limit with the right motion. Drawn from the program's
analysis alone."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter

from parts.best_points import HEADLINE
from parts.caption import SUBJECTS, origin_sentence, percent, warnings_of
from parts.colors import DARK_GREY, LIGHT_GREY
from parts.legend import Legend
from parts.result_file import Json, finding_in
from parts.sheet import RIGHT, grid, make_sheet
from parts.words import clean, place_part, scene_words, shorten

BUDGETS = (1, 4, 16)  # ms of a frame of 1/60 s, as in `bench budget`
WIDTH, ROW, NAMES = 6.0, 0.24, 2.6

Reached = list[tuple[float, float]]  # ms a frame, strain limit


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    analysis = document.get("analysis")
    if not isinstance(analysis, dict):
        return []
    places = [place for place in analysis.get("budgets", []) if len(_limits(place)) > 1]
    return [(f"budget-{place_part(place, places)}", partial(draw, place, document, legend)) for place in places]


def draw(place: Json, document: Json, legend: Legend) -> Figure:
    scene = SUBJECTS.get(place["scene"], scene_words(place["scene"]))
    limits = _limits(place)
    rows = {row["row"]: reached for row in place["rows"] if (reached := _reached(row))}
    never = [clean(legend.label(row["row"])) for row in place["rows"] if row["row"] not in rows]
    caption = [f"A mark: from this time a frame of 1/60 s on, in 99 of 100 frames, one core keeps the strain limit of its "
               f"colour, with a motion error of at most {percent(HEADLINE)}. Lines: "
               f"{', '.join(str(ms) for ms in BUDGETS)} ms.",
               f"With no run that is right: {', '.join(never)}." if never else "", origin_sentence(document)]
    found = [sentence for sweep in ("strain", "step") for sentence in finding_in(document, place["scene"], sweep, place["vertices"])]
    sheet = make_sheet(f"{scene}, {place['vertices']:,} vertices: which strain a frame's time buys", warnings_of(document),
                       [words for words in caption if words], NAMES + WIDTH + RIGHT, ROW * (len(rows) + 0.6) + 0.25,
                       finding=" ".join(found[:1]))
    axes = sheet.axes(NAMES, sheet.bottom, WIDTH, ROW * (len(rows) + 0.6))
    axes.set_xscale("log")
    axes.set(ylim=(len(rows) - 0.4, -1), xlabel="ms a frame of 1/60 s, in 99 of 100 frames")
    for budget in BUDGETS:
        axes.axvline(budget, color=DARK_GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    for number, reached in enumerate(rows.values()):
        _draw_row(axes, number, reached, limits)
    axes.legend(handles=[_mark(_shade(limit, limits), percent(limit)) for limit in limits], loc="lower left", frameon=False, fontsize=8,
                bbox_to_anchor=(0, 1), borderaxespad=0, ncol=len(limits), handletextpad=0.1, columnspacing=1.2)
    axes.set_yticks(range(len(rows)), [shorten(clean(legend.label(name)), NAMES - 0.2, 8) for name in rows])
    axes.xaxis.set_major_formatter(FuncFormatter(lambda ms, _: f"{ms:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="y", length=0)
    grid(axes)
    return sheet.figure


def _draw_row(axes: Axes, number: int, reached: Reached, limits: list[float]) -> None:
    axes.plot([ms for ms, _ in reached], [number] * len(reached), color=LIGHT_GREY, linewidth=3, zorder=2)
    for ms, limit in reached:
        mark = _mark(_shade(limit, limits))
        mark.set(xdata=[ms], ydata=[number], zorder=3)
        axes.add_line(mark)
    axes.autoscale_view(scaley=False)


def _mark(color: str, label: str = "") -> Line2D:
    return Line2D([], [], marker="o", markersize=6, linestyle="none", color=color, markeredgecolor="white", markeredgewidth=0.5, label=label)


def _shade(limit: float, limits: list[float]) -> str:
    """Darker: less strain."""
    return to_hex(colormaps["Blues"](0.25 + 0.75 * limits.index(limit) / max(1, len(limits) - 1)))


def _reached(row: Json) -> Reached:
    """The first run at each limit within the motion error: shortest frames first, then less strain."""
    found: Reached = []
    for stair in row["stairs"]:
        if stair["right"] and (not found or stair["strain_limit"] < found[-1][1]):
            found.append((1e3 * stair["frame_seconds"], stair["strain_limit"]))
    return found


def _limits(place: Json) -> list[float]:
    """That some method reaches, loose to tight."""
    return sorted({limit for row in place["rows"] for _, limit in _reached(row)}, reverse=True)
