"""Time against error: one curve a solver through its cheapest runs at any step and limit, the front of all underneath. The complete figure
has every solver, and its other runs as dots."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.axes import grid, log_log
from parts.result import Figures, Result
from parts.runs import Run, StepSweep, cheapest, step_sweeps_in
from parts.sheet import (LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, NARROW, TIME_LABEL, add_legend, legend_height, make_sheet, noise_words,
                         sampling, scene_sentence, settings_of_the_run)
from parts.style import SolverStyle, line_of, receding_sentences, styles_for
from parts.words import percent, short, subject

FRONT = "#FFE08A"
WIDTH, HEIGHT = 1.25 * MAIN_WIDTH, 1.25 * MAIN_HEIGHT


def figures_of(result: Result, every: bool = False) -> Figures:
    return [(f"work-precision-{sweep.name}" + ("-all" if complete else ""), draw, sweep, result, complete)
            for sweep in step_sweeps_in(result) if any(sweep.runs.values()) for complete in (False, True)[:1 + every]]


def draw(sweep: StepSweep, result: Result, complete: bool = False) -> Figure:
    level, front = result.analysis["headline_error"], cheapest([run for own in sweep.runs.values() for run in own])
    right = {solver: min(times) for solver, own in sweep.runs.items() if (times := [run.seconds for run in own if run.error <= level])}
    styles = styles_for(sweep.runs if complete else result.few(sweep.runs, right), result,
                        result.leaders(sweep.scene, "step") if complete else None)
    missed = "; ".join(short(style.label) for solver, style in styles.items() if solver not in right)
    caption = [f"{sweep.vertices:,.0f} vertices; {sampling(result)}. A curve joins a method's runs, at any step and strain limit, that none of its "
               "others beats in both time and error. Yellow: the front of all methods. Hollow: error below three times the reference's own "
               "uncertainty." + noise_words(result)]
    if complete:
        caption = [*caption, scene_sentence(sweep.scene, sweep.points) + _validity(sweep),
                   "; ".join(["Dots: all runs that kept their strain limit, with tuned or untuned settings", *settings_of_the_run(result)]) + ".",
                   *receding_sentences(styles.values())]
    sheet = make_sheet(result, result.headline(subject(sweep.scene), sweep.scene, "step", sweep.vertices), caption,
                       NARROW + WIDTH + LEGEND_WIDTH, HEIGHT, legend_height(styles) - HEIGHT,
                       f"No run with an error of at most {percent(level)}: {missed}." if missed else
                       f"Each of these methods has a run with an error of at most {percent(level)}.")
    axes = sheet.axes(NARROW, sheet.bottom, WIDTH, HEIGHT)
    shown = front + [run for solver in styles for run in sweep.runs.get(solver, []) if complete or run in cheapest(sweep.runs[solver])]
    log_log(axes, [run.error for run in shown], [run.seconds for run in shown])
    axes.set(xlabel="trajectory error over the scene's size", ylabel=TIME_LABEL)
    axes.plot(*_xy(front), color=FRONT, linewidth=7, solid_capstyle="round", solid_joinstyle="round", zorder=1.5)
    for order, (solver, style) in enumerate(styles.items()):
        own = sweep.runs.get(solver, [])
        if complete:
            axes.plot(*_xy(own), linestyle="none", marker=".", markersize=2.5, color=style.color, alpha=0.5, zorder=4)
        _draw_solver(axes, own, style, 10 + len(styles) - order if style.leads else 3)
    grid(axes)
    add_legend(axes, styles, {solver: (run.error, run.seconds) for solver, own in sweep.runs.items() for run in cheapest(own)[-1:]})
    return sheet.figure


def _xy(runs: list[Run]) -> tuple[list[float], list[float]]:
    return [run.error for run in runs], [run.seconds for run in runs]


def _draw_solver(axes: Axes, runs: list[Run], style: SolverStyle, z: int) -> None:
    curve = cheapest(runs)
    line = line_of(style, *_xy(curve), zorder=z)
    line.set_markevery([number for number, run in enumerate(curve) if run.sure])
    axes.add_line(line)
    hollow = line_of(style, *_xy([run for run in curve if not run.sure]), zorder=z)
    hollow.set(linestyle="none", markerfacecolor="white", markeredgecolor=style.color, markeredgewidth=1)
    axes.add_line(hollow)


def _validity(sweep: StepSweep) -> str:
    known = [until for point in sweep.points if point["status"] == "ok"
             if (until := point["error"].get("error_until") or point["error"].get("valid_until"))]
    return f" Errors up to t = {max(known):g} s, as far as the reference can be trusted." if known else ""
