"""Time against error: one curve a solver through its cheapest runs at any step and limit, others as dots, the front of all underneath."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.axes import grid, log_log
from parts.curves import Rows, add_strip, draw_noise, letters_in
from parts.result import Figures, Result
from parts.runs import Run, StepSweep, cheapest, step_sweeps_in
from parts.sheet import (LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, TIME_LABEL, add_legend, legend_height, make_sheet,
                         scene_sentence, settings_of_the_run)
from parts.style import SolverStyle, Styles, line_of, receding_sentences
from parts.words import plain, scene_words

TARGETS = (1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1)
LADDER_ENDED = "L"
FRONT = "#FFE08A"
WIDTH, HEIGHT = 1.25 * MAIN_WIDTH, 1.25 * MAIN_HEIGHT


def figures_of(result: Result) -> Figures:
    return [(f"work-precision-{sweep.name}", draw, sweep, result) for sweep in step_sweeps_in(result) if any(sweep.runs.values())]


def draw(sweep: StepSweep, result: Result) -> Figure:
    styles = sweep.styles(result, result.leaders(sweep.scene, "step"))
    runs = [run for own in sweep.runs.values() for run in own]
    rows = _missed_targets(sweep, styles, runs)
    caption = [scene_sentence(sweep.scene, f"{sweep.vertices:,.0f} vertices", sweep.points) + _validity(sweep),
               "Every run that kept its strain limit, at any step and limit, with tuned or untuned settings, is a dot. A curve joins the runs "
               "of a solver that none of its others beats in both time and error; the yellow band is the front of all solvers. Hollow: error "
               "below three times the reference's own uncertainty.", *receding_sentences(styles.values())]
    if rows:
        caption.append("A mark above the axes: no run of the solver reached this error; letters say what became of steps finer than its "
                       f"best: {result.key(letters_in(rows))}.")
    timeout, profile, _ = settings_of_the_run(result)
    caption.append("; ".join(filter(None, [f"Least of {plain(result.suite.get('reps', 1))} samples or more a point", profile, timeout])) + ".")
    sheet = make_sheet(result, f"{scene_words(sweep.scene)}: time against error", caption, LEFT + WIDTH + LEGEND_WIDTH,
                       HEIGHT + ROW_HEIGHT * len(rows), legend_height(styles) - HEIGHT,
                       " ".join(result.finding(sweep.scene, "step", sweep.vertices)[:1]))
    axes = sheet.axes(LEFT, sheet.bottom, WIDTH, HEIGHT)
    log_log(axes, [run.error for run in runs], [run.seconds for run in runs])
    axes.set(xlabel="trajectory error over the scene's size", ylabel=TIME_LABEL)
    axes.plot(*_xy(cheapest(runs)), color=FRONT, linewidth=9, alpha=0.8, solid_capstyle="round", solid_joinstyle="round", zorder=2)
    for order, (solver, style) in enumerate(styles.items()):
        _draw_solver(axes, sweep.runs.get(solver, []), style, 10 + len(styles) - order if style.leads else 3)
    draw_noise(axes, result.noise_factor)
    grid(axes)
    add_strip(sheet, axes, rows, styles, "error not reached")
    ends = {solver: cheapest(own)[-1] for solver, own in sweep.runs.items() if own}
    add_legend(axes, styles, {solver: (run.error, run.seconds) for solver, run in ends.items()})
    return sheet.figure


def _xy(runs: list[Run]) -> tuple[list[float], list[float]]:
    return [run.error for run in runs], [run.seconds for run in runs]


def _draw_solver(axes: Axes, runs: list[Run], style: SolverStyle, z: int) -> None:
    axes.plot(*_xy(runs), linestyle="none", marker=".", markersize=2.5, color=style.color, alpha=0.5, zorder=4)
    curve = cheapest(runs)
    line = line_of(style, *_xy(curve), zorder=z)
    line.set_markevery([number for number, run in enumerate(curve) if run.sure])
    axes.add_line(line)
    hollow = line_of(style, *_xy([run for run in curve if not run.sure]), zorder=z)
    hollow.set(linestyle="none", markerfacecolor="white", markeredgecolor=style.color, markeredgewidth=1)
    axes.add_line(hollow)


def _validity(sweep: StepSweep) -> str:
    errors = [point["error"] for point in sweep.points if point["status"] == "ok"]
    if sure := [error["error_until"] for error in errors if error.get("error_until")]:
        return (" Errors over the sample times at which they are more than three times the reference's own uncertainty, up to "
                f"t = {max(sure):g} s.")
    known = [error["valid_until"] for error in errors if error.get("valid_until")]
    return f" Errors up to t = {min(known):g} s, as far as the reference can be trusted." if known else ""


def _missed_targets(sweep: StepSweep, styles: Styles, runs: list[Run]) -> Rows:
    """The error targets that some solver reached and this one did not, with what became of its finer steps."""
    errors = [run.error for run in runs]
    rows: Rows = {}
    for solver in (name for name, style in styles.items() if style.leads):
        closest = min(sweep.runs.get(solver, []), key=lambda run: run.error, default=None)
        failed = sorted(sweep.failures.get(solver, []), key=lambda failure: -failure[0])
        letters = "".join(dict.fromkeys(letter for step, letter in failed if not closest or step < closest.step)) or LADDER_ENDED
        marks = [(target, letters) for target in TARGETS if min(errors) <= target <= max(errors) and (not closest or target < closest.error)]
        if marks:
            rows[solver] = marks
    return rows
