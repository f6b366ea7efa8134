"""Looks and letters come from the file's legend; what no legend knows is made up from its name."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import parts
from documents import SOLVERS, Json, axes_with, curves, drawn, legend, legend_labels, point, strain_sweep
from parts.legend import Legend, legend_of, merged
from parts.style import FAMILIES, SolverStyle, styles_for

NAMES = [row[0] for row in SOLVERS]


def known(**solvers: tuple[str, bool]) -> Legend:
    return legend_of({"schema": "inextensible-bench/1", "points": [], "legend": {"solvers": [
        {"name": name, "label": name.upper(), "family": family, "contestant": competes}
        for name, (family, competes) in solvers.items()]}})


def looks(styles: dict[str, SolverStyle]) -> list[tuple[object, ...]]:
    return [(style.color, style.marker, style.dashes) for style in styles.values()]


def today() -> Legend:
    return legend_of({"schema": "inextensible-bench/1", "points": [], "legend": legend()})


def test_families_share_a_colour_and_nobody_shares_a_look() -> None:
    styles = styles_for(NAMES, today())
    assert list(styles) == NAMES, "the order of the legend"
    colors = {solver: styles[solver].color for solver in NAMES}
    for name, _, family, contestant in SOLVERS:
        assert (colors[name] == colors[family]) or not contestant
    assert len({colors[row[2]] for row in SOLVERS if row[3]}) == 6
    assert len(set(looks(styles))) == len(NAMES)


def with_untuned() -> Json:
    """The legend of a file in which fast projection stands three times and ICD twice."""
    more = legend()
    variants = [("fast_projection_untuned", "fast_projection", True), ("fast_projection_again", "fast_projection", True),
                ("icd_loose", "icd", False)]
    for name, solver, hollow in variants:
        place = next(number for number, row in enumerate(more["solvers"]) if row["name"] == solver)
        parent = more["solvers"][place]
        more["solvers"].insert(place + 1, {**parent, "name": name, "label": name.replace("_", " "), "solver": solver,
                                           "unranked": hollow})
    return more


def test_contestants_are_curves_of_their_own_and_hollow_ones_have_hollow_marks() -> None:
    result = strain_sweep(solvers=("fast_projection",))
    result["legend"] = with_untuned()
    result["points"] += [point("fast_projection", limit=limit, seconds=1.0, best=True, contestant="fast_projection_untuned")
                         for limit in (0.1, 0.01, 0.001)]
    figure = drawn(result)["figure4a"]
    assert sorted(legend_labels(figure)) == sorted(["fast projection", "fast projection untuned"])
    full, hollow = curves(axes_with(figure, ylabel="wall seconds"))
    assert list(hollow.get_ydata()) == [1.0, 1.0, 1.0] and list(full.get_ydata()) != [1.0, 1.0, 1.0]
    assert hollow.get_markerfacecolor() == "none" and full.get_markerfacecolor() == full.get_color()
    steps = [line for line in axes_with(figure, ylabel="best time step").lines + axes_with(figure, ylabel="best time step").artists
             if getattr(line, "get_markerfacecolor", lambda: "")() == "none"]
    assert steps == [], "the panel of best steps is of those that rank"


def test_more_families_than_colours() -> None:
    many = known(**{f"s{number}": (f"family {number}", True) for number in range(len(FAMILIES) + 6)})
    styles = styles_for(many.solvers, many)
    assert len(set(looks(styles))) == len(styles)


def test_legends_of_several_files() -> None:
    newer, older = known(a=("a", True), b=("b", True)), known(b=("old", False), c=("c", True))
    assert [(solver.name, solver.family) for solver in merged([newer, older]).solvers.values()] == [("a", "a"), ("b", "b"),
                                                                                                     ("c", "c")]


@pytest.mark.parametrize("name", NAMES)
def test_no_code_knows_a_solver_by_name(name: str) -> None:
    """As a text of its own; that a fallback mentions a method's equation is no name."""
    plots = Path(parts.__file__).resolve().parents[1]
    quoted = re.compile(rf"""(["']){re.escape(name)}\1""")
    assert [path.name for path in plots.rglob("*.py") if quoted.search(path.read_text())] == []
