"""What a simulated second costs over the strain limit or the resolution (the paper's Figures 4 and 5), of any motion and, where errors
are known, beside it of motion that is right: of a few methods, whose names stand at their curves. The complete figure has all, and
beneath it the best steps and, where a collider takes part, the filter's own time. The paper's axes are linear; with methods that
differ a hundredfold such axes show the slowest alone."""

import math
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.axes import grid, log_x, log_y
from parts.curves import Curves, Rows, add_strip, all_best, curves_in, draw_curves, draw_steps, ends_of, failed_rows, label_ends, letters_in
from parts.result import Figures, Json, Result
from parts.sheet import (BETWEEN, END_WIDTH, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, NARROW, ROW_HEIGHT, STEPS_HEIGHT, TIME_LABEL,
                         Sheet, add_legend, legend_height, make_sheet, noise_words, sampling, scene_sentence, settings_of_the_run)
from parts.style import Styles, receding_sentences, styles_for
from parts.words import file_part, percent, scene_words, short, subject

NUMBERS_OF_THE_PAPER = {("chain", "strain"): "4a", ("chain", "resolution"): "4b", ("drape", "strain"): "5a", ("drape", "resolution"): "5b"}
HEADING = 0.22  # inches, above two columns
BESIDE = 2.85  # inches, width of a panel beside another


def figures_of(result: Result, every: bool = False) -> Figures:
    curves = result.analysis.get("curves", [])
    return [(_name(figure, curves) + ("-all" if complete else ""), draw, figure, result, complete)
            for figure in curves for complete in (False, True)[:1 + every]]


def _name(figure: Json, all_figures: list[Json]) -> str:
    """"figure4a" for the scenes of the paper, "<scene>-<sweep>" for others; the fixed value only where two would clash."""
    number = NUMBERS_OF_THE_PAPER.get((figure["scene"], figure["sweep"]))
    name = f"figure{number}" if number else f"{file_part(scene_words(figure['scene']))}-{figure['sweep']}"
    if sum(all(other[key] == figure[key] for key in ("scene", "sweep")) for other in all_figures) > 1:
        name += f"-{'n' if figure['sweep'] == 'strain' else 'strain'}{figure['fixed']:g}"
    return name


class Column(NamedTuple):
    curves: Curves
    filter: Curves  # {}: no panel
    rows: Rows
    heading: str


def draw(figure: Json, result: Result, complete: bool = False) -> Figure:
    scene, sweep = figure["scene"], figure["sweep"]
    panels = {panel: {time: curves_in(figure[panel] or {}, result, 100 if sweep == "strain" else 1, time) for time in ("time", "filter")}
              for panel in ("any", "within")}
    names = list(panels["any"]["time"])
    if not complete:
        names = result.few(names, _headline_times(panels["within"]["time"], sweep) or _headline_times(panels["any"]["time"], sweep))
    styles = styles_for(names, result, result.leaders(scene, sweep) if complete else None)
    fixed = "vertices" if sweep == "strain" else "strain_limit"
    points = [point for point in result.points if (point["scene"], point["sweep"], point[fixed]) == (scene, sweep, figure["fixed"])]
    columns = _columns(panels, points if complete else [], styles, percent(result.analysis["headline_error"]))
    strip = ROW_HEIGHT * max(len(column.rows) for column in columns) if complete else 0
    beneath = (STEPS_HEIGHT + BETWEEN) * (2 if columns[0].filter else 1) if complete else 0
    left, between, right = (LEFT, LEFT, LEGEND_WIDTH) if complete else (NARROW, END_WIDTH + 0.45, END_WIDTH)
    width = MAIN_WIDTH if complete or len(columns) == 1 else BESIDE
    number, vertices = NUMBERS_OF_THE_PAPER.get((scene, sweep)), figure["fixed"] if sweep == "strain" else None
    caption = _complete_caption(figure, points, result, columns, styles) if complete else [_caption(figure, points, result)]
    sheet = make_sheet(result, result.headline((f"Figure {number}, " if number else "") + subject(scene), scene, sweep, vertices), caption,
                       left + len(columns) * width + (len(columns) - 1) * between + right,
                       beneath + MAIN_HEIGHT + strip + (HEADING if len(columns) > 1 else 0),
                       legend_height(styles) - beneath - MAIN_HEIGHT if complete else 0, _failures(columns, styles, sweep))
    mains = [_draw_column(sheet, column, styles, sweep, left + place * (width + between), width, beneath)
             for place, column in enumerate(columns)]
    low, high = min(main.get_ylim()[0] for main in mains), max(main.get_ylim()[1] for main in mains)
    for column, main in zip(columns, mains):
        main.set_ylim(low, high)  # the same scale, so that both columns compare
        if complete:
            add_strip(sheet, main, column.rows, styles)
        else:
            label_ends(main, column.curves, styles)
        box = main.get_position()
        if len(columns) > 1:
            sheet.figure.text(box.x0, box.y1 + (strip + (0.17 if complete else 0.06)) / sheet.height, column.heading, fontsize=9,
                              fontweight="bold", va="bottom")
    mains[0].set_ylabel(TIME_LABEL)
    if complete:
        add_legend(mains[-1], styles, ends_of(columns[-1].curves))
    return sheet.figure


