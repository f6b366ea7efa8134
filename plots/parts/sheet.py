"""A sheet that panels are placed on by inches, with title, warnings, caption and the names of curves; and how it is saved."""

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from parts.caption import origin_sentence, warnings_of
from parts.colors import ALARM
from parts.result import Result
from parts.style import Styles, line_of
from parts.words import printable, shorten, wrap

# All lengths in inches. Placing by hand keeps the panels' size the same, however long caption and legend are.
LEFT, GAP, RIGHT = 1.45, 0.75, 0.2
MAIN_WIDTH, LEGEND_WIDTH = 4.5, 3.0
MAIN_HEIGHT, STEPS_HEIGHT, ROW_HEIGHT = 3.3, 1.7, 0.16
BETWEEN, X_LABEL, LINE_HEIGHT = 0.14, 0.5, 0.15
MARGIN = 0.2
TIME_LABEL = "wall seconds per simulated second"

TITLE_SIZE, FINDING_SIZE, WARNING_SIZE, CAPTION_SIZE, LEGEND_SIZE = 11, 9, 9.5, 7.5, 8
FINDING_HEIGHT, LABEL_HEIGHT = 0.17, 0.145
LABEL_WIDTH, LABEL_LINES = 2.05, 2


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
    if len(titles) > 2:
        titles = [titles[0], shorten(" ".join(titles[1:]), room, TITLE_SIZE, "bold")]
    found = wrap(printable(finding), room, FINDING_SIZE)
    bottom = 0.15 + LINE_HEIGHT * len(lines) + max(X_LABEL, hanging + 0.1)
    height = bottom + panels_height + 0.3 + 0.2 * (len(titles) + len(warnings)) + FINDING_HEIGHT * len(found)
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)

    def write(texts: list[str], top: float, line_height: float, **look: object) -> None:
        for number, text in enumerate(texts):
            figure.text(MARGIN / width, (top - line_height * number) / height, text, va="top", **look)

    below = height - 0.16 - 0.2 * len(titles)
    write(titles, height - 0.12, 0.2, fontsize=TITLE_SIZE, fontweight="bold")
    write(found, below, FINDING_HEIGHT, fontsize=FINDING_SIZE)
    write(warnings, below - FINDING_HEIGHT * len(found), 0.2, fontsize=WARNING_SIZE, fontweight="bold", color=ALARM)
    write(lines, 0.1 + LINE_HEIGHT * len(lines), LINE_HEIGHT, fontsize=CAPTION_SIZE)
    return Sheet(figure, width, height, bottom)


def add_legend(axes: Axes, styles: Styles, anchor: tuple[float, float]) -> None:
    labels = ["\n".join(label_lines(style.label)) for style in styles.values()]
    axes.legend([line_of(style, [], []) for style in styles.values()], labels, loc="upper left", bbox_to_anchor=anchor,
                borderaxespad=0, frameon=False, fontsize=LEGEND_SIZE, handlelength=4.2, labelspacing=0.55)


def legend_height(styles: Styles) -> float:
    return sum(0.13 * len(label_lines(style.label)) + 0.07 for style in styles.values())


def label_ends(sheet: Sheet, axes: Axes, ends: dict[str, tuple[float, float]], styles: Styles) -> None:
    """Names of those that lead beside the right edge, each as near to the end of its curve as names above it leave room, joined
    to it by a thin line. Those without a curve here are named below the others."""
    box = axes.get_position()
    tall, wide = box.height * sheet.height, box.width * sheet.width
    to_axes = axes.transData + axes.transAxes.inverted()
    wanted = {name: float(to_axes.transform(ends[name])[1]) * tall if name in ends else -1e9
              for name, style in styles.items() if style.leads}
    order = sorted(wanted, key=lambda name: -wanted[name])
    heights = [_label_height(styles[name].label) for name in order]
    tops = _spread([min(wanted[name] + height / 2, tall + 0.1) for name, height in zip(order, heights)], heights, tall)
    for number, (name, height, top) in enumerate(zip(order, heights, tops)):
        style, middle = styles[name], (top - height / 2) / tall
        if name in ends:
            end = to_axes.transform(ends[name])
            sheet.figure.add_artist(Line2D([end[0], 1 + 0.1 / wide], [end[1], middle], color=style.color, linewidth=0.6, alpha=0.7,
                                           transform=axes.transAxes))
        sample = line_of(style, [1 + 0.12 / wide, 1 + 0.4 / wide, 1 + 0.68 / wide], [middle] * 3, zorder=5)
        sample.set(transform=axes.transAxes, markevery=[1])
        sheet.figure.add_artist(sample)
        sheet.figure.text(1 + 0.76 / wide, middle, "\n".join(label_lines(style.label)), transform=axes.transAxes, va="center",
                          fontsize=LEGEND_SIZE, linespacing=1.0, gid=f"label-{number}")


def labels_height(styles: Styles) -> float:
    return sum(_label_height(style.label) for style in styles.values() if style.leads)


def _label_height(label: str) -> float:
    return LABEL_HEIGHT * len(label_lines(label)) + 0.05


def label_lines(label: str) -> list[str]:
    """As many as a legend has room for; an ellipsis stands for the rest."""
    lines = wrap(label, LABEL_WIDTH, LEGEND_SIZE)
    if len(lines) > LABEL_LINES:
        lines[LABEL_LINES - 1] = shorten(" ".join(lines[LABEL_LINES - 1:]), LABEL_WIDTH, LEGEND_SIZE)
    return lines[:LABEL_LINES]


def _spread(tops: list[float], heights: list[float], tall: float) -> list[float]:
    """Tops of labels, from the upper one down, moved so that none covers another and the last ends at the bottom if it can."""
    for i in range(1, len(tops)):
        tops[i] = min(tops[i], tops[i - 1] - heights[i - 1])
    floor = min(0.0, tall - sum(heights))
    return [max(top, floor + sum(heights[i:])) for i, top in enumerate(tops)]
