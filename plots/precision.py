"""The figures of a step sweep: time against error, error over step, and the residual of fast projection."""

from __future__ import annotations

import math
from typing import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

import caption
import panels
from results import Json, Run, RunsData, cheapest
from sheet import (GAP, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, TIME_LABEL, Sheet, add_legend, add_strip,
                   grid, make_sheet)
from style import BLUE, GREY, SKY, SolverStyle, styles_for

Draw = Callable[[RunsData, Json], Figure]
TARGETS = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
LADDER_ENDED = "L"
FRONT = "#FFE08A"
ERROR_LABEL = "trajectory error over the scene's size"
LOOSE = 0.01  # strain limit at which slack is shown


def figures_of(data: RunsData) -> list[tuple[str, Draw]]:
    """Names and drawing functions of the figures that the data suffice for."""
    scene = "".join(c if c.isalnum() or c in "-_" else "_" for c in data.scene) + data.suffix
    figures: list[tuple[str, Draw]] = []
    if any(data.runs.values()):
        figures += [(f"work-precision-{scene}", draw_work_precision), (f"slack-{scene}", draw_slack)]
    if any(len(by_step) > 1 for by_step in data.residuals.values()):
        figures.append((f"residual-{scene}", draw_residual))
    return figures


# ---- time against error ---------------------------------------------------------------------------------------------

def draw_work_precision(data: RunsData, document: Json) -> Figure:
    """One curve a solver through its cheapest runs at any step and limit; all others as dots; the front underneath."""
    styles = _styles(data)
    rows = _missed_targets(data, styles)
    words = [caption.scene_sentence(data.scene, f"{data.vertices:,} vertices", data.points) + _validity(data),
             "Every run that kept its strain limit, at any step and limit, is a dot. A curve joins the runs of a solver that "
             "none of its others beats in both time and error; the yellow band is the front of all solvers. Hollow: error "
             "below three times the reference's own uncertainty.",
             _key_of(rows), _timing(document), caption.origin_sentence(document)]
    sheet = make_sheet(f"{data.scene}: time against error", caption.warnings_of(document), [w for w in words if w],
                       LEFT + 1.25 * MAIN_WIDTH + LEGEND_WIDTH, 1.25 * MAIN_HEIGHT + ROW_HEIGHT * len(rows))
    axes = sheet.axes(LEFT, sheet.bottom, 1.25 * MAIN_WIDTH, 1.25 * MAIN_HEIGHT)
    runs = [run for solver in styles for run in data.runs.get(solver, [])]
    _log_log(axes, [run.error for run in runs], [run.seconds for run in runs])
    axes.set_xlabel(ERROR_LABEL)
    axes.set_ylabel(TIME_LABEL)
    front = cheapest(runs)
    axes.plot([run.error for run in front], [run.seconds for run in front], color=FRONT, linewidth=9, alpha=0.8,
              solid_capstyle="round", solid_joinstyle="round", zorder=2)
    for order, (solver, style) in enumerate(styles.items()):
        _draw_solver(axes, data.runs.get(solver, []), style, 10 + len(styles) - order)
    grid(axes)
    add_strip(sheet, axes, rows, styles, "error not reached")
    add_legend(axes, styles, anchor=(1.03, 1.0), columns=1)
    return sheet.figure


def _draw_solver(axes: Axes, runs: list[Run], style: SolverStyle, z: int) -> None:
    axes.plot([run.error for run in runs], [run.seconds for run in runs], linestyle="none", marker=".", markersize=2.5,
              color=style.color, alpha=0.5, zorder=4)
    curve = cheapest(runs)
    line = panels.line_of(style, [run.error for run in curve], [run.seconds for run in curve], zorder=z)
    line.set_markevery([number for number, run in enumerate(curve) if run.sure])
    axes.add_line(line)
    unsure = [run for run in curve if not run.sure]
    hollow = panels.line_of(style, [run.error for run in unsure], [run.seconds for run in unsure], zorder=z)
    hollow.set(linestyle="none", markerfacecolor="white", markeredgecolor=style.color, markeredgewidth=1)
    axes.add_line(hollow)


def _missed_targets(data: RunsData, styles: dict[str, SolverStyle]) -> panels.Rows:
    """The error targets that some solver reached and this one did not, with what became of its finer steps."""
    errors = [run.error for runs in data.runs.values() for run in runs]
    shown = [target for target in TARGETS if min(errors) <= target <= max(errors)]
    rows: panels.Rows = {}
    for solver in styles:
        closest = min(data.runs.get(solver, []), key=lambda run: run.error, default=None)
        letters = _letters([failure for failure in data.failures.get(solver, []) if not closest or failure[0] < closest.step])
        marks = [panels.Mark(target, letters) for target in sorted(shown) if not closest or target < closest.error]
        if marks:
            rows[solver] = marks
    return rows


