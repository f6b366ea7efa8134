"""What a simulated second costs over the strain limit or the resolution (the paper's Figures 4 and 5), of any motion and, where errors
are known, beside it of motion that is right; beneath it the best steps and, where a collider takes part, the filter's own time. The
paper's axes are linear; with methods that differ a hundredfold such axes show the slowest alone."""

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from parts.axes import draw_slopes, grid, log_x, log_y
from parts.curves import (Curves, Rows, add_strip, all_best, curves_in, draw_curves, draw_noise, draw_steps, ends_of,
                          failed_rows, letters_in)
from parts.result import Figures, Json, Result
from parts.sheet import (BETWEEN, LEFT, LEGEND_WIDTH, MAIN_HEIGHT, MAIN_WIDTH, ROW_HEIGHT, STEPS_HEIGHT, TIME_LABEL, Sheet, add_legend,
                         legend_height, make_sheet, sampling, scene_sentence, settings_of_the_run)
from parts.style import Styles, receding_sentences, styles_for
from parts.words import file_part, percent, scene_words, subject

NUMBERS_OF_THE_PAPER = {("chain", "strain"): "4a", ("chain", "resolution"): "4b", ("drape", "strain"): "5a", ("drape", "resolution"): "5b"}
AXIS_LABELS = {"strain": "strain limit (%)", "resolution": "vertices (dotted: slopes 1 and 2)"}
HEADING = 0.22  # inches, above two columns


def figures_of(result: Result) -> Figures:
    curves = result.analysis.get("curves", [])
    return [(_name(figure, curves), draw, figure, result) for figure in curves]


def _name(figure: Json, all_figures: list[Json]) -> str:
    """"figure4a" for the scenes of the paper, "<scene>-<sweep>" for others; the fixed value only where two would clash."""
    number = NUMBERS_OF_THE_PAPER.get((figure["scene"], figure["sweep"]))
    name = f"figure{number}" if number else f"{file_part(scene_words(figure['scene']))}-{figure['sweep']}"
    if sum(all(other[key] == figure[key] for key in ("scene", "sweep")) for other in all_figures) > 1:
        name += f"-{'n' if figure['sweep'] == 'strain' else 'strain'}{figure['fixed']:g}"
    return name


@dataclass(frozen=True)
class Column:
    curves: Curves
    filter: Curves  # {}: no panel
    rows: Rows
    left: float
    heading: str
    strip: str  # the title of its failures


def draw(figure: Json, result: Result) -> Figure:
    scene, sweep, points = figure["scene"], figure["sweep"], _points(figure, result)
    styles = styles_for(figure["any"], result, result.leaders(scene, sweep))
    columns = _columns(figure, points, styles, percent(result.analysis["headline_error"]))
    number = NUMBERS_OF_THE_PAPER.get((scene, sweep))
    title = f"{subject(scene)}: cost over {'strain limit' if sweep == 'strain' else 'resolution'}"
    found = result.finding(scene, sweep, figure["fixed"] if sweep == "strain" else None)[:1]
    return _draw(figure, result, columns, styles, f"Figure {number} - {title}" if number else title, found)


def _draw(figure: Json, result: Result, columns: list[Column], styles: Styles, title: str, found: list[str]) -> Figure:
    strip = ROW_HEIGHT * max(len(column.rows) for column in columns)
    beneath = (STEPS_HEIGHT + BETWEEN) * (2 if columns[0].filter else 1)
    sheet = make_sheet(result, title, [*receding_sentences(styles.values()), *_caption(figure, _points(figure, result), result, columns)],
                       columns[-1].left + MAIN_WIDTH + LEGEND_WIDTH, beneath + MAIN_HEIGHT + strip + (HEADING if len(columns) > 1 else 0),
                       legend_height(styles) - beneath - MAIN_HEIGHT, " ".join(found))
    mains = [_draw_column(sheet, column, styles, figure, beneath) for column in columns]
    low, high = min(main.get_ylim()[0] for main in mains), max(main.get_ylim()[1] for main in mains)
    for column, main in zip(columns, mains):
        main.set_ylim(low, high)  # the same scale, so that both columns compare
        draw_noise(main, result.noise_factor)
        if figure["sweep"] == "resolution":
            draw_slopes(main)
        add_strip(sheet, main, column.rows, styles, column.strip)
        box = main.get_position()
        if len(columns) > 1:
            sheet.figure.text(box.x0, box.y1 + (strip + 0.17) / sheet.height, column.heading, fontsize=9, fontweight="bold",
                              va="bottom")
    mains[0].set_ylabel(TIME_LABEL)
    add_legend(mains[-1], styles, ends_of(columns[-1].curves))
    return sheet.figure


