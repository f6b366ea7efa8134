"""The words around a figure: title, warnings, and a caption that says what was measured, where, and how."""

from __future__ import annotations

from typing import Any

from parts.best_points import Best, FigureData, number_in_paper
from parts.legend import Legend, legend_of
from parts.result_file import OK, Json, is_number, noise_factor, object_in, positive, suite_of
from parts.step_runs import RunsData
from parts.words import clean, scene_words

ERROR_LABEL = "trajectory error over the scene's size"
SUBJECTS = {"drape": "drape over a sphere"}



def title_of(figure: FigureData) -> str:
    axis = "strain limit" if figure.sweep == "strain" else "resolution"
    number = number_in_paper(figure.scene, figure.sweep)
    title = f"{SUBJECTS.get(figure.scene, scene_words(figure.scene))}: cost over {axis}"
    return f"Figure {number} - {title}" if number else title


def warnings_of(document: Json) -> list[str]:
    """What a reader must not overlook; drawn in bold above the axes."""
    warnings = []
    if suite_of(document).get("profile") == "quick":
        warnings.append("QUICK PROFILE - not the paper's sizes")
    if document.get("complete") is not True:
        warnings.append("INCOMPLETE - the run was cut short, points are missing")
    return warnings


def caption_of(figure: FigureData, document: Json, legend: Legend, letters: set[str]) -> list[str]:
    """The caption's paragraphs, each to be wrapped to the figure's width. `letters`: of the marks above the axes."""
    failures = [_failure_key(letters, legend)] if letters else []
    return [_scene_sentence(figure), _method_sentence(figure, document), *failures, origin_sentence(document)]


def _scene_sentence(figure: FigureData) -> str:
    if figure.sweep == "strain":
        size = f"{figure.fixed:,.0f} vertices"
    else:
        sizes = sorted({point["vertices"] for point in figure.points})
        several = f"{sizes[0]:,.0f} to " if len(sizes) > 1 else ""
        size = f"{several}{sizes[-1]:,.0f} vertices, strain limit {percent(figure.fixed)}"
    return scene_sentence(figure.scene, size, figure.points)


def scene_sentence(scene: str, size: str, points: list[Json]) -> str:
    parts = [size] + _common_parameters(points)
    durations = {point["duration"] for point in points if is_number(point.get("duration"))}
    if durations:
        parts.append(" or ".join(f"{d:g}" for d in sorted(durations)) + " s simulated")
    return f"Scene {scene_words(scene)}: " + ", ".join(parts) + "."


def _common_parameters(points: list[Json]) -> list[str]:
    """Scene parameters with one value in all points; those that differ are the axis itself."""
    scene_parameters = [p["scene_parameters"] for p in points if isinstance(p.get("scene_parameters"), dict)]
    if not scene_parameters:
        return []
    first = scene_parameters[0]
    same = [key for key in first if all(key in other and other[key] == first[key] for other in scene_parameters)]
    said = ("n", "N", "vertices", "resolution", "duration")  # these stand in the sentence already
    return [f"{clean(key.replace('_', ' '))} {plain(first[key])}" for key in same if key not in said]


def _method_sentence(figure: FigureData, document: Json) -> str:
    suite = suite_of(document)
    text = "Each solver at its own best time step (panel of best steps); "
    if figure.adaptive:
        text = "Adaptive steps: from the coarsest one on, halved where the solver refuses it (panel of mean steps); "
    if figure.within:
        text = (f"Each solver at its fastest time step, of any motion on the left, and on the right of those whose error is at most "
                f"{percent(figure.within.level or 0)} of the scene's size (panels of best steps); ")
    reps = suite.get("reps")
    if reps == 1:
        text += "one run a point"
    else:
        text += f"least of {plain(reps)} samples or more" if is_number(reps) else "least sample"
    best = _best_in(figure)
    if any(b.high > b.low for b in best):
        text += ", bars: up to their median"
    settings = [f"timeout {suite['timeout']:g} s" if is_number(suite.get("timeout")) else "",
                f"profile {plain(suite['profile'])}" if suite.get("profile") else "",
                f"seed {plain(_seed(document))}" if _seed(document) is not None else ""]
    return " ".join(["; ".join([text] + [setting for setting in settings if setting]) + "."] + _marks(figure, document))