def _letters(failures: list[tuple[float, float, str]]) -> str:
    letters = ""
    for _, _, letter in sorted(failures, reverse=True):
        letters += "" if letter in letters else letter
    return letters or LADDER_ENDED


def _key_of(rows: panels.Rows) -> str:
    used = {letter for marks in rows.values() for mark in marks for letter in mark.text}
    if not used:
        return ""
    meanings = {**caption.MEANINGS, LADDER_ENDED: "the ladder ended"}
    return ("A mark above the axes: no run of the solver reached this error; letters say what became of steps finer than its best: "
            + ", ".join(f"{letter} = {meanings[letter]}" for letter in meanings if letter in used) + ".")


# ---- error over step ------------------------------------------------------------------------------------------------

def draw_slack(data: RunsData, document: Json) -> Figure:
    """Error over step at a loose limit and at the tightest one: where slack within the limit spoils the order."""
    styles = _styles(data)
    limits = sorted({run.limit for runs in data.runs.values() for run in runs})
    tight, loose = limits[0], min(limits, key=lambda limit: abs(math.log(limit / LOOSE)))
    shown = [loose] if tight == loose else [loose, tight]
    rows = _failed_steps(data, styles, shown)
    words = [caption.scene_sentence(data.scene, f"{data.vertices:,} vertices", data.points) + _validity(data),
             "Error of every run over its step. An order of convergence is a slope (dotted: 1 and 2); where edges may be "
             "slack within a loose limit, the limit and not the step decides, and smaller steps do not help or even harm.",
             _key_of_failures(rows), caption.origin_sentence(document)]
    width = LEFT + len(shown) * MAIN_WIDTH + (len(shown) - 1) * 0.4 + LEGEND_WIDTH
    sheet = make_sheet(f"{data.scene}: error over step", caption.warnings_of(document), [w for w in words if w], width,
                       MAIN_HEIGHT + ROW_HEIGHT * len(rows[0]) + 0.15)
    runs = [run for solver in styles for run in data.runs.get(solver, [])]
    tried = [step for steps in data.failures.values() for step, _, _ in steps] + [run.step for run in runs]
    for number, limit in enumerate(shown):
        axes = sheet.axes(LEFT + number * (MAIN_WIDTH + 0.4), sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT)
        _log_log(axes, tried, [run.error for run in runs])
        _step_axis(axes, tried)
        _guides(axes)
        for order, (solver, style) in enumerate(styles.items()):
            path = sorted((run for run in data.runs.get(solver, []) if run.limit == limit), key=lambda run: run.step)
            axes.add_line(panels.line_of(style, [run.step for run in path], [run.error for run in path],
                                         zorder=10 + len(styles) - order))
        axes.set_xlabel(f"time step (s), strain limit {caption.percent(limit)}")
        if number == 0:
            axes.set_ylabel(ERROR_LABEL)
        else:
            axes.tick_params(axis="y", labelleft=False)
        grid(axes)
        add_strip(sheet, axes, rows[number], styles, "steps that failed", names=number == 0)
    add_legend(axes, styles, anchor=(1.03, 1.0), columns=1)
    return sheet.figure


def _failed_steps(data: RunsData, styles: dict[str, SolverStyle], limits: list[float]) -> list[panels.Rows]:
    """For each limit the same rows: of every solver that fails at one of them."""
    failures = {solver: [f for f in data.failures.get(solver, []) if f[1] in limits] for solver in styles}
    return [{solver: [panels.Mark(step, letter) for step, at, letter in sorted(failed) if at == limit]
             for solver, failed in failures.items() if failed} for limit in limits]


def _key_of_failures(rows: list[panels.Rows]) -> str:
    used = {letter for row in rows for marks in row.values() for mark in marks for letter in mark.text}
    return ", ".join(f"{letter} = {caption.MEANINGS[letter]}" for letter in caption.MEANINGS if letter in used)


# ---- residual of fast projection --------------------------------------------------------------------------------------

def draw_residual(data: RunsData, document: Json) -> Figure:
    """Mean |F| of what fast projection gives up, over time and over the step (Figure 3 of the paper)."""
    limit = min(limit for limit, by_step in data.residuals.items() if len(by_step) > 1)
    by_step = data.residuals[limit]
    words = [caption.scene_sentence(data.scene, f"{data.vertices:,} vertices", data.points),
             f"Fast projection, permissible strain {caption.percent(limit)}: what is left of the implicit constraint "
             "direction's equation F = 0 (equation 8 of the paper, in metres, mean over the vertices), after the first "
             "iteration of a step and after the last, for samples in which a step needed an iteration at all. Right: mean "
             "over those samples; the lines are fitted over all steps shown (bench claims: with confidence interval).",
             caption.origin_sentence(document)]
    sheet = make_sheet(f"{data.scene}: residual of fast projection", caption.warnings_of(document), words,
                       LEFT + 2 * MAIN_WIDTH + GAP + 1.6, MAIN_HEIGHT)
    left = sheet.axes(LEFT, sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT)
    right = sheet.axes(LEFT + MAIN_WIDTH + GAP, sheet.bottom, MAIN_WIDTH, MAIN_HEIGHT)
    _draw_residual_over_time(left, by_step)
    _draw_residual_over_step(right, by_step)
    for axes in (left, right):
        grid(axes)
    return sheet.figure


