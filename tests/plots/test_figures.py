"""Every figure is drawn: its scales, labels, curves, legend, caption and failures are those that its points ask for."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgba
from matplotlib.patches import Rectangle

import figures
from documents import (STEPS, axes_with, curves, document, drawn, known_answers, legend_labels, marks, point, resolution_sweep, stability,
                       step_sweep, strain_sweep, strips, texts_outside, two_questions, words_of)
from parts.best_points import AXES, sweeps_in
from parts.result_file import contestant_of

DOCUMENTS = {"strain": strain_sweep(), "resolution": resolution_sweep(), "step": step_sweep(), "stability": stability(),
             "answers": known_answers(), "two questions": two_questions()}


def test_each_registered_figure_is_drawn_by_one_of_these_documents() -> None:
    drawn_by = set()
    for result in DOCUMENTS.values():
        legend = figures.legend_of(result)
        drawn_by |= {module.__name__ for module in figures.FIGURES if module.figures_of(result, legend)}
    assert drawn_by == {module.__name__ for module in figures.FIGURES}


def test_each_drawing_is_registered_once() -> None:
    folder = figures.Path(figures.__file__).parent / "drawings"
    files = {f"drawings.{path.stem}" for path in folder.glob("*.py")} - {"drawings.__init__"}
    names = [module.__name__ for module in figures.FIGURES]
    assert sorted(names) == sorted(files)


@pytest.mark.parametrize("name", DOCUMENTS)
def test_no_words_run_out_of_a_figure(name: str) -> None:
    for picture, figure in drawn(DOCUMENTS[name]).items():
        assert texts_outside(figure) == [], picture


# ---- numbers of the paper -------------------------------------------------------------------------------------------

@pytest.mark.parametrize("make, scene, name, title", [
    (strain_sweep, "chain", "figure4a", "Figure 4a - chain: cost over strain limit"),
    (resolution_sweep, "chain", "figure4b", "Figure 4b - chain: cost over resolution"),
    (strain_sweep, "drape", "figure5a", "Figure 5a - drape over a sphere: cost over strain limit"),
    (resolution_sweep, "drape", "figure5b", "Figure 5b - drape over a sphere: cost over resolution"),
    (strain_sweep, "flag", "flag-strain", "flag: cost over strain limit"),
    (resolution_sweep, "flag", "flag-resolution", "flag: cost over resolution"),
])
def test_figures_have_the_papers_numbers(make, scene: str, name: str, title: str) -> None:
    pictures = drawn(make(scene))
    assert pictures[name].texts[0].get_text() == title


def test_two_sizes_of_a_scene_are_two_figures() -> None:
    result = strain_sweep()
    result["points"] += [point("shake", vertices=20, limit=limit, best=True) for limit in (0.1, 0.01)]
    assert list(drawn(result)) == ["figure4a-n20", "figure4a-n80"]


# ---- cost over strain -----------------------------------------------------------------------------------------------

def test_cost_over_strain() -> None:
    figure = drawn(strain_sweep())["figure4a"]
    main, steps = axes_with(figure, ylabel="wall seconds per simulated second"), axes_with(figure, "strain limit (%)")
    assert (main.get_xscale(), main.get_yscale(), steps.get_yscale()) == ("log", "log", "log")
    assert steps.get_ylabel() == "best time step (s)"
    assert sorted(legend_labels(figure)) == sorted(["Jacobi strain limiting", "SHAKE", "fast projection"])
    found = {line.get_color(): line for line in curves(main)}
    assert len(found) == len(curves(main)) == 3
    blue = found["#0072B2"]
    assert np.allclose(blue.get_xdata(), [0.1, 1, 10])
    assert np.allclose(blue.get_ydata(), [0.01 / limit**0.5 for limit in (0.001, 0.01, 0.1)])
    assert len(found["#E69F00"].get_xdata()) == 2, "Jacobi's failed limit is no point of its curve"


def test_a_failure_has_its_letters_above_the_axes_and_in_the_caption() -> None:
    figure = drawn(strain_sweep())["figure4a"]
    (strip,) = strips(figure)
    assert [label.get_text() for label in strip.get_yticklabels()] == ["jacobi"]
    assert marks(strip) == ["DT"], "from the coarsest step to the finest"
    assert [list(line.get_xdata()) for line in strip.lines] == [[pytest.approx(0.1)]]
    assert "D = diverged, T = timeout." in words_of(figure)


def tighter_runs() -> dict:
    """At 10 % ICD's tighter run is faster than its own and stands for it, SHAKE has its tighter run alone, and Jacobi none at all.
    At 1 % SHAKE's motion is wrong by 20 %."""
    points = [point("icd", limit=0.1, seconds=0.6, id="loose"), point("icd", limit=0.01, seconds=0.4, id="tight", best=True),
              point("shake", limit=0.1, seconds=None, status="not_converged", id="failed"),
              point("shake", limit=0.01, seconds=0.2, id="wrong", error={"trajectory": 0.2}, best=True),
              point("jacobi", limit=0.1, seconds=None, status="diverged", id="j1"),
              point("jacobi", limit=0.01, seconds=None, status="timeout", id="j2")]
    cells = [{"strain_limit": limit, "error_level": level, "entries": [{"id": which} for which in (["tight"] if level else ["wrong", "tight"])]}
             for limit in (0.1, 0.01) for level in (None, 0.02)]
    plane = {"scene": "chain", "sweep": "strain", "cells": cells, "leaders": ["icd", "shake", "jacobi"]}
    return {**document(points), "analysis": {"planes": [plane], "findings": [], "growth": [], "budgets": []}}


