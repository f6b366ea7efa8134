"""A sheet that panels are placed on by inches, with title, warnings, caption and legend; and the words around a figure."""

import math
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from parts.result import Json, Result
from parts.style import ALARM, Styles, line_of
from parts.words import clean, plain, printable, scene_words, short, shorten, wrap

# All lengths in inches. Placing by hand keeps the panels' size the same, however long caption and legend are.
LEFT, NARROW, GAP, RIGHT = 1.45, 0.8, 0.75, 0.2
MAIN_WIDTH, LEGEND_WIDTH, END_WIDTH = 4.5, 3.0, 1.5
MAIN_HEIGHT, STEPS_HEIGHT, ROW_HEIGHT = 3.3, 1.7, 0.16
BETWEEN, X_LABEL, LINE_HEIGHT = 0.14, 0.5, 0.15
MARGIN = 0.2
TIME_LABEL = "wall seconds per simulated second"

TITLE_SIZE, FINDING_SIZE, WARNING_SIZE, CAPTION_SIZE, LEGEND_SIZE = 10, 9, 9.5, 7.5, 8
FINDING_HEIGHT = 0.17


@dataclass
class Sheet:
    """A matplotlib figure that is addressed in inches from its lower left corner; panels start at `bottom`."""

    figure: Figure
    width: float
    height: float
    bottom: float

    def axes(self, left: float, bottom: float, width: float, height: float, sharex: Axes | None = None) -> Axes:
        box = (left / self.width, bottom / self.height, width / self.width, height / self.height)
        return self.figure.add_axes(box, sharex=sharex)


def make_sheet(result: Result, title: str, paragraphs: list[str], width: float, panels_height: float,
               hanging: float = 0, finding: str = "") -> Sheet:
    """An empty sheet with title, what the figure finds, warnings and caption on it; `panels_height` is what all panels and
    strips need, `hanging` how far a legend hangs below them."""
    room = width - 2 * MARGIN
    warnings = warnings_of(result)
    lines = [line for paragraph in [*paragraphs, origin_sentence(result)] for line in wrap(paragraph, room, CAPTION_SIZE)]
    titles = wrap(title, room, TITLE_SIZE, "bold")
    if len(titles) > 3:
        titles = [*titles[:2], shorten(" ".join(titles[2:]), room, TITLE_SIZE, "bold")]
    found = wrap(printable(finding), room, FINDING_SIZE)
    bottom = 0.15 + LINE_HEIGHT * len(lines) + max(X_LABEL, hanging + 0.1)
    height = bottom + panels_height + 0.3 + 0.2 * (len(titles) + len(warnings)) + FINDING_HEIGHT * len(found)
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)

    def write(texts: list[str], top: float, line_height: float, **look: object) -> None:
        for number, text in enumerate(texts):
            figure.text(MARGIN / width, (top - line_height * number) / height, text, va="top", **look)

    below = height - 0.16 - 0.2 * len(titles)
    write(["\n".join(titles)], height - 0.12, 0.2, fontsize=TITLE_SIZE, fontweight="bold", linespacing=1.25)
    write(found, below, FINDING_HEIGHT, fontsize=FINDING_SIZE)
    write(warnings, below - FINDING_HEIGHT * len(found), 0.2, fontsize=WARNING_SIZE, fontweight="bold", color=ALARM)
    write(lines, 0.1 + LINE_HEIGHT * len(lines), LINE_HEIGHT, fontsize=CAPTION_SIZE)
    return Sheet(figure, width, height, bottom)


def add_legend(axes: Axes, styles: Styles, ends: dict[str, tuple[float, float]]) -> None:
    """To the right of the axes, those that lead; in the order in which their curves end there, from the upper one down."""
    shown = sorted((name for name, style in styles.items() if style.leads), key=lambda name: -ends.get(name, (0, 0))[1])
    axes.legend([line_of(styles[name], [], []) for name in shown],
                [shorten(short(styles[name].label), LEGEND_WIDTH - 0.75, LEGEND_SIZE) for name in shown], loc="upper left",
                bbox_to_anchor=(1.02, 1), borderaxespad=0, frameon=False, fontsize=LEGEND_SIZE, handlelength=4.2, labelspacing=0.55)


def legend_height(styles: Styles) -> float:
    return 0.2 * sum(style.leads for style in styles.values())


def warnings_of(result: Result) -> list[str]:
    """What a reader must not overlook; drawn in bold above the axes."""
    quick = result.suite.get("profile") == "quick"
    return (["QUICK PROFILE - not the paper's sizes"] if quick else []) + (
        [] if result.document["complete"] else ["INCOMPLETE - the run was cut short, points are missing"])


def scene_sentence(scene: str, points: list[Json]) -> str:
    """With the parameters that all points share; those that differ are the axis itself."""
    first, *others = [point["scene_parameters"] for point in points]
    said = ("n", "N", "vertices", "resolution", "duration")  # other sentences have these
    same = [f"{clean(key.replace('_', ' '))} {plain(value)}" for key, value in first.items()
            if key not in said and all(other.get(key) == value for other in others)]
    durations = " or ".join(f"{d:g}" for d in sorted({point["duration"] for point in points}))
    return f"Scene {scene_words(scene)}: {', '.join([*same, f'{durations} s simulated'])}."


def sampling(result: Result) -> str:
    reps = result.suite.get("reps")
    return "one run a point" if reps == 1 else f"least of {plain(reps)} samples or more" if reps else "least sample"


def noise_words(result: Result) -> str:
    """How far apart 95 % of the times of one solver are from those of itself under another name."""
    spread = result.noise.get("q95")
    return (" No A/A pair: small differences mean nothing." if spread is None else
            f" Times within {100 * math.expm1(spread):.2g} % (A/A pair) do not differ.")


def settings_of_the_run(result: Result) -> list[str]:
    suite = result.suite
    given = result.context.get("seed", suite.get("seed"))
    return [*([f"timeout {suite['timeout']:g} s"] if "timeout" in suite else []),
            *([f"profile {plain(suite['profile'])}"] if "profile" in suite else []), *([f"seed {plain(given)}"] if given is not None else [])]


def origin_sentence(result: Result) -> str:
    """Machine, build, date. Executable, command line and host name stay out: they tell of a host, not of a method."""
    context, build = result.context, result.context["build"]
    parts = [plain(context["cpu_model"]), f"{context['num_cpus']} CPUs", f"build {plain(context['library_build_type'])}",
             plain(context["date"])[:16].replace("T", " "),
             f"commit {plain(build['git'])[:12]}{' + uncommitted changes' if build.get('dirty') else ''}"]
    return " ".join([f"Measured on {'; '.join(parts)}.", *(warning + "." for warning in warnings_of(result))])
