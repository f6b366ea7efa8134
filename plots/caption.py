"""The words around a figure: title, warnings, and a caption that says what was measured, where, and how."""

from __future__ import annotations

from typing import Any

from results import FigureData, Json, NOT_CHOSEN, TOO_WRONG, adaptive, is_number

SUBJECTS = {
    ("chain", "strain"): "Figure 4a - chain: cost over permissible strain",
    ("chain", "resolution"): "Figure 4b - chain: cost over resolution",
    ("drape", "strain"): "Figure 5a - drape over a sphere: cost over permissible strain",
    ("drape", "resolution"): "Figure 5b - drape over a sphere: cost over resolution",
}
MEANINGS = {
    "T": "timeout", "D": "diverged", "N": "not converged", "S": "strain limit missed", "U": "unsupported",
    "O": "out of memory", "C": "crashed", "K": "skipped", TOO_WRONG: "trajectory error above the limit", NOT_CHOSEN: "ran, but no step was chosen as best",
}


def title_of(figure: FigureData) -> str:
    axis = "permissible strain" if figure.sweep == "strain" else "resolution"
    title = SUBJECTS.get((figure.scene, figure.sweep), f"{figure.scene}: cost over {axis}")
    return title if figure.max_error is None else f"{title}, at a trajectory error of at most {percent(figure.max_error)}"


def warnings_of(document: Json) -> list[str]:
    """What a reader must not overlook; drawn in bold above the axes."""
    warnings = []
    if _suite(document).get("profile") == "quick":
        warnings.append("QUICK PROFILE - not the paper's sizes")
    if document.get("complete") is not True:
        warnings.append("INCOMPLETE - the run was cut short, points are missing")
    return warnings


def caption_of(figure: FigureData, document: Json) -> list[str]:
    """The caption's paragraphs, each to be wrapped to the figure's width."""
    paragraphs = [_scene_sentence(figure), _method_sentence(figure, document)]
    failures = _failure_key(figure, document)
    if failures:
        paragraphs.append(failures)
    paragraphs.append(origin_sentence(document))
    return paragraphs


def _scene_sentence(figure: FigureData) -> str:
    if figure.sweep == "strain":
        size = f"{figure.fixed:,.0f} vertices"
    else:
        sizes = sorted({point["vertices"] for point in figure.points})
        several = f"{sizes[0]:,.0f} to " if len(sizes) > 1 else ""
        size = f"{several}{sizes[-1]:,.0f} vertices, permissible strain {percent(figure.fixed)}"
    return scene_sentence(figure.scene, size, figure.points)


def scene_sentence(scene: str, size: str, points: list[Json]) -> str:
    parts = [size] + _common_parameters(points)
    durations = {point["duration"] for point in points if is_number(point.get("duration"))}
    if durations:
        parts.append(" or ".join(f"{d:g}" for d in sorted(durations)) + " s simulated")
    return f"Scene {scene}: " + ", ".join(parts) + "."


def _common_parameters(points: list[Json]) -> list[str]:
    """Scene parameters with one value in all points; those that differ are the axis itself."""
    scene_parameters = [p["scene_parameters"] for p in points if isinstance(p.get("scene_parameters"), dict)]
    if not scene_parameters:
        return []
    first = scene_parameters[0]
    same = [key for key in first if all(key in other and other[key] == first[key] for other in scene_parameters)]
    said = ("n", "N", "vertices", "resolution", "duration")  # these stand in the sentence already
    return [f"{key.replace('_', ' ')} {plain(first[key])}" for key in same if key not in said]


def _method_sentence(figure: FigureData, document: Json) -> str:
    suite = _suite(document)
    text = "Each solver at its own best time step (panel of best steps); "
    if adaptive(figure.points):
        text = "Adaptive steps: from the coarsest one on, halved where the solver refuses it (panel of mean steps); "
    if figure.max_error is not None:
        text = (f"Each solver at its fastest time step whose trajectory error is at most {percent(figure.max_error)} of the "
                "scene's size; ")
    reps = suite.get("reps")
    if reps == 1:
        text += "one run a point"
    else:
        text += f"median of {reps} repetitions" if is_number(reps) else "median"
    if any(best.q3 > best.q1 for curve in figure.curves.values() for best in curve.best):
        text += ", bars from the first to the third quartile"
    settings = [f"timeout {suite['timeout']:g} s" if is_number(suite.get("timeout")) else "",
                f"profile {plain(suite['profile'])}" if suite.get("profile") else "",
                f"seed {plain(_seed(document))}" if _seed(document) is not None else ""]
    return "; ".join([text] + [setting for setting in settings if setting]) + "."


def _failure_key(figure: FigureData, document: Json) -> str:
    letters = {letter for name, curve in figure.curves.items() if name != "null"
               for failure in curve.failures for letter in failure.letters}
    if not letters:
        return ""
    meanings = dict(MEANINGS)
    limit = _suite(document).get("timeout")
    if is_number(limit):
        meanings["T"] += f" (T alone: every step took longer than {limit:g} s)"
    key = ", ".join(f"{letter} = {meanings[letter]}" for letter in meanings if letter in letters)
    return ("A mark above the axes: every step tried failed, the letters say how, from the coarsest step to the finest: "
            f"{key}.")


def origin_sentence(document: Json) -> str:
    """Machine, build, date. Executable, command line and host name stay out: they tell of a host, not of a method."""
    context = _object(document.get("context"))
    build = _object(context.get("build"))
    edited = " + uncommitted changes" if build.get("dirty") is True else ""
    parts = [plain(context["cpu_model"]) if context.get("cpu_model") else "",
             f"{plain(context['num_cpus'])} CPUs" if is_number(context.get("num_cpus")) else "",
             f"build {plain(context['library_build_type'])}" if context.get("library_build_type") else "",
             plain(context["date"])[:16].replace("T", " ") if context.get("date") else "",
             f"commit {plain(build['git'])[:12]}{edited}" if build.get("git") else ""]
    text = "; ".join(part for part in parts if part)
    text = f"Measured on {text}." if text else "Machine and commit are not recorded."
    return " ".join([text] + [warning + "." for warning in warnings_of(document)])


def _suite(document: Json) -> Json:
    return _object(_object(document.get("context")).get("suite"))


def _seed(document: Json) -> Any:
    return _object(document.get("context")).get("seed", _suite(document).get("seed"))


def _object(value: Any) -> Json:
    return value if isinstance(value, dict) else {}


def plain(value: Any) -> str:
    """A value as a reader wants it. Of anything that looks like a path only the last part is shown."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if is_number(value):
        return f"{value:g}" if isinstance(value, float) else str(value)
    if isinstance(value, list):
        return " x ".join(plain(item) for item in value)
    text = " ".join(str(value).split())
    return text.rstrip("/").rsplit("/", 1)[-1] if text.startswith(("/", "~", "./", "../")) else text


def percent(fraction: float) -> str:
    return f"{100 * fraction:.4g} %"