def test_a_run_at_a_tighter_limit_stands_at_a_looser_one_too() -> None:
    result = tighter_runs()
    (paper,) = sweeps_in(result, figures.legend_of(result), "strain")
    ours = paper.within
    assert ours
    assert [(best.x, best.seconds) for best in paper.curves["icd"].best] == [(0.01, 0.4), (0.1, 0.4)]
    assert [(best.x, best.seconds) for best in paper.curves["shake"].best] == [(0.01, 0.2), (0.1, 0.2)]
    assert [(best.x, best.seconds) for best in ours.curves["icd"].best] == [(0.01, 0.4), (0.1, 0.4)]


@pytest.mark.parametrize("name", [*DOCUMENTS, "tighter runs"])
def test_no_failure_mark_appears_where_a_run_is_ok(name: str) -> None:
    result = tighter_runs() if name == "tighter runs" else DOCUMENTS[name]
    legend = figures.legend_of(result)
    for sweep, axis in AXES.items():
        for data in sweeps_in(result, legend, sweep) if "points" in result else []:
            for panel in filter(None, (data, data.within)):
                for solver, curve in panel.curves.items():
                    for failure in curve.failures:
                        there = [run for run in panel.points if contestant_of(run) == solver and run["status"] == "ok"
                                 and (run[axis] <= failure.x if axis == "strain_limit" else run[axis] == failure.x)]
                        assert all(run["error"]["trajectory"] > (panel.level or math.inf) for run in there), (solver, failure)


def test_what_is_too_wrong_is_not_called_failed() -> None:
    figure = figures.all_figures(tighter_runs())["figure4a"]()
    left, right = strips(figure)
    assert (left.get_title(loc="right"), right.get_title(loc="right")) == ("failed at every step", "failed or too wrong at every step")
    assert sorted(marks(left)) == ["D", "T"] and sorted(marks(right)) == ["D", "N", "T", "X"]


def test_what_was_measured_where_and_how_stands_beneath() -> None:
    words = words_of(drawn(strain_sweep())["figure4a"])
    assert "Scene chain: 80 vertices, gravity 9.81, 1 s simulated." in words
    assert "least of 3 samples or more; timeout 5 s; profile default; seed 1." in words
    assert "Measured on Model 7; 2 CPUs; build release; 2026-11-21 22:39; commit a2e87d4fef63." in words
    assert "box" not in words, "the host's name tells nothing of a method"


def test_warnings() -> None:
    result = strain_sweep(profile="quick")
    assert "QUICK PROFILE" in words_of(drawn(result)["figure4a"]) and "INCOMPLETE" not in words_of(drawn(result)["figure4a"])
    assert "INCOMPLETE" in words_of(drawn({**strain_sweep(), "complete": False})["figure4a"])


