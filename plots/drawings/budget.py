"""What a frame costs: from which time a frame on each method keeps each strain limit with the right motion."""

from matplotlib import colormaps
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from parts.axes import grid, set_ticks
from parts.result import Figures, Json, Result
from parts.sheet import RIGHT, make_sheet
from parts.style import DARK_GREY, LIGHT_GREY
from parts.words import percent, place_part, shorten, subject

BUDGETS = (1, 4, 16)  # ms of a frame of 1/60 s, as in `bench budget`
WIDTH, ROW, NAMES = 6.0, 0.24, 2.6
MARK = {"marker": "o", "markersize": 6, "linestyle": "none", "markeredgecolor": "white", "markeredgewidth": 0.5}


def figures_of(result: Result) -> Figures:
    places = [place for place in result.analysis.get("budgets", []) if len(_limits(place)) > 1]
    return [(f"budget-{place_part(place, places)}", draw, place, result) for place in places]


def draw(place: Json, result: Result) -> Figure:
    limits, scene, vertices = _limits(place), place["scene"], place["vertices"]
    rows = {row["row"]: reached for row in place["rows"] if (reached := _reached(row))}
    never = [result.label(row["row"]) for row in place["rows"] if row["row"] not in rows]
    caption = [f"A mark: from this time a frame of 1/60 s on, in 99 of 100 frames, one core keeps the strain limit of its "
               f"colour, with a motion error of at most {percent(result.analysis['headline_error'])}. Lines: "
               f"{', '.join(str(ms) for ms in BUDGETS)} ms."] + ([f"With no run that is right: {', '.join(never)}."] if never else [])
    found = result.finding(scene, "strain", vertices) or result.finding(scene, "step", vertices)
    height = ROW * (len(rows) + 0.6)
    sheet = make_sheet(result, f"{subject(scene, vertices)}: which strain a frame's time buys", caption, NAMES + WIDTH + RIGHT, height + 0.25,
                       finding=" ".join(found[:1]))
    axes = sheet.axes(NAMES, sheet.bottom, WIDTH, height)
    axes.set(xscale="log", ylim=(len(rows) - 0.4, -1), xlabel="ms a frame of 1/60 s, in 99 of 100 frames")
    for budget in BUDGETS:
        axes.axvline(budget, color=DARK_GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    shades = {limit: to_hex(colormaps["Blues"](0.25 + 0.75 * k / (len(limits) - 1))) for k, limit in enumerate(limits)}  # darker: less strain
    for number, reached in enumerate(rows.values()):
        axes.plot([ms for ms, _ in reached], [number] * len(reached), color=LIGHT_GREY, linewidth=3, zorder=2)
        for ms, limit in reached:
            axes.plot(ms, number, color=shades[limit], zorder=3, **MARK)
    axes.legend(handles=[Line2D([], [], color=shades[limit], label=percent(limit), **MARK) for limit in limits], loc="lower left",
                frameon=False, fontsize=8, bbox_to_anchor=(0, 1), borderaxespad=0, ncol=len(limits), handletextpad=0.1, columnspacing=1.2)
    axes.set_yticks(range(len(rows)), [shorten(result.label(name), NAMES - 0.2, 8) for name in rows])
    set_ticks(axes.xaxis, LogLocator(), LogLocator(subs=range(2, 10)))
    axes.tick_params(axis="y", length=0)
    grid(axes)
    return sheet.figure


def _reached(row: Json) -> list[tuple[float, float]]:
    """ms a frame and strain limit of the first run at each limit within the motion error: shortest frames first, then less strain."""
    found: list[tuple[float, float]] = []
    for stair in row["stairs"]:
        if stair["right"] and (not found or stair["strain_limit"] < found[-1][1]):
            found.append((1e3 * stair["frame_seconds"], stair["strain_limit"]))
    return found


def _limits(place: Json) -> list[float]:
    """That some method reaches, loose to tight."""
    return sorted({limit for row in place["rows"] for _, limit in _reached(row)}, reverse=True)
