"""The words around a figure: warnings, and a caption that says what was measured, where, and how."""

from parts.result import Json, Result
from parts.words import clean, plain, scene_words


def warnings_of(result: Result) -> list[str]:
    """What a reader must not overlook; drawn in bold above the axes."""
    quick = result.suite.get("profile") == "quick"
    return (["QUICK PROFILE - not the paper's sizes"] if quick else []) + (
        [] if result.document["complete"] else ["INCOMPLETE - the run was cut short, points are missing"])


def scene_sentence(scene: str, size: str, points: list[Json]) -> str:
    """With the parameters that all points share; those that differ are the axis itself."""
    first, *others = [point["scene_parameters"] for point in points]
    said = ("n", "N", "vertices", "resolution", "duration")  # these stand in the sentence already
    same = [f"{clean(key.replace('_', ' '))} {plain(value)}" for key, value in first.items()
            if key not in said and all(other.get(key) == value for other in others)]
    durations = " or ".join(f"{d:g}" for d in sorted({point["duration"] for point in points}))
    return f"Scene {scene_words(scene)}: " + ", ".join([size, *same, f"{durations} s simulated"]) + "."


def sampling(result: Result) -> str:
    reps = result.suite.get("reps")
    return "one run a point" if reps == 1 else f"least of {plain(reps)} samples or more" if reps else "least sample"


def settings_of_the_run(result: Result, seed: bool = True) -> list[str]:
    suite = result.suite
    given = result.context.get("seed", suite.get("seed"))
    return [f"timeout {suite['timeout']:g} s" if "timeout" in suite else "", f"profile {plain(suite['profile'])}" if "profile" in suite else "",
            f"seed {plain(given)}" if given is not None else ""]


def origin_sentence(result: Result) -> str:
    """Machine, build, date. Executable, command line and host name stay out: they tell of a host, not of a method."""
    context, build = result.context, result.context["build"]
    parts = [plain(context["cpu_model"]), f"{context['num_cpus']} CPUs", f"build {plain(context['library_build_type'])}",
             plain(context["date"])[:16].replace("T", " "),
             f"commit {plain(build['git'])[:12]}{' + uncommitted changes' if build.get('dirty') else ''}"]
    return " ".join([f"Measured on {'; '.join(parts)}.", *(warning + "." for warning in warnings_of(result))])