def test_the_two_questions_stand_side_by_side_with_one_legend() -> None:
    pictures = drawn(two_questions())
    assert list(pictures) == ["figure4a", "plane-chain", "lead-chain", "budget-chain"]
    figure = pictures["figure4a"]
    paper, ours = [axes for axes in figure.axes if axes.get_yscale() == "log" and not axes.get_xlabel()]
    assert paper.get_ylim() == ours.get_ylim() and paper.get_position().x0 < ours.get_position().x0
    chosen = [{line.get_color(): list(line.get_ydata()) for line in axes.lines} for axes in (paper, ours)]
    assert chosen[0] == {"#009E73": [0.1], "#E69F00": [0.2], "#0072B2": [0.3]}, "the analysis chose, whatever the marks say"
    assert chosen[1] == {"#009E73": [0.4], "#0072B2": [0.3]}
    assert marks(strips(figure)[0]) == ["X"] and "X = trajectory error above the limit" in words_of(figure)
    assert "any motion: the paper's question" in words_of(figure) and "error at most 2 % of the scene's size" in words_of(figure)
    assert sorted(legend_labels(figure)) == sorted(["Jacobi strain limiting", "SHAKE", "fast projection"])
    assert len(legend_labels(figure)) == len(set(legend_labels(figure)))


def test_a_figure_says_what_it_finds_and_who_does_not_lead_recedes() -> None:
    result = two_questions()
    figure = drawn(result)["figure4a"]
    assert "At 1 % strain, motion error at most 2 %, icd is the fastest." in words_of(figure) and "A second sentence." not in words_of(figure)
    assert "Grey:" not in words_of(figure)
    result["analysis"]["planes"][0]["leaders"] = ["shake", "fast_projection"]
    figure = drawn(result)["figure4a"]
    paper = next(axes for axes in figure.axes if axes.get_yscale() == "log" and not axes.get_xlabel())
    assert {line.get_color() for line in paper.lines} == {"#0072B2", "#009E73", "#BDBDBD"}
    assert sorted(legend_labels(figure)) == ["SHAKE", "fast projection"]
    assert "Grey: Jacobi strain limiting." in words_of(figure)


def test_without_an_analysis_the_sweeps_own_marks_count() -> None:
    result = document([point("shake", limit=limit, best=True, best_at_errors=[0.05, 0.02]) for limit in (0.1, 0.01)] +
                      [point("icd", limit=limit, best=True, best_at_errors=[0.05]) for limit in (0.1, 0.01)])
    pictures = drawn(result)
    assert list(pictures) == ["figure4a"]
    paper, ours = [axes for axes in pictures["figure4a"].axes if axes.get_yscale() == "log" and not axes.get_xlabel()]
    assert (len(curves(paper)), len(curves(ours))) == (2, 1)


def test_the_plane_has_the_fastest_and_its_lead_in_each_cell() -> None:
    figure = drawn(two_questions())["plane-chain"]
    words = words_of(figure)
    assert "80 vertices: who is fastest within a strain and an error" in words
    (axes,) = figure.axes
    assert [label.get_text() for label in axes.get_xticklabels()] == ["any motion", "at most 2 %"]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["1 %", "0.1 %"]
    texts = [" ".join(text.get_text().split()) for text in axes.texts]
    assert texts[:2] == ["SHAKE", "100 ms, off by 20 % one of the paper's six"]
    assert texts[2:4] == ["ICD (implicit constraint direction)", "200 ms, off by 1.2 % 1.5 x: fast projection"]
    assert texts[4:] == ["no run that was tried has a motion error of at most 2 %"] * 2
    assert [text.get_fontweight() for text in axes.texts[:4:2]] == ["normal", "bold"]


def test_the_budget_has_a_mark_where_a_limit_is_first_kept_with_the_right_motion() -> None:
    figure = drawn(two_questions())["budget-chain"]
    (axes,) = figure.axes
    marked = [(line.get_xdata()[0], to_hex(line.get_color())) for line in axes.lines if line.get_marker() == "o"]
    assert [ms for ms, _ in marked] == [2, 8] and marked[0][1] != marked[1][1]
    assert legend_labels(figure) == ["1 %", "0.1 %"]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["ICD (implicit constraint direction)"]
    assert "With no run that is right: Jacobi strain limiting." in words_of(figure)


