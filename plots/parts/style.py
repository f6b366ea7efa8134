"""How each solver looks, in every figure: colours of families and looks within them, so that figures can be compared.

A solver is told apart three times over - colour, marker, line style - so that a figure survives grey printing and
colour-blind eyes. Colours are Okabe and Ito's (https://jfly.uni-koeln.de/color/). Which solver belongs to which family, and
their order, comes from the result file's legend: a solver that is added at a family's end changes no other's look.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from typing import Any, Iterable

from parts.colors import (BLACK, BLUE, BROWN, GREEN, GREY, ORANGE, PALE_BLUE, PALE_BROWN, PALE_GREEN, PALE_GREY, PURPLE, SKY,
                          TEAL, VERMILLION, VIOLET)
from parts.legend import Legend, Solver
from parts.words import FONT, clean

Dashes = tuple[float, ...]  # on, off, on, off ... in points; () is a solid line


@dataclass(frozen=True)
class SolverStyle:
    """Look of one solver. `contestant` is false for backends that the figures show but do not rank; `hollow` marks have no
    face."""

    label: str
    color: str
    marker: str
    dashes: Dashes
    width: float = 1.3
    size: float = 5.5
    contestant: bool = True
    hollow: bool = False
    leads: bool = True  # else thin and pale: neither first anywhere nor one of the paper's
    origin: str = "elsewhere"  # who offers it, as in the legend


@dataclass(frozen=True)
class Look:
    marker: str
    dashes: Dashes
    width: float = 1.3
    size: float = 6


# A family by its number: its colour, and the looks of its solvers in their order.
FAMILIES: tuple[tuple[str, tuple[Look, ...]], ...] = (
    (BLACK, (Look("s", (5, 2), size=4.8),)),
    (ORANGE, (Look("v", (1, 1.5), 1.6),)),
    (SKY, (Look("^", (5, 1.5, 1, 1.5)), Look("<", (2, 1), 1.6))),
    (GREEN, (Look("D", (8, 2), size=4.6), Look("d", (2, 2)))),
    (PURPLE, (Look("X", (3, 1.2), size=6.3),)),
    (BLUE, (Look("o", (), 2.0, 5.5), Look("p", (4, 1), 1.6, 6.5), Look("h", (2, 1, 2, 4), 1.6, 6.5),
            Look("*", (4, 1, 1, 1), 1.6, 7.5))),
)
MORE_COLORS = (VERMILLION, VIOLET, BROWN, TEAL)

# For families and members beyond these, and for solvers that no legend knows.
SPARE_LOOKS = (
    Look("P", (2, 1, 2, 4)), Look("*", (6, 1, 1, 1, 1, 1), size=7.5), Look("p", (1, 3)), Look("<", (4, 4)),
    Look(">", (7, 1.5, 3, 1.5)), Look("d", (2, 2)), Look("H", (10, 3)),
)

# Contestants that neither lead nor are the paper's: their caption, color and line by origin.
RECEDING: dict[str, tuple[str, str, Dashes]] = {
    "project": ("Blue, pale: this project's", PALE_BLUE, ()),
    "literature": ("Brown, dashed: other published methods", PALE_BROWN, (4, 1.5)),
    "engine": ("Green, dotted: engines", PALE_GREEN, (1, 1)),
}
RECEDING_REST = ("Grey", PALE_GREY, ())

# Those that do not compete, all of them grey.
NEUTRAL_LOOKS = (Look("", (), 0.8), Look("+", (1, 2), 0.8), Look("x", (4, 2), 0.8), Look("1", (6, 3), 0.8))

# Applied with matplotlib.rc_context around the drawing; the fixed salt makes the ids in an SVG repeat from run to run.
# Names come from files: none of them is a formula.
RC: dict[str, Any] = {
    "font.family": FONT, "font.size": 9.0, "axes.titlesize": 9.0, "axes.labelsize": 9.0,
    "xtick.labelsize": 8.0, "ytick.labelsize": 8.0, "axes.linewidth": 0.7, "axes.spines.right": False,
    "axes.unicode_minus": False, "figure.facecolor": "white", "savefig.facecolor": "white",
    "svg.hashsalt": "inextensible-bench", "path.simplify": False, "text.parse_math": False,
}


def styles_for(solvers: Iterable[str], legend: Legend) -> dict[str, SolverStyle]:
    """Style of each solver in the order of the legend: variants right after their parent, strangers after all contestants,
    those that do not compete last."""
    names = sorted(set(solvers))
    known = _of_legend(legend)
    styles = {name: known[name] for name in names if name in known}
    free = list(range(len(SPARE_LOOKS) * len(MORE_COLORS)))
    for name in names:
        if name not in known:
            styles[name] = _of_stranger(name, known, free)
    ranks = list(known)

    def rank(name: str) -> tuple[bool, int, str]:
        parent = name if name in known else parent_of(name, known)
        return (not styles[name].contestant, ranks.index(parent) if parent else len(ranks), "" if name in known else name)

    return {name: styles[name] for name in sorted(styles, key=rank)}


def with_leaders(styles: dict[str, SolverStyle], leaders: set[str] | None) -> dict[str, SolverStyle]:
    """All but the leaders, and all with untuned settings, recede. None: the file does not say who leads."""
    if leaders is None:
        return styles
    return {name: style if name in leaders or not style.contestant else
            _receding(style) for name, style in styles.items()}


def receding_sentences(styles: Iterable[SolverStyle]) -> list[str]:
    """Which methods the pale lines are, a sentence for each kind."""
    kinds: dict[str, list[str]] = {}
    for style in styles:
        if not style.leads:
            kinds.setdefault(RECEDING.get(style.origin, RECEDING_REST)[0], []).append(style.label)
    order = [words for words, _, _ in (*RECEDING.values(), RECEDING_REST)]
    return [f"{words}: {', '.join(kinds[words])}." for words in order if words in kinds]


def _receding(style: SolverStyle) -> SolverStyle:
    _, color, dashes = RECEDING.get(style.origin, RECEDING_REST)
    return replace(style, color=color, marker="", dashes=dashes, width=0.8, leads=False)


def parent_of(solver: str, known: Iterable[str]) -> str | None:
    """The solver of the legend that `solver` is a variant of ("shake_lazy", "jacobi:target=0.5"): the longest name that it
    starts with."""
    parents = [name for name in known if solver.startswith((name + ":", name + "_", name + "-"))]
    return max(parents, key=len, default=None)


def _of_legend(legend: Legend) -> dict[str, SolverStyle]:
    """Colour by the family's number, in order of first appearance; the look by the place within the family. Hollow ones
    look like the solver that they are, but hollow; other variants of a solver come after the family's solvers."""
    members: dict[str, list[Solver]] = {}
    for solver in sorted(legend.solvers.values(), key=lambda solver: bool(solver.solver)):
        if solver.contestant and not _copies(solver, legend):
            members.setdefault(solver.family, []).append(solver)
    neutral = [solver for solver in legend.solvers.values() if not solver.contestant]
    families = list(members)
    styles: dict[str, SolverStyle] = {}
    for solver in legend.solvers.values():
        if _copies(solver, legend):
            continue
        if solver.contestant:
            family = families.index(solver.family)
            color, look = _look_in(family, members[solver.family].index(solver))
        else:
            color, look = GREY, NEUTRAL_LOOKS[neutral.index(solver) % len(NEUTRAL_LOOKS)]
        styles[solver.name] = SolverStyle(solver.label, color, look.marker, look.dashes, look.width, look.size,
                                          solver.contestant, solver.hollow, origin=solver.origin)
    for solver in legend.solvers.values():
        if _copies(solver, legend):
            styles[solver.name] = replace(styles[solver.solver], label=solver.label, hollow=True, width=0.8)
    return {name: styles[name] for name in legend.solvers}


