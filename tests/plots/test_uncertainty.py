"""Figures say how far they can be trusted: intervals, the A/A pair's noise, untuned settings, ends of ladders, failures by energy,
and what is left after collisions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from documents import (Json, axes_with, curves, document, drawn, legend_labels, marks, point, step_sweep, strain_sweep, strips,
                       texts_outside, words_of)
from parts.result_file import spread_in, time_in

FILTER = "filter_seconds_per_simulated_second"
GREEN = "#009E73"


def timed(made: Json, seconds: float, spread: float = 0.01, runs: int = 9) -> Json:
    """The least sample takes `seconds`."""
    samples = [seconds * (1 + spread * place) for place in range(runs)]
    return {**made, "seconds_per_simulated_second": {"median": float(np.median(samples)), "samples": samples[::-1]}}


def with_pair(result: Json, q95: float = 0.2) -> Json:
    """Every point of fast projection once more, as its double, twice as slow."""
    again = [{**made, "contestant": "fast_projection_again"} for made in result["points"] if made["solver"] == "fast_projection"]
    result["points"] += [timed(made, 99.0) for made in again]
    result["context"]["noise"] = {"pair": ["fast_projection", "fast_projection_again"], "places": 3, "median": 0.1, "q95": q95}
    return result


def noise_bars(axes: Axes) -> list[Any]:
    return [line for line in axes.lines if line.get_gid() == "noise"]


def steps_arrows(figure: Figure) -> list[str]:
    axes = axes_with(figure, ylabel="best time step (s)")
    return [text.get_text() for text in axes.texts if text.get_text() in "\u2191\u2193"]


# ---- intervals ------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("runs, places", [(1, None), (2, None), (3, 1), (8, 3.5), (9, 4)])
def test_the_time_is_the_least_sample_and_the_spread_goes_to_the_median(runs: int, places: float | None) -> None:
    made = timed({}, 2.0, runs=runs)
    assert time_in(made, "seconds_per_simulated_second") == 2.0
    found = spread_in(made, "seconds_per_simulated_second")
    assert found == (None if places is None else (pytest.approx(2.0), pytest.approx(2.0 * (1 + 0.01 * places))))


def test_files_without_samples_are_read() -> None:
    assert time_in({"t": {"min": 1.0, "median": 2.0}}, "t") == 1.0
    assert time_in({"t": {"median": 2.0}}, "t") == 2.0
    assert time_in({"t": None}, "t") is None


def test_bars_go_from_the_least_sample_to_the_median() -> None:
    figure = drawn(document([timed(point("shake", limit=limit, best=True), 2.0) for limit in (0.1, 0.01)]))["figure4a"]
    main = axes_with(figure, ylabel="wall seconds")
    (segments,) = [collection.get_segments() for collection in main.collections]
    assert [[y for _, y in segment] for segment in segments] == [[pytest.approx(2.0), pytest.approx(2.08)]] * 2
    assert "bars: up to their median" in words_of(figure)


def test_without_samples_there_are_no_bars_and_the_caption_says_what_is_missing() -> None:
    words = words_of(drawn(strain_sweep())["figure4a"])
    assert "bars" not in words and "No A/A pair" in words


# ---- the A/A pair ---------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("make, name", [(strain_sweep, "figure4a"), (step_sweep, "work-precision-chain")])
def test_the_pair_is_a_bar_of_noise_and_no_curve(make: Any, name: str) -> None:
    figure = drawn(with_pair(make()))[name]
    assert not any("again" in label for label in legend_labels(figure))
    main = axes_with(figure, ylabel="wall seconds")
    (bar,) = noise_bars(main)
    low, high = bar.get_ydata()
    assert high / low == pytest.approx(math.exp(0.2))
    assert max(max(line.get_ydata()) for line in curves(main) if line is not bar) < 90
    assert noise_bars(axes_with(drawn(make())[name], ylabel="wall seconds")) == []


def test_noise_is_explained() -> None:
    assert "Bar in the corner: how far apart one solver is from itself" in words_of(drawn(with_pair(strain_sweep()))["figure4a"])


# ---- marks ----------------------------------------------------------------------------------------------------------

def test_untuned_contestants_are_hollow_beside_their_tuned_selves_and_absent_where_hollow_means_error() -> None:
    for make, name in ((strain_sweep, "figure4a"), (step_sweep, "work-precision-chain")):
        result = make()
        result["points"] += [{**made, "contestant": "shake_untuned"} for made in result["points"] if made["solver"] == "shake"]
        result["legend"]["solvers"].append({"name": "shake_untuned", "label": "SHAKE, untuned", "family": "shake",
                                            "contestant": True, "solver": "shake", "unranked": True})
        figure = drawn(result)[name]
        green = [line for line in curves(axes_with(figure, ylabel="wall seconds"), GREEN)]
        hollow = [line.get_markerfacecolor() == "none" for line in green]
        if name == "figure4a":
            assert sorted(hollow) == [False, True] and "SHAKE, untuned" in legend_labels(figure)
            assert "Hollow marks: untuned settings, not ranked." in words_of(figure)
        else:
            assert hollow == [False] and "SHAKE, untuned" not in legend_labels(figure)


def test_steps_at_the_ladders_ends_have_arrows() -> None:
    ends = {0.1: "coarsest", 0.01: "finest", 0.001: ""}
    result = document([point("shake", limit=limit, best=True, at_ladder_end=end) for limit, end in ends.items()])
    figure = drawn(result)["figure4a"]
    assert sorted(steps_arrows(figure)) == ["\u2191", "\u2193"]
    assert "Arrow at a step: it is the coarsest (up) or the finest (down)" in words_of(figure)
    assert texts_outside(figure) == []
    assert steps_arrows(drawn(strain_sweep())["figure4a"]) == []


def test_runs_that_gain_energy_have_their_letter() -> None:
    result = strain_sweep(solvers=("fast_projection",))
    result["legend"]["statuses"].append({"name": "energy_gained", "letter": "E", "meaning": "made energy out of nothing"})
    result["points"] += [point("shake", limit=limit, status="energy_gained") for limit in (0.1, 0.01)]
    figure = drawn(result)["figure4a"]
    assert marks(strips(figure)[0]) == ["E", "E"]
    assert "E = made energy out of nothing." in words_of(figure)
    assert len(curves(axes_with(figure, ylabel="wall seconds"))) == 1, "its times are no points"


# ---- colliders ------------------------------------------------------------------------------------------------------


def test_chains_have_no_second_figure() -> None:
    assert not any("delivered" in name for name in drawn(strain_sweep()))


@pytest.mark.parametrize("sweep, name", [("strain", "figure5a"), ("resolution", "figure5b")])
def test_the_filters_own_time_has_a_panel_where_a_collider_takes_part(sweep: str, name: str) -> None:
    points = [point("shake", sweep, "drape", vertices, limit, best=True, seconds=2.0, max_strain_after_collision=0.1,
                    **{FILTER: {"median": 0.5, "samples": [0.5] * 9}})
              for vertices, limit in ((441, 0.1), (441, 0.01)) if sweep == "strain"] or [
        point("shake", sweep, "drape", vertices, best=True, seconds=2.0, max_strain_after_collision=0.1,
              **{FILTER: {"median": 0.5, "samples": [0.5] * 9}}) for vertices in (100, 400)]
    figure = drawn(document(points))[name]
    (curve,) = curves(axes_with(figure, ylabel="filter alone (s)"))
    assert list(curve.get_ydata()) == [0.5, 0.5]
    assert texts_outside(figure) == []
    without = drawn(document([{**made, FILTER: None} for made in points]))[name]
    assert not any("filter alone" in axes.get_ylabel() for axes in without.axes)
    chain = drawn(document([{**made, "scene": "chain", "max_strain_after_collision": None} for made in points]))
    assert not any("filter alone" in axes.get_ylabel() for figure in chain.values() for axes in figure.axes)


def test_errors_say_until_when_they_count() -> None:
    result = step_sweep()
    for made, until in zip(result["points"], (0.1, 0.7, 0.3)):
        made["error"] |= {"error_until": until} if made["status"] == "ok" else {}
    words = words_of(drawn(result)["work-precision-chain"])
    assert "more than three times the reference's own uncertainty, up to t = 0.7 s." in words and "0.5 s" not in words