def _headline_times(curves: Curves, sweep: str) -> dict[str, float]:
    """Each solver's time at the largest size, or at the limit that is closest to 1 %."""
    xs = [best.x for best in all_best(curves)]
    x = max(xs, key=lambda x: x if sweep == "resolution" else -abs(math.log(x)), default=None)
    return {name: best.seconds for name, curve in curves.items() for best in curve.best if best.x == x}


def _columns(panels: dict[str, dict[str, Curves]], points: list[Json], styles: Styles, level: str) -> list[Column]:
    """Any motion, and motion that is right where it is known of some run; points: those that ask for a panel of the filter's time."""
    collides = any(point["max_strain_after_collision"] is not None for point in points)
    columns = []
    for panel, heading in (("any", "Any motion: the paper's question"), ("within", f"Motion error at most {level}")):
        curves, of_filter = ({name: curve for name, curve in panels[panel][time].items() if name in styles} for time in ("time", "filter"))
        if panel == "any" or all_best(curves):
            columns.append(Column(curves, of_filter if collides and all_best(of_filter) else {}, failed_rows(curves, styles), heading))
    return columns


def _draw_column(sheet: Sheet, column: Column, styles: Styles, sweep: str, left: float, width: float, beneath: float) -> Axes:
    """Returns the main panel, which is alone where nothing is beneath it."""
    main = sheet.axes(left, sheet.bottom + beneath, width, MAIN_HEIGHT)
    log_x(main, [b.x for b in all_best(column.curves)] + [x for curve in column.curves.values() for x, _ in curve.failures], width)
    panels = [(main, column.curves)]
    if column.filter:
        panels.append((sheet.axes(left, sheet.bottom + STEPS_HEIGHT + BETWEEN, width, STEPS_HEIGHT, sharex=main), column.filter))
        panels[-1][0].set_ylabel("filter alone (s)")
    for axes, curves in panels:
        log_y(axes, [best.seconds for best in all_best(curves)])
        draw_curves(axes, curves, styles, stairs=sweep == "strain")
        axes.tick_params(axis="x", which="both", labelbottom=not beneath)
        grid(axes)
    lowest = main
    if beneath:
        lowest = sheet.axes(left, sheet.bottom, width, STEPS_HEIGHT, sharex=main)
        draw_steps(lowest, column.curves, styles)
        lowest.set_ylabel("best time step (s)")
        grid(lowest)
    lowest.set_xlabel("strain limit (%)" if sweep == "strain" else "vertices")
    return main


def _failures(columns: list[Column], styles: Styles, sweep: str) -> str:
    """One sentence. Who fails at a limit fails at each tighter one, for a run at that would count."""
    def items(rows: Rows) -> list[str]:
        return [f"{short(styles[name].label)} ({marks[-1][0]:g} %{' and less' if len(marks) > 1 else ''})" if sweep == "strain" else
                f"{short(styles[name].label)} ({', '.join(f'{x:,g}' for x, _ in marks)})" for name, marks in rows.items()]

    failed = items(columns[0].rows)
    wrong = items({name: marks for name, marks in columns[-1].rows.items() if dict(marks).keys() != dict(columns[0].rows.get(name, [])).keys()})
    if not failed + wrong:
        return f"Each of these methods has a run that counts at every {'limit' if sweep == 'strain' else 'size'}."
    return "Missing " + "; ".join(f"{why}: {'; '.join(of)}" for why, of in (
        ("because every step tried failed or was stopped as far too slow", failed), ("on the right for too large an error", wrong)) if of) + "."


def _caption(figure: Json, points: list[Json], result: Result) -> str:
    """The short one, which the complete figure continues."""
    counts = " A run at a tighter limit also counts at a looser one." if figure["sweep"] == "strain" else ""
    sizes = sorted({point["vertices"] for point in points})
    size = " to ".join(f"{size:,.0f}" for size in dict.fromkeys((sizes[0], sizes[-1]))) + " vertices"
    size += f", strain limit {percent(figure['fixed'])}" if figure["sweep"] == "resolution" else ""
    return f"{size}; {sampling(result)}, each method at its fastest step.{counts}{noise_words(result)}"


def _complete_caption(figure: Json, points: list[Json], result: Result, columns: list[Column], styles: Styles) -> list[str]:
    arrows = any(b.ladder_end for column in columns for b in all_best(column.curves))
    letters = {letter for column in columns for letter in letters_in(column.rows)}
    failures = ("A mark above the axes: no step tried gave a run that counts there, nor at a tighter limit; the letters say why, from the "
                f"coarsest step to the finest: {result.key(letters)}.")
    return [_caption(figure, points, result) + (" Arrow at a step: it is the coarsest (up) or the finest (down) that was tried, a better one may "
                                                "lie beyond." if arrows else ""), *([failures] if letters else []),
            *receding_sentences(styles.values()), scene_sentence(figure["scene"], points), "; ".join(settings_of_the_run(result)) + "."]