def _copies(solver: Solver, legend: Legend) -> bool:
    """Whether it takes the look of another."""
    return solver.hollow and solver.solver in legend.solvers and not legend.solvers[solver.solver].solver


def _look_in(family: int, place: int) -> tuple[str, Look]:
    if family < len(FAMILIES):
        color, looks = FAMILIES[family]
        return color, (looks[place] if place < len(looks) else SPARE_LOOKS[(place - len(looks)) % len(SPARE_LOOKS)])
    family -= len(FAMILIES)
    return MORE_COLORS[family % len(MORE_COLORS)], SPARE_LOOKS[(family + place) % len(SPARE_LOOKS)]


def _of_stranger(name: str, known: dict[str, SolverStyle], free: list[int]) -> SolverStyle:
    """Starts from a hash of the name and steps on to the next free look, so that a name looks the same in most files and
    no two in one figure look alike. A variant keeps its parent's colour."""
    slots = len(SPARE_LOOKS) * len(MORE_COLORS)
    wanted = zlib.crc32(name.encode(errors="replace")) % slots
    slot = min(free, key=lambda slot: (slot - wanted) % slots, default=wanted)
    if free:
        free.remove(slot)
    look, color = SPARE_LOOKS[slot % len(SPARE_LOOKS)], MORE_COLORS[slot % len(MORE_COLORS)]
    parent = parent_of(name, known)
    if not parent:
        return SolverStyle(clean(name.replace("_", " ")), color, look.marker, look.dashes, look.width, look.size)
    words = clean(name[len(parent) + 1:].replace("_", " "))
    marker = look.marker if known[parent].marker else ""  # a variant of a plain line stays one
    return replace(known[parent], label=f"{known[parent].label}, {words}", marker=marker, dashes=look.dashes, size=look.size)
