"""How each solver looks, in every figure: one table, so that figures can be compared with one another.

A solver is told apart three times over - colour, marker, line style - so that a figure survives grey printing and
colour-blind eyes. Colours are Okabe and Ito's (https://jfly.uni-koeln.de/color/).
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from typing import Any, Iterable

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILLION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
GREY, LIGHT_GREY, ALARM = "#7F7F7F", "#F2F2F2", "#A32D00"

Dashes = tuple[float, ...]  # on, off, on, off ... in points; () is a solid line


@dataclass(frozen=True)
class SolverStyle:
    """Look of one solver. `contestant` is false for backends that the figures show but do not rank."""

    label: str
    color: str
    marker: str
    dashes: Dashes
    width: float = 1.3
    size: float = 5.5
    contestant: bool = True


# The order of this table is the order of every legend.
TABLE: dict[str, SolverStyle] = {
    "implicit_springs": SolverStyle("implicit springs", BLACK, "s", (5, 2), size=4.8),
    "jacobi": SolverStyle("Jacobi strain limiting", ORANGE, "v", (1, 1.5), width=1.6, size=6),
    "gauss_seidel": SolverStyle("Gauss-Seidel strain limiting", SKY, "^", (5, 1.5, 1, 1.5), size=6),
    "gauss_seidel_colored": SolverStyle("Gauss-Seidel strain limiting, colored", SKY, "<", (2, 1), width=1.6, size=6),
    "shake": SolverStyle("SHAKE", GREEN, "D", (8, 2), size=4.6),
    "icd": SolverStyle("ICD (implicit constraint direction)", PURPLE, "X", (3, 1.2), size=6.3),
    "fast_projection": SolverStyle("fast projection", BLUE, "o", (), width=2.0),
    "fast_projection_smoothed": SolverStyle("fast projection, smoothed", BLUE, "p", (4, 1), width=1.6, size=6.5),
    "fast_projection_bdf2": SolverStyle("fast projection in BDF2", BLUE, "h", (2, 1, 2, 4), width=1.6, size=6.5),
    "fast_projection_bdf2opt": SolverStyle("fast projection in BDF2 with BDF3", VERMILLION, "H", (4, 1, 1, 1), width=1.6, size=6.5),
    "rattle": SolverStyle("RATTLE (SHAKE with velocities)", GREEN, "d", (2, 2), size=6),
    "null": SolverStyle("scene without inextensibility", GREY, "", (), width=0.8, contestant=False),
    "reference": SolverStyle("reference (no contestant)", GREY, "+", (1, 2), width=0.8, contestant=False),
}

# For solvers that the table does not know: a variant of a known one ("gauss_seidel:target=0.5", "shake_lazy")
# keeps the colour of its parent and gets a marker and dashes from here; a stranger gets a colour from here as well.
SPARE_COLORS = (VERMILLION, "#6A3D9A", "#8C6D1F", "#3F7F7F")
SPARE_LOOKS: tuple[tuple[str, Dashes], ...] = (
    ("P", (2, 1, 2, 4)), ("*", (6, 1, 1, 1, 1, 1)), ("p", (1, 3)), ("<", (4, 4)), (">", (7, 1.5, 3, 1.5)),
    ("d", (2, 2)), ("H", (10, 3)),
)

# Applied with matplotlib.rc_context around the drawing; the fixed salt makes the ids in an SVG repeat from run to run.
RC: dict[str, Any] = {
    "font.family": "DejaVu Sans", "font.size": 9.0, "axes.titlesize": 9.0, "axes.labelsize": 9.0,
    "xtick.labelsize": 8.0, "ytick.labelsize": 8.0, "axes.linewidth": 0.7, "axes.spines.right": False,
    "axes.unicode_minus": False, "figure.facecolor": "white", "savefig.facecolor": "white",
    "svg.hashsalt": "inextensible-bench", "path.simplify": False,
}


def parent_of(solver: str) -> str | None:
    """The table's solver that `solver` is a variant of: the longest name that it starts with."""
    parents = [name for name in TABLE if solver.startswith((name + ":", name + "_", name + "-"))]
    return max(parents, key=len, default=None)


def styles_for(solvers: Iterable[str]) -> dict[str, SolverStyle]:
    """Style of each solver, in legend order. Unknown names start from a hash of the name and step on to the next
    spare look that is free, so a name looks the same in most files and no two in one figure look alike."""
    names = sorted(set(solvers))
    styles = {name: TABLE[name] for name in TABLE if name in names}
    used: set[int] = set()
    for name in names:
        if name in TABLE:
            continue
        slot = zlib.crc32(name.encode()) % len(SPARE_LOOKS)
        while slot in used and len(used) < len(SPARE_LOOKS):
            slot = (slot + 1) % len(SPARE_LOOKS)
        used.add(slot)
        marker, dashes = SPARE_LOOKS[slot]
        parent = parent_of(name)
        if parent:
            label = TABLE[parent].label + ", " + name[len(parent) + 1:].replace("_", " ")
            if not TABLE[parent].marker:
                marker = ""  # a variant of "null" stays a plain line
            styles[name] = replace(TABLE[parent], label=label, dashes=dashes, marker=marker, size=6.5)
        else:
            color = SPARE_COLORS[slot % len(SPARE_COLORS)]
            styles[name] = SolverStyle(name.replace("_", " "), color, marker, dashes, size=6.5)
    return _in_order(styles)


def _in_order(styles: dict[str, SolverStyle]) -> dict[str, SolverStyle]:
    """Variants right after their parent, strangers after all contestants, those that do not compete last."""
    ranks = list(TABLE)

    def rank(name: str) -> tuple[bool, int, str]:
        known = name if name in TABLE else parent_of(name)
        return (not styles[name].contestant, ranks.index(known) if known else len(ranks), "" if name in TABLE else name)

    return {name: styles[name] for name in sorted(styles, key=rank)}
