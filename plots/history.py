#!/usr/bin/python3
"""Draws how the times of each solver's best points have changed over the result files of a folder, in the order of their
dates: one panel a scene, one line a solver.

    plots/history.py results/nightly [--out history.svg]

A solver's figure changes from one result to the next by the geometric mean of the ratios of median times, over the points
that both have: points of a millisecond and of a second count alike, and a result that ran fewer points does not look faster.
A dashed line: another machine or build from here on, so that a jump says nothing.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

sys.dont_write_bytecode = True  # a look at a result must not leave files in the source tree

try:
    import matplotlib
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
except ImportError:
    print("history.py: matplotlib is missing (Debian: apt-get install python3-matplotlib)", file=sys.stderr)
    sys.exit(2)

import panels
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator
from results import SCHEMA, Json, ResultError, load, median_of
from sheet import GAP, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, add_legend, grid, make_sheet, save
from style import GREY, RC, styles_for

Place = tuple[str, str, int, float]  # sweep, scene, vertices, strain limit: where on an axis a best point lies


@dataclass(frozen=True)
class Entry:
    """One result file: when, with what, and the median seconds of each solver's best points."""

    date: datetime
    commit: str
    machine: tuple[str, str]  # processor, compiler with flags
    times: dict[str, dict[Place, float]]


def entry_of(document: Json, path: Path) -> Entry:
    context = document.get("context")
    context = context if isinstance(context, dict) else {}
    build = context.get("build") if isinstance(context.get("build"), dict) else {}
    try:
        date = datetime.fromisoformat(str(context.get("date")))
    except ValueError as error:
        raise ResultError(f"{path}: context.date is {context.get('date')!r}, no date") from error
    times: dict[str, dict[Place, float]] = {}
    for point in document["points"]:
        median = median_of(point)
        if point.get("best") is True and median is not None:
            place = (str(point.get("sweep")), point["scene"], point["vertices"], float(point["strain_limit"]))
            times.setdefault(point["solver"], {})[place] = median
    machine = (str(context.get("cpu_model")), f"{build.get('compiler')} {build.get('flags')}")
    return Entry(date.astimezone(), str(build.get("git", ""))[:7], machine, times)


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
    styles = styles_for({solver for scene in scenes for solver in curves[scene]})
    changed = [number for number in range(1, len(entries)) if entries[number].machine != entries[number - 1].machine]
    words = ["Time of each solver's best points over that of the first result: from result to result the geometric mean over "
             "the points that both have. Best steps may differ between results. Each result was measured on its own, so "
             "differences below a few tens of per cent may be the machine's; bench ab compares two builds fairly."]
    if changed:
        words.append("Dashed: from here on another machine, compiler or flags; a jump there says nothing about the code.")
    width = LEFT + len(scenes) * MAIN_WIDTH + (len(scenes) - 1) * GAP + LEGEND_WIDTH
    sheet = make_sheet("Times over results", [], words, width, MAIN_HEIGHT + 0.55)  # room for slanted dates
    top = max(ratio for scene in scenes for curve in curves[scene].values() for _, ratio in curve)
    low = min(ratio for scene in scenes for curve in curves[scene].values() for _, ratio in curve)
    for column, scene in enumerate(scenes):
        axes = sheet.axes(LEFT + column * (MAIN_WIDTH + GAP), sheet.bottom + 0.55, MAIN_WIDTH, MAIN_HEIGHT)
        scales(axes, entries, low, top)
        for number in changed:
            axes.axvline(number - 0.5, color=GREY, linewidth=0.8, dashes=(3, 3), zorder=1)
        for order, (solver, style) in enumerate(styles.items()):
            curve = curves[scene].get(solver, [])
            axes.add_line(panels.line_of(style, [number for number, _ in curve], [ratio for _, ratio in curve],
                                         zorder=10 + len(styles) - order))
        axes.set_title(scene, loc="left")
        if column == 0:
            axes.set_ylabel("time over that of the first result")
        grid(axes)
    add_legend(axes, styles, anchor=(1.03, 1.0), columns=1)
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


def run(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="history.py", description="Draws times over the result files of a folder.")
    parser.add_argument("folder", type=Path, help="folder with result files of the bench program (JSON)")
    parser.add_argument("--out", type=Path, help="the figure, .svg or .png (default: history.svg in the folder)")
    options = parser.parse_args(arguments)
    out = options.out or options.folder / "history.svg"
    if out.suffix not in (".svg", ".png"):
        raise ResultError(f"{out}: the figure's name must end in .svg or .png")
    entries = entries_in(options.folder)
    with matplotlib.rc_context(RC):
        save(draw(entries), out)
    print(out, flush=True)


def main() -> int:
    try:
        run(sys.argv[1:])
    except ResultError as error:
        print(f"history.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