def test_each_kind_of_method_recedes_in_its_own_colour() -> None:
    result = two_questions()
    result["analysis"]["planes"][0]["leaders"] = ["fast_projection"]
    for solver in result["legend"]["solvers"]:
        solver["origin"] = {"shake": "engine", "jacobi": "literature"}.get(solver["name"], "paper")
    figure = drawn(result)["figure4a"]
    paper = next(axes for axes in figure.axes if axes.get_yscale() == "log" and not axes.get_xlabel())
    assert {line.get_color() for line in paper.lines} == {"#0072B2", "#94CFA9", "#DDBE8B"}
    assert "Green, dotted: engines: SHAKE." in words_of(figure)
    assert "Brown, dashed: other published methods: Jacobi strain limiting." in words_of(figure)


def test_adaptive_steps_are_means() -> None:
    result = document([point("shake", limit=limit, best=True, adaptive=True, step=0.04) for limit in (0.1, 0.01)])
    figure = drawn(result)["figure4a-adaptive"]
    steps = axes_with(figure, ylabel="mean time step (s)")
    assert set(np.concatenate([line.get_ydata() for line in steps.lines])) == {0.01}, "1 s in 100 accepted steps"


def test_who_does_not_compete_needs_no_best_and_has_no_failures() -> None:
    result = strain_sweep()
    result["points"] += [point("null", limit=0.1, seconds=1e-3, status="strain_missed"),
                         point("null", limit=0.01, seconds=1e-3, status="strain_missed"),
                         point("null", limit=0.001, seconds=None, status="timeout")]
    figure = drawn(result)["figure4a"]
    assert legend_labels(figure)[-1] == "scene without inextensibility"
    assert [label.get_text() for label in strips(figure)[0].get_yticklabels()] == ["jacobi"]
    grey = [line for line in axes_with(figure, ylabel="wall seconds").lines if line.get_color() == "#7F7F7F"]
    assert [len(line.get_xdata()) for line in grey] == [2]


# ---- cost over resolution, growth -----------------------------------------------------------------------------------

def test_cost_over_resolution() -> None:
    figure = drawn(resolution_sweep())["figure5b"]
    steps = axes_with(figure, "vertices (dotted: slopes 1 and 2)")
    (main,) = [axes for axes in figure.axes if axes.get_shared_x_axes().joined(axes, steps) and axes is not steps]
    assert (main.get_xscale(), main.get_yscale()) == ("log", "log")
    assert len(curves(main)) == 3
    assert sorted(legend_labels(figure)) == sorted(["SHAKE", "ICD (implicit constraint direction)", "fast projection"])
    assert [marks(strip) for strip in strips(figure)] == [["N"]]
    assert "strain limit 1 %" in words_of(figure) and "100 to 1,600 vertices" in words_of(figure)


def test_growth_has_slopes_in_its_legend() -> None:
    sweep = resolution_sweep()
    for number, entry in enumerate(sweep["points"]):
        entry["id"] = str(number)
    plane = {"scene": "drape", "sweep": "resolution", "leaders": ["shake", "icd", "fast_projection"], "cells": [
        {"error_level": None, "entries": [{"id": entry["id"]} for entry in sweep["points"] if entry["best"]]}]}
    sweep["analysis"] = {"planes": [plane], "findings": [], "growth": [{"scene": "drape", "strain_limit": 0.01, "rows": [
        {"row": "shake", "exponent": 1.5, "sizes": 3}, {"row": "fast_projection", "exponent": 1.0, "sizes": 3},
        {"row": "icd", "exponent": 9.0, "sizes": 2}]}]}
    figure = drawn(sweep)["figure5b-growth"]
    axes = axes_with(figure, "vertices (log axes", "wall seconds of a step")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert sorted(legend_labels(figure)) == sorted(["SHAKE: 1.50", "ICD (implicit constraint direction)", "fast projection: 1.00"])
    blue = curves(axes, "#0072B2")[0]
    assert np.allclose(blue.get_ydata(), [1e-4 * vertices * 0.01 for vertices in (100, 400, 1600)]), "times the step"


# ---- step sweeps ----------------------------------------------------------------------------------------------------

def test_time_against_error() -> None:
    figure = drawn(step_sweep())["work-precision-chain"]
    axes = axes_with(figure, "trajectory error over the scene's size", "wall seconds per simulated second")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert sorted(legend_labels(figure)) == sorted(["SHAKE", "fast projection"])
    assert len(curves(axes)) == 2
    assert marks(strips(figure)[0]) == ["L"], "no step finer than SHAKE's best failed: its ladder ended"
    assert "L = the ladder ended" in words_of(figure) and "Errors up to t = 0.5 s" in words_of(figure)


