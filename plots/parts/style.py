"""How each solver looks, in every figure: colours of families and looks within them, so that figures can be compared.

A solver is told apart three times over - colour, marker, line style - so that a figure survives grey printing and
colour-blind eyes. Colours are Okabe and Ito's (https://jfly.uni-koeln.de/color/). Which solver belongs to which family, and
their order, comes from the result file's legend: a solver that is added at a family's end changes no other's look.
"""

from dataclasses import dataclass, replace
from typing import Any, Iterable

from matplotlib.lines import Line2D

from parts.result import Result, Solver
from parts.words import FONT, clean

# The colours of figures, films and the report.
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILLION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
VIOLET, BROWN, TEAL = "#6A3D9A", "#8C6D1F", "#3F7F7F"
DARK_GREY, GREY, LIGHT_GREY, ALARM = "#555555", "#7F7F7F", "#F2F2F2", "#A32D00"
PALE_GREY, PALE_BLUE, PALE_BROWN, PALE_GREEN = "#BDBDBD", "#9CC3E0", "#DDBE8B", "#94CFA9"

Dashes = tuple[float, ...]  # on, off, on, off ... in points; () is a solid line


@dataclass(frozen=True)
class Look:
    marker: str
    dashes: Dashes
    width: float = 1.3
    size: float = 6


@dataclass(frozen=True)
class SolverStyle:
    """Look of one solver. `recedes` has the caption of those that are thin and pale: neither first anywhere, nor the paper's, nor plug-ins."""

    label: str
    color: str
    look: Look
    recedes: str = ""

    @property
    def leads(self) -> bool:
        return not self.recedes


Styles = dict[str, SolverStyle]

# A family by its number: its colour, and the looks of its solvers in their order.
FAMILIES: tuple[tuple[str, tuple[Look, ...]], ...] = (
    (BLACK, (Look("s", (5, 2), size=4.8),)),
    (ORANGE, (Look("v", (1, 1.5), 1.6),)),
    (SKY, (Look("^", (5, 1.5, 1, 1.5)), Look("<", (2, 1), 1.6))),
    (GREEN, (Look("D", (8, 2), size=4.6), Look("d", (2, 2)))),
    (PURPLE, (Look("X", (3, 1.2), size=6.3),)),
    (BLUE, (Look("o", (), 2.0, 5.5), Look("p", (4, 1), 1.6, 6.5), Look("h", (2, 1, 2, 4), 1.6, 6.5),
            Look("*", (4, 1, 1, 1), 1.6, 7.5))))
MORE_COLORS = (VERMILLION, VIOLET, BROWN, TEAL)

# For families and members beyond these.
SPARE_LOOKS = (
    Look("P", (2, 1, 2, 4)), Look("*", (6, 1, 1, 1, 1, 1), size=7.5), Look("p", (1, 3)), Look("<", (4, 4)),
    Look(">", (7, 1.5, 3, 1.5)), Look("d", (2, 2)), Look("H", (10, 3)))

# Contestants that do not lead: their caption, color and line by origin. Plug-ins, of which a reader asks first, all lead.
RECEDING: dict[str, tuple[str, str, Dashes]] = {
    "project": ("Blue, pale: this project's", PALE_BLUE, ()),
    "literature": ("Brown, dashed: other published methods", PALE_BROWN, (4, 1.5)),
    "engine": ("Green, dotted: engines", PALE_GREEN, (1, 1)),
    "paper": ("Grey: the paper's in other time steppers", PALE_GREY, ())}

# Applied with matplotlib.rc_context around the drawing; the fixed salt makes the ids in an SVG repeat from run to run.
# Names come from files: none of them is a formula.
RC: dict[str, Any] = {
    "font.family": FONT, "font.size": 9.0, "axes.titlesize": 9.0, "axes.labelsize": 9.0,
    "xtick.labelsize": 8.0, "ytick.labelsize": 8.0, "axes.linewidth": 0.7, "axes.spines.right": False,
    "axes.unicode_minus": False, "figure.facecolor": "white", "savefig.facecolor": "white",
    "svg.hashsalt": "inextensible-bench", "path.simplify": False, "text.parse_math": False}


def styles_for(names: Iterable[str], result: Result, leaders: set[str] | None = None) -> Styles:
    """Style of each solver in the order of the legend. A variant comes after its family's solvers. leaders: all others recede, but for
    plug-ins."""
    wanted = set(names)
    solvers = {**result.solvers, **{name: result.known(name) for name in sorted(wanted - result.solvers.keys())}}
    families: dict[str, list[Solver]] = {}
    for solver in sorted(solvers.values(), key=lambda solver: bool(solver.solver)):
        if not solver.unranked:
            families.setdefault(solver.family, []).append(solver)

    def style(solver: Solver) -> SolverStyle:
        color, look = _look_in(list(families).index(solver.family), families[solver.family].index(solver))
        if leaders is None or solver.name in leaders or solver.origin not in RECEDING:
            return SolverStyle(clean(solver.label), color, look)
        words, color, dashes = RECEDING[solver.origin]
        return SolverStyle(clean(solver.label), color, replace(look, marker="", dashes=dashes, width=0.8), words)

    return {name: style(solver) for name, solver in solvers.items() if name in wanted and not solver.unranked}


def line_of(style: SolverStyle, x: list[float], y: list[float], **more: Any) -> Line2D:
    """Line with the solver's look; the thin white rim keeps markers apart where curves run on top of one another."""
    look = style.look
    line = Line2D(x, y, color=style.color, marker=look.marker, markersize=look.size, linewidth=look.width, **more)
    line.set_linestyle((0, look.dashes) if look.dashes else "-")
    line.set(markeredgecolor="white", markeredgewidth=0.5)
    return line


def receding_sentences(styles: Iterable[SolverStyle]) -> list[str]:
    """Which methods the pale lines are, a sentence for each kind."""
    kinds = {words: [style.label for style in styles if style.recedes == words] for words, *_ in RECEDING.values()}
    return [f"{words}: {'; '.join(labels)}." for words, labels in kinds.items() if labels]


def _look_in(family: int, place: int) -> tuple[str, Look]:
    if family < len(FAMILIES):
        color, looks = FAMILIES[family]
        return color, (looks + SPARE_LOOKS * (1 + place // len(SPARE_LOOKS)))[place]
    family -= len(FAMILIES)
    return MORE_COLORS[family % len(MORE_COLORS)], SPARE_LOOKS[(family + place) % len(SPARE_LOOKS)]