def _draw_residual_over_time(axes: Axes, by_step: dict[float, list[list[float]]]) -> None:
    steps = sorted(by_step, reverse=True)
    axes.set_yscale("log")
    for step, color in zip((steps[0], steps[len(steps) // 2]), (BLUE, SKY)):
        time, first, last = (list(column) for column in zip(*by_step[step]))
        axes.plot(time, first, color=color, linewidth=1, linestyle=(0, (3, 1.5)), label=f"first iteration, h = {_step(step)} s")
        axes.plot(time, last, color=color, linewidth=1.4, label=f"last iteration, h = {_step(step)} s")
    axes.set_xlabel("time (s)")
    axes.set_ylabel("mean |F| (m)")
    axes.yaxis.set_major_locator(LogLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:.0e}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.legend(frameon=False, fontsize=7.5, loc="lower right")


def _draw_residual_over_step(axes: Axes, by_step: dict[float, list[list[float]]]) -> None:
    steps = sorted(by_step)
    first = [_mean([row[1] for row in by_step[step]]) for step in steps]
    last = [_mean([row[2] for row in by_step[step]]) for step in steps]
    _log_log(axes, steps, [value for value in first + last if value > 0])
    _step_axis(axes, steps)
    for values, marker, dashes, name in ((first, "o", (3, 1.5), "first iteration"), (last, "s", (), "last iteration")):
        pairs = [(step, value) for step, value in zip(steps, values) if value > 0]
        slope, offset = np.polyfit(*np.log(np.array(pairs)).T, 1) if len(pairs) > 1 else (math.nan, math.nan)
        x = np.array([step for step, _ in pairs])
        axes.plot(x, [value for _, value in pairs], marker, color=BLUE, markersize=5, label=f"{name}: slope {slope:.2f}",
                  markerfacecolor=BLUE if not dashes else "white")
        axes.plot(x, np.exp(offset) * x**slope, color=GREY, linewidth=0.8, linestyle=(0, dashes) if dashes else "-")
    axes.set_xlabel("time step (s)")
    axes.legend(frameon=False, fontsize=8, loc="upper left")


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


# ---- shared -----------------------------------------------------------------------------------------------------------

def _styles(data: RunsData) -> dict[str, SolverStyle]:
    """Solvers that compete; the others have no error to show."""
    styles = styles_for({*data.runs, *data.failures})
    return {solver: style for solver, style in styles.items() if style.contestant}


def _validity(data: RunsData) -> str:
    until = {p["error"].get("valid_until") for p in data.points if p["status"] == "ok" and isinstance(p.get("error"), dict)}
    known = sorted(u for u in until if u)
    return f" Errors up to t = {known[0]:g} s, as far as the reference can be trusted." if known else ""


def _timing(document: Json) -> str:
    suite = document.get("context", {}).get("suite", {})
    return (f"Median of {suite.get('reps', 1)} runs a point; profile {caption.plain(suite.get('profile', '?'))}; "
            f"timeout {suite.get('timeout', 0):g} s.")


def _log_log(axes: Axes, xs: list[float], ys: list[float]) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(min(xs) / 1.5, max(xs) * 1.5)
    axes.set_ylim(min(ys) / 1.5, max(ys) * 1.5)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator())
        axis.set_minor_locator(LogLocator(subs=range(2, 10)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())


def _step_axis(axes: Axes, steps: list[float]) -> None:
    ladder: list[float] = []
    for step in sorted(set(steps), reverse=True):
        if not ladder or step < 0.95 * ladder[-1]:
            ladder.append(step)
    stride = max(1, math.ceil(len(ladder) / 6))
    axes.xaxis.set_major_locator(FixedLocator(ladder[::stride]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda step, _: _step(step)))


def _step(step: float) -> str:
    return f"1/{1 / step:.6g}" if step < 1 else f"{step:g}"


def _guides(axes: Axes) -> None:
    """Slopes 1 and 2 through the upper right corner."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    for power in (1, 2):
        end = max(left, right * (low / high) ** (1 / power))
        axes.plot([end, right], [high * (end / right) ** power, high], color=GREY, linewidth=0.6, linestyle=(0, (1, 3)),
                  zorder=1)