def test_errors_that_the_reference_cannot_tell_are_hollow() -> None:
    result = document([point("shake", "step", step=step, seconds=1e-3 / step,
                             error={"trajectory": step, "gap": 0.004, "valid_until": 1.0}) for step in STEPS])
    axes = axes_with(drawn(result)["work-precision-chain"], "trajectory error")
    hollow = [line for line in axes.lines if line.get_markerfacecolor() == "white"]
    assert [list(line.get_xdata()) for line in hollow] == [[0.01]]
    (curve,) = curves(axes, "#009E73")
    assert [curve.get_xdata()[place] for place in curve.get_markevery()] == [0.02, 0.04], "no filled mark beneath"


def test_residual_of_whoever_has_one() -> None:
    figure = drawn(step_sweep(residuals_of=("shake",)))["residual-chain"]
    assert words_of(figure).startswith("chain: residual of SHAKE Scene chain")
    over_time, over_step = axes_with(figure, "time (s)", "mean |F| (m)"), axes_with(figure, "time step (s)")
    assert over_time.get_yscale() == over_step.get_xscale() == over_step.get_yscale() == "log"
    assert len(over_time.lines) == 4 and {line.get_color() for line in over_time.lines} == {"#009E73"}
    assert [text.get_text() for text in over_step.get_legend().get_texts()] == ["first iteration: slope 2.00",
                                                                                "last iteration: slope 3.00"]
    assert "strain limit 0.01 %" in words_of(figure), "the tightest limit"


def test_two_solvers_with_residuals_have_a_figure_each() -> None:
    names = list(drawn(step_sweep(residuals_of=("fast_projection", "shake"))))
    assert [name for name in names if "residual" in name] == ["residual-fast_projection-chain", "residual-shake-chain"]
    assert not any("residual" in name for name in drawn(step_sweep(residuals_of=())))


# ---- stability ------------------------------------------------------------------------------------------------------

def test_matrix_of_hard_cases() -> None:
    figure = drawn(stability())["matrix"]
    (axes,) = figure.axes
    words = [text.get_text() for text in axes.texts]
    assert words[:2] == ["SHAKE", "fast projection"]
    assert {"Q1", "whip", "S", "R  E0.6", "S1 D1 !", "1/4", "none", "chain of 20"} <= set(words)
    frames = {text: patch for text in ("S1 D1 !", "R  E0.6") for patch in axes.patches if isinstance(patch, Rectangle)
              for box in [axes.texts[words.index(text)].get_position()]
              if patch.get_x() < box[0] < patch.get_x() + patch.get_width()
              and patch.get_y() < box[1] < patch.get_y() + patch.get_height()}
    assert to_hex(frames["S1 D1 !"].get_facecolor()).upper() == "#C2553B", "the colour of the worst outcome"
    assert frames["S1 D1 !"].get_edgecolor() == to_rgba("black") and frames["S1 D1 !"].get_linewidth() == 2
    assert frames["R  E0.6"].get_linewidth() < 1
    assert "1 outcomes are not as their cases expect" in words_of(figure) and "D = diverged" in words_of(figure)
    assert "3 of 4 admit one outcome only, 1 two" in words_of(figure)


def test_outcomes_are_those_of_the_legend() -> None:
    result = stability()
    result["legend"]["statuses"] = [{"name": name, "letter": letter, "meaning": f"it {name}"} for name, letter in
                                    (("survived", "v"), ("refused", "x"), ("diverged", "y"))]
    figure = drawn(result)["matrix"]
    assert "v1 y1 !" in [text.get_text() for text in figure.axes[0].texts]
    assert "v = it survived, x = it refused, y = it diverged" in words_of(figure)


# ---- known answers --------------------------------------------------------------------------------------------------

def test_known_answers_have_a_panel_each_and_a_curve_for_each_solver() -> None:
    pictures = drawn(known_answers())
    assert list(pictures) == ["deviations"]
    panels = [axes for axes in pictures["deviations"].axes if axes.get_xlabel() == "time step (s)"]
    assert [axes.get_title(loc="left") for axes in panels] == ["baton: distance"] * 2
    for axes in panels:
        lengths = sorted(len(line.get_xdata()) for line in curves(axes))
        assert lengths == [2, 3]
        assert axes.get_xscale() == axes.get_yscale() == "log"
    assert len(legend_labels(pictures["deviations"])) == 2
