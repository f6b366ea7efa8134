"""How the times of each solver's best points have changed over the result files of a folder: one panel a scene, one line a
solver. The one figure of many files; plots/history.py draws it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

from parts.curves import line_of
from parts.legend import Legend, legend_of, merged
from parts.result_file import SCHEMA, Json, ResultError, contestant_of, load, time_of, object_in, points_of
from parts.sheet import GAP, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, add_legend, grid, legend_height, make_sheet
from parts.style import GREY, styles_for
from parts.words import clean, shorten

DATES = 0.55  # inches, for slanted dates

Place = tuple[str, str, int, float]  # sweep, scene, vertices, strain limit: where on an axis a best point lies


@dataclass(frozen=True)
class Entry:
    """One result file: when, with what, and the time of each solver's best points."""

    date: datetime
    commit: str
    machine: tuple[str, str]  # processor, compiler with flags
    times: dict[str, dict[Place, float]]
    legend: Legend


def entry_of(document: Json, path: Path) -> Entry:
    context = object_in(document, "context")
    build = object_in(context, "build")
    try:
        date = datetime.fromisoformat(str(context.get("date"))).astimezone()
    except (ValueError, OverflowError) as error:
        raise ResultError(f"{path}: context.date is {clean(context.get('date'))!r}, no date") from error
    times: dict[str, dict[Place, float]] = {}
    for point in points_of(document):
        time = time_of(point)
        if point.get("best") is True and time is not None:
            place = (point["sweep"], point["scene"], point["vertices"], float(point["strain_limit"]))
            times.setdefault(contestant_of(point), {})[place] = time
    machine = (str(context.get("cpu_model")), f"{build.get('compiler')} {build.get('flags')}")
    return Entry(date, clean(build.get("git", ""))[:7], machine, times, legend_of(document))


def entries_in(folder: Path) -> list[Entry]:
    if not folder.is_dir():
        raise ResultError(f"{folder} is no folder")
    documents = [(path, load(path)) for path in sorted(folder.glob("*.json"))]
    entries = [entry_of(document, path) for path, document in documents if document["schema"] == SCHEMA]
    entries = sorted((entry for entry in entries if entry.times), key=lambda entry: entry.date)
    if not entries:
        raise ResultError(f"{folder}: no result file with best points")
    return entries


def ratios(entries: list[Entry], scene: str, solver: str) -> list[tuple[int, float]]:
    """Number of the result, and the solver's times over those of the first one: step by step, each result against the last
    one before it that shares points with it."""
    curve: list[tuple[int, float]] = []
    before: list[dict[Place, float]] = []  # of the results on the curve
    for number, entry in enumerate(entries):
        times = {place: seconds for place, seconds in entry.times.get(solver, {}).items() if place[1] == scene}
        known = next((k for k in reversed(range(len(before))) if before[k].keys() & times.keys()), None)
        if known is not None:
            common = before[known].keys() & times.keys()
            change = sum(math.log(times[place] / before[known][place]) for place in common) / len(common)
            curve.append((number, curve[known][1] * math.exp(change)))
            before.append(times)
        elif times and not before:
            curve.append((number, 1.0))
            before.append(times)
    return curve


def draw(entries: list[Entry]) -> Figure:
    scenes = sorted({place[1] for entry in entries for times in entry.times.values() for place in times})
    curves = {scene: {solver: curve for solver in {s for entry in entries for s in entry.times}
                      if (curve := ratios(entries, scene, solver))} for scene in scenes}
    scenes = [scene for scene in scenes if curves[scene]]
    if not scenes:
        raise ResultError("the results have no point in common")
    styles = styles_for({solver for scene in scenes for solver in curves[scene]},
                        merged(entry.legend for entry in reversed(entries)))
    changed = [number for number in range(1, len(entries)) if entries[number].machine != entries[number - 1].machine]
    words = ["Time of each solver's best points over that of the first result: from result to result the geometric mean over "
             "the points that both have. Best steps may differ between results. Each result was measured on its own, so "
             "differences below a few tens of per cent may be the machine's; bench ab compares two builds fairly."]
    if changed:
        words.append("Dashed: from here on another machine, compiler or flags; a jump there says nothing about the code.")
    width = LEFT + len(scenes) * MAIN_WIDTH + (len(scenes) - 1) * GAP + LEGEND_WIDTH
    sheet = make_sheet("Times over results", [], words, width, MAIN_HEIGHT + DATES,
                       legend_height(styles) - MAIN_HEIGHT - DATES)
    top = max(ratio for scene in scenes for curve in curves[scene].values() for _, ratio in curve)
    low = min(ratio for scene in scenes for curve in curves[scene].values() for _, ratio in curve)
    for column, scene in enumerate(scenes):
        axes = sheet.axes(LEFT + column * (MAIN_WIDTH + GAP), sheet.bottom + DATES, MAIN_WIDTH, MAIN_HEIGHT)
        scales(axes, entries, low, top)
        for number in changed:
            axes.axvline(number - 0.5, color=GREY, linewidth=0.8, dashes=(3, 3), zorder=1)
        for order, (solver, style) in enumerate(styles.items()):
            curve = curves[scene].get(solver, [])
            axes.add_line(line_of(style, [number for number, _ in curve], [ratio for _, ratio in curve],
                                         zorder=10 + len(styles) - order))
        axes.set_title(shorten(clean(scene), MAIN_WIDTH, 9), loc="left")
        if column == 0:
            axes.set_ylabel("time over that of the first result")
        grid(axes)
    add_legend(axes, styles, anchor=(1.03, 1.0))
    return sheet.figure


def scales(axes: Axes, entries: list[Entry], low: float, top: float) -> None:
    """Results side by side whatever time lies between them; ratios on a log axis, so that half and double look alike."""
    axes.set_xlim(-0.5, max(1, len(entries) - 1) + 0.5)
    shown = range(0, len(entries), max(1, math.ceil(len(entries) / 12)))
    axes.xaxis.set_major_locator(FixedLocator(list(shown)))
    labels = {number: f"{entries[number].date:%Y-%m-%d}\n{entries[number].commit}" for number in shown}
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: labels.get(round(x), "")))
    for label in axes.get_xticklabels():
        label.set(rotation=40, ha="right", rotation_mode="anchor", fontsize=7)
    axes.set_yscale("log")
    axes.set_ylim(min(low / 1.1, 0.8), max(top * 1.1, 1.25))
    wide = top / low > 8
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)) if wide else FixedLocator([0.2, 0.25, 0.33, 0.5, 0.67, 0.8, 0.9, 1, 1.1,
                                                                                      1.25, 1.5, 2, 3, 4, 5]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.axhline(1, color=GREY, linewidth=0.8, zorder=1)