def _marks(figure: FigureData, document: Json) -> list[str]:
    """Sentences on marks that the figure has."""
    legend, sentences = legend_of(document), []
    best = _best_in(figure)
    if noise_factor(document) is not None:
        sentences.append("Bar in the corner: how far apart one solver is from itself under another name (A/A pair, 95 %); "
                         "points closer than that do not differ.")
    elif not any(b.high > b.low for b in best):
        sentences.append("No A/A pair: small differences mean nothing.")
    if any(legend.competes(name) and not legend.ranked(name) for name in figure.curves):
        sentences.append("Hollow marks: untuned settings, not ranked.")
    if any(b.ladder_end for b in best):
        sentences.append("Arrow at a step: it is the coarsest (up) or the finest (down) that was tried, a better one may lie "
                         "beyond.")
    return sentences


def _panels(figure: FigureData) -> list[FigureData]:
    return [figure, figure.within] if figure.within else [figure]


def _best_in(figure: FigureData) -> list[Best]:
    return [best for panel in _panels(figure) for curve in panel.curves.values() for best in curve.best]


def _failure_key(letters: set[str], legend: Legend) -> str:
    return ("A mark above the axes: no step tried gave a run that counts there, nor at a tighter limit; the letters say why, from the "
            f"coarsest step to the finest: {legend.key(letters)}.")


def origin_sentence(document: Json) -> str:
    """Machine, build, date. Executable, command line and host name stay out: they tell of a host, not of a method."""
    context = object_in(document, "context")
    build = object_in(context, "build")
    edited = " + uncommitted changes" if build.get("dirty") is True else ""
    parts = [plain(context["cpu_model"]) if context.get("cpu_model") else "",
             f"{plain(context['num_cpus'])} CPUs" if is_number(context.get("num_cpus")) else "",
             f"build {plain(context['library_build_type'])}" if context.get("library_build_type") else "",
             plain(context["date"])[:16].replace("T", " ") if context.get("date") else "",
             f"commit {plain(build['git'])[:12]}{edited}" if build.get("git") else ""]
    text = "; ".join(part for part in parts if part)
    text = f"Measured on {text}." if text else "Machine and commit are not recorded."
    return " ".join([text] + [warning + "." for warning in warnings_of(document)])


def validity(data: RunsData) -> str:
    errors = [object_in(point, "error") for point in data.points if point["status"] == OK]
    sure = [error.get("error_until") for error in errors if positive(error.get("error_until"))]
    if sure:
        return (" Errors over the sample times at which they are more than three times the reference's own uncertainty, up to "
                f"t = {max(sure):g} s.")
    until = [error.get("valid_until") for error in errors]
    known = sorted(time for time in until if positive(time))
    return f" Errors up to t = {known[0]:g} s, as far as the reference can be trusted." if known else ""


def timing(document: Json) -> str:
    suite = suite_of(document)
    limit = f"; timeout {suite['timeout']:g} s" if is_number(suite.get("timeout")) else ""
    return f"Least of {plain(suite.get('reps', 1))} samples or more a point; profile {plain(suite.get('profile', '?'))}{limit}."


def _seed(document: Json) -> Any:
    return object_in(document, "context").get("seed", suite_of(document).get("seed"))


def plain(value: Any) -> str:
    """A value as a reader wants it. Of anything that looks like a path only the last part is shown."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if is_number(value):
        return f"{value:g}" if isinstance(value, float) else str(value)
    if isinstance(value, list):
        return clean(" x ".join(plain(item) for item in value))
    text = clean(value)
    return text.rstrip("/").rsplit("/", 1)[-1] if text.startswith(("/", "~", "./", "../")) else text


def percent(fraction: float) -> str:
    return f"{100 * fraction:.4g} %"