def _points(figure: Json, result: Result) -> list[Json]:
    fixed = "vertices" if figure["sweep"] == "strain" else "strain_limit"
    return [point for point in result.points if (point["scene"], point["sweep"], point[fixed]) ==
            (figure["scene"], figure["sweep"], figure["fixed"])]


def _columns(figure: Json, points: list[Json], styles: Styles, level: str) -> list[Column]:
    """Any motion, and motion that is right where it is known of some run."""
    collides = any(point["max_strain_after_collision"] is not None for point in points)
    columns = []
    for panel, left, heading, strip in (
            ("any", LEFT, "any motion: the paper's question", "failed at every step"),
            ("within", 2 * LEFT + MAIN_WIDTH, f"error at most {level} of the scene's size", "failed or too wrong at every step")):
        factor = 100 if figure["sweep"] == "strain" else 1
        curves, of_filter = (curves_in(figure[panel] or {}, factor, time) for time in ("time", "filter"))
        if panel == "any" or all_best(curves):
            columns.append(Column(curves, of_filter if collides and all_best(of_filter) else {}, failed_rows(curves, styles), left, heading,
                                  strip))
    return columns


def _draw_column(sheet: Sheet, column: Column, styles: Styles, figure: Json, beneath: float) -> Axes:
    """Returns the main panel, which is alone where nothing is beneath it."""
    main = sheet.axes(column.left, sheet.bottom + beneath, MAIN_WIDTH, MAIN_HEIGHT)
    log_x(main, [b.x for b in all_best(column.curves)] + [x for curve in column.curves.values() for x, _ in curve.failures], MAIN_WIDTH)
    panels = [(main, column.curves)]
    if column.filter:
        panels.append((sheet.axes(column.left, sheet.bottom + STEPS_HEIGHT + BETWEEN, MAIN_WIDTH, STEPS_HEIGHT, sharex=main), column.filter))
        panels[-1][0].set_ylabel("filter alone (s)")
    for axes, curves in panels:
        log_y(axes, [time for best in all_best(curves) for time in (best.seconds, best.median)])
        draw_curves(axes, curves, styles)
        axes.tick_params(axis="x", which="both", labelbottom=not beneath)
        grid(axes)
    lowest = main
    if beneath:
        lowest = sheet.axes(column.left, sheet.bottom, MAIN_WIDTH, STEPS_HEIGHT, sharex=main)
        draw_steps(lowest, column.curves, styles)
        lowest.set_ylabel("best time step (s)")
        grid(lowest)
    lowest.set_xlabel(AXIS_LABELS[figure["sweep"]])
    return main


def _caption(figure: Json, points: list[Json], result: Result, columns: list[Column]) -> list[str]:
    sizes = sorted({point["vertices"] for point in points})
    size = f"{sizes[0]:,.0f} to {sizes[-1]:,.0f} vertices" if len(sizes) > 1 else f"{sizes[-1]:,.0f} vertices"
    if figure["sweep"] == "resolution":
        size += f", strain limit {percent(figure['fixed'])}"
    steps = "Each solver at its own best time step" + (" (panel of best steps)" if columns[0].heading else "")
    if len(columns) > 1:
        steps = ("Each solver at its fastest time step, of any motion on the left, and on the right of those whose error is at most "
                 f"{percent(result.analysis['headline_error'])} of the scene's size (panels of best steps)")
    best = [best for column in columns for best in all_best(column.curves)]
    bars = any(b.median > b.seconds for b in best)
    method = "; ".join([steps, sampling(result) + (", bars: up to their median" if bars else ""), *filter(None, settings_of_the_run(result))])
    marks = []
    if result.noise_factor is not None:
        marks.append("Bar in the corner: how far apart one solver is from itself under another name (A/A pair, 95 %); "
                     "points closer than that do not differ.")
    elif not bars:
        marks.append("No A/A pair: small differences mean nothing.")
    if any(result.known(name).contestant and result.known(name).unranked for name in figure["any"]):
        marks.append("Hollow marks: untuned settings, not ranked.")
    if any(b.ladder_end for b in best):
        marks.append("Arrow at a step: it is the coarsest (up) or the finest (down) that was tried, a better one may lie beyond.")
    letters = {letter for column in columns for letter in letters_in(column.rows)}
    failures = ("A mark above the axes: no step tried gave a run that counts there, nor at a tighter limit; the letters say why, from the "
                f"coarsest step to the finest: {result.key(letters)}.")
    return [scene_sentence(figure["scene"], size, points), " ".join([f"{method}.", *marks]), *([failures] if letters else [])]
