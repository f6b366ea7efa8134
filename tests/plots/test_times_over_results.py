"""The figure of many files: how times change from one result to the next."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
import pytest

from documents import Json, axes_with, curves, document, legend_labels, point, stability, texts_outside, words_of, written
from drawings.times_over_results import draw, entries_in
from parts.result_file import ResultError
from parts.style import RC


def result(day: int, times: dict[tuple[str, str, float], float], cpu: str = "Model 7") -> Json:
    made = document([point(solver, scene=scene, limit=limit, seconds=seconds, best=True)
                     for (solver, scene, limit), seconds in times.items()])
    made["context"] |= {"date": f"2026-11-{day:02}T12:00:00+00:00", "cpu_model": cpu}
    return made


def figure_of(folder: Path) -> matplotlib.figure.Figure:
    with matplotlib.rc_context(RC):
        figure = draw(entries_in(folder))
        figure.canvas.draw()
    return figure


def test_ratios_in_the_order_of_dates(tmp_path: Path) -> None:
    places = [("shake", "chain", 0.1), ("shake", "chain", 0.01), ("jacobi", "chain", 0.1), ("shake", "drape", 0.1)]
    written(result(3, {places[0]: 4.0, places[2]: 1.0}, cpu="Model 8"), tmp_path, "a.json")
    written(result(1, dict.fromkeys(places, 1.0)), tmp_path, "b.json")
    written(result(2, {places[0]: 2.0, places[1]: 0.5, places[2]: 3.0, places[3]: 1.0}), tmp_path, "c.json")
    written(stability(), tmp_path, "stability.json")
    figure = figure_of(tmp_path)
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["chain", "drape"]
    chain = axes_with(figure, ylabel="time over that of the first result")
    assert (chain.get_xscale(), chain.get_yscale()) == ("linear", "log")
    found = {line.get_color(): list(line.get_ydata()) for line in curves(chain)}
    assert np.allclose(found["#009E73"], [1, 1, 2]), "2 and 0.5 cancel; then twice as slow where both ran"
    assert np.allclose(found["#E69F00"], [1, 3, 1])
    assert legend_labels(figure) == ["Jacobi strain limiting", "SHAKE"]
    changes = [line.get_xdata()[0] for line in chain.lines if line.get_color() == "#7F7F7F" and len(set(line.get_xdata())) == 1]
    assert changes == [1.5] and "another machine" in words_of(figure)
    assert texts_outside(figure) == []


def test_the_newest_legend_counts(tmp_path: Path) -> None:
    for day, label in ((1, "old name"), (2, "new name")):
        made = result(day, {("shake", "chain", 0.1): 1.0})
        made["legend"]["solvers"] = [{"name": "shake", "label": label, "family": "shake", "contestant": True}]
        written(made, tmp_path, f"{day}.json")
    assert legend_labels(figure_of(tmp_path)) == ["new name"]


@pytest.mark.parametrize("date", ["yesterday", None, "0001-01-01T00:00:00+14:00"])
def test_a_bad_date_is_an_error(tmp_path: Path, date: object) -> None:
    made = result(1, {("shake", "chain", 0.1): 1.0})
    made["context"]["date"] = date
    written(made, tmp_path)
    with pytest.raises(ResultError, match="no date"):
        entries_in(tmp_path)
