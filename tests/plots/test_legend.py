"""Looks and letters come from the file's legend; what no legend knows is made up from its name."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import parts
from documents import (SOLVERS, Json, axes_with, curves, drawn, legend, legend_labels, marks, point, strain_sweep, strips,
                       words_of)
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


def test_todays_solvers_look_as_they_did() -> None:
    styles = styles_for(NAMES, today())
    assert (styles["fast_projection"].color, styles["fast_projection"].dashes) == ("#0072B2", ())
    assert (styles["implicit_springs"].color, styles["implicit_springs"].marker) == ("#000000", "s")
    assert (styles["rattle"].color, styles["rattle"].marker) == (styles["shake"].color, "d")
    assert not styles["null"].contestant and styles["null"].marker == "" and styles["null"].color == "#7F7F7F"


def test_a_new_solver_leaves_the_others_as_they_are() -> None:
    before = styles_for(NAMES, today())
    more = legend()
    more["solvers"].insert(6, {"name": "icd_lazy", "label": "lazy ICD", "family": "icd", "contestant": True})
    more["solvers"].append({"name": "new", "label": "new", "family": "new", "contestant": True})
    after = styles_for([*NAMES, "icd_lazy", "new"], legend_of({"schema": "inextensible-bench/1", "points": [], "legend": more}))
    assert {name: after[name] for name in NAMES} == before
    assert after["icd_lazy"].color == after["icd"].color and len(set(looks(after))) == len(NAMES) + 2


def with_untuned() -> Json:
    """The legend of a file in which fast projection stands three times and ICD twice."""
    more = legend()
    variants = [("fast_projection_untuned", "fast_projection", True), ("fast_projection_again", "fast_projection", True),
                ("icd_loose", "icd", False)]
    for name, solver, hollow in variants:
        place = next(number for number, row in enumerate(more["solvers"]) if row["name"] == solver)
        parent = more["solvers"][place]
        more["solvers"].insert(place + 1, {**parent, "name": name, "label": name.replace("_", " "), "solver": solver,
                                           "hollow": hollow})
    return more


def test_other_names_of_a_solver_leave_the_looks_of_all_others() -> None:
    before = styles_for(NAMES, today())
    after = styles_for([*NAMES, "fast_projection_untuned", "icd_loose"],
                       legend_of({"schema": "inextensible-bench/1", "points": [], "legend": with_untuned()}))
    assert {name: after[name] for name in NAMES} == before
    hollow, solver = after["fast_projection_untuned"], after["fast_projection"]
    assert hollow.hollow and not solver.hollow
    assert (hollow.color, hollow.marker, hollow.dashes) == (solver.color, solver.marker, solver.dashes)
    assert after["icd_loose"].color == after["icd"].color and after["icd_loose"].marker != after["icd"].marker
    assert list(after).index("fast_projection_untuned") == list(after).index("fast_projection") + 1


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


def test_which_solvers_a_figure_shows_does_not_change_their_looks() -> None:
    all_of_them = styles_for(NAMES, today())
    assert styles_for(["shake", "rattle"], today()) == {name: all_of_them[name] for name in ("shake", "rattle")}


def test_more_families_than_colours() -> None:
    many = known(**{f"s{number}": (f"family {number}", True) for number in range(len(FAMILIES) + 6)})
    styles = styles_for(many.solvers, many)
    assert len(set(looks(styles))) == len(styles)


def test_strangers() -> None:
    styles = styles_for(["shake", "shake_lazy", "icd:target=0.5", "null", "my_own", "another"], today())
    assert list(styles) == ["shake", "shake_lazy", "icd:target=0.5", "another", "my_own", "null"]
    assert styles["shake_lazy"].color == styles["shake"].color and styles["shake_lazy"].label == "SHAKE, lazy"
    assert styles["my_own"].label == "my own"
    assert len(set(looks(styles))) == len(styles)


def test_a_file_without_legend() -> None:
    result = strain_sweep()
    del result["legend"]
    figure = drawn(result)["figure4a"]
    assert sorted(legend_labels(figure)) == sorted(["fast projection", "jacobi", "shake"])
    assert marks(strips(figure)[0]) == ["DT"] and "D = diverged, T = timeout" in words_of(figure)
    styles = styles_for([f"solver {number}" for number in range(20)], legend_of(result))
    assert len(set(looks(styles))) == 20


def test_a_letter_of_two_statuses_has_both_meanings() -> None:
    result = strain_sweep()
    result["legend"]["statuses"] = [{"name": "timeout", "letter": "X", "meaning": "too slow"},
                                    {"name": "diverged", "letter": "X", "meaning": "flew away"}]
    figure = drawn(result)["figure4a"]
    assert marks(strips(figure)[0]) == ["X"] and "X = too slow or flew away" in words_of(figure)


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
