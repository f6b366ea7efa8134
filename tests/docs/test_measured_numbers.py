"""Comments in documents: numbers follow from result files, and are renewed where only digits change."""

from __future__ import annotations

import json
import math
import random
from pathlib import Path

import pytest

import measured_numbers
from measured_numbers import critical_count, errors_in, interval_of_ratio, paragraphs, renewed_paragraph

FILE = "results/x.json"


def point(solver: str, seconds: float, runs: int = 9, **more: object) -> dict:
    samples = [seconds * (1 + 0.001 * place) for place in range(runs)]
    return {"scene": "drape", "sweep": "strain", "solver": solver, "status": "ok", "best": True, "strain_limit": 0.01, "step": 0.01,
            "vertices": 441, "seconds_per_simulated_second": {"median": seconds, "samples": samples},
            "max_strain": 0.01, "max_strain_after_collision": 0.3, "error": {"trajectory": 0.02, "gap": None}, **more}


@pytest.fixture
def results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    def write(*points: dict, noise: float | None = None) -> None:
        (tmp_path / "results").mkdir(exist_ok=True)
        context = {"noise": {"q95": noise}} if noise else {}
        (tmp_path / FILE).write_text(json.dumps({"points": points, "context": context}))
        measured_numbers.document.cache_clear()
    monkeypatch.setattr(measured_numbers, "ROOT", tmp_path)
    yield write
    measured_numbers.document.cache_clear()


def said(number: str, words: str | None = None, what: str = "jacobi / fast", quantity: str = "strain", place: str = "0.01") -> str:
    return f"It takes {words or number.split(' above')[0].split(' within')[0]} of it.\n<!-- {FILE} {quantity} drape {place}: {what} = {number} -->\n"


def test_a_number_follows_from_the_file_to_its_last_digit(results) -> None:
    results(point("jacobi", 3.49), point("fast", 1.0))
    assert errors_in(said("3.5")) == [] and errors_in(said("3.49")) == []
    assert "it is 3.49" in errors_in(said("3.6"))[0]
    assert "does not say 3.5" in errors_in(said("3.5", words="3.51"))[0]
    assert "no such point" in errors_in(said("3.5", what="shake / fast"))[0]
    assert "cannot read" in errors_in(f"<!-- {FILE} what -->")[0]


def test_contestants_are_named_not_solvers(results) -> None:
    results(point("jacobi", 3.5), point("jacobi", 9.0, contestant="jacobi_untuned"), point("fast", 1.0))
    assert errors_in(said("3.5")) == []
    assert errors_in(said("9.0", what="jacobi_untuned / fast")) == []


def test_the_faster_of_tuned_and_untuned_settings_counts_but_not_the_second_of_a_pair(results, tmp_path: Path) -> None:
    results(point("jacobi", 3.5), point("jacobi", 2.0, contestant="jacobi_untuned"), point("fast", 1.0),
            point("fast", 0.5, contestant="fast_again"), noise=0.01)
    file = tmp_path / FILE
    document = json.loads(file.read_text())
    document["legend"] = {"solvers": [{"name": "jacobi_untuned", "solver": "jacobi", "hollow": True},
                                      {"name": "fast_again", "solver": "fast", "hollow": True}]}
    document["context"]["noise"]["pair"] = ["fast", "fast_again"]
    file.write_text(json.dumps(document))
    assert errors_in(said("2.0")) == []


def test_units_and_quantities(results) -> None:
    results(point("jacobi", 0.0035), point("jacobi", 0.5, sweep="step", best=False),
            point("jacobi", 0.25, best=False, max_strain_after_collision=0.05))
    assert errors_in(said("3.5 ms", what="jacobi")) == []
    assert errors_in(said("30 %", what="jacobi", quantity="after collision")) == []
    assert errors_in(said("0.5", what="jacobi", quantity="error", place="0.03")) == []
    assert "no such point" in errors_in(said("0.5", what="jacobi", quantity="error", place="0.01"))[0]
    assert errors_in(said("0.25", what="jacobi", quantity="delivered", place="0.1")) == []


def test_an_interval_is_said_as_well(results) -> None:
    results(point("jacobi", 3.5), point("fast", 1.0), noise=math.log(1.1))
    assert errors_in(said("3.5 (3.2-3.9)")) == []
    assert "its interval is 3.18 to 3.85" in errors_in(said("3.5 (3.4-3.6)"))[0]
    assert "does not say 3.5 (3.2-3.9)" in errors_in(said("3.5 (3.2-3.9)", words="3.5"))[0]
    results(point("jacobi", 3.5, runs=3), point("fast", 1.0, runs=3))
    assert "no interval is known" in errors_in(said("3.5 (3.2-3.9)"))[0]


def test_within_the_interval_is_enough_where_the_comment_says_so(results) -> None:
    results(point("jacobi", 3.5), point("fast", 1.0), noise=math.log(1.1))
    assert errors_in(said("3.4 within interval")) == []
    assert "it is 3.5" in errors_in(said("3.1 within interval"))[0]
    assert renewed_paragraph(said("3.4 within interval")) == said("3.4 within interval")
    assert renewed_paragraph(said("3.1 within interval")) == said("3.5 within interval")


def test_words_that_say_slower_need_the_whole_interval(results) -> None:
    results(point("jacobi", 1.2), point("fast", 1.0), noise=math.log(1.1))
    assert errors_in(said("1.2 above 1")) == []
    assert "does not lie below 1" in errors_in(said("1.2 below 1"))[0]
    results(point("jacobi", 1.2), point("fast", 1.0), noise=math.log(1.3))
    assert "does not lie above 1" in errors_in(said("1.2 above 1"))[0]


# ---- --fix ----------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("old, seconds, new", [("3.5", 2.71, "2.7"), ("17", 4.28, "4.3"), ("0.58", 12.3, "12"), ("40", 99.7, "100"),
                                               ("3.5 (3.2-3.9)", 4.0, "4.0 (3.6-4.4)"), ("3.5 above 1", 2.0, "2.0 above 1")])
def test_renewed_numbers_keep_their_digits_and_are_then_right(results, old: str, seconds: float, new: str) -> None:
    results(point("jacobi", seconds), point("fast", 1.0), noise=math.log(1.1))
    assert errors_in(said(old)) != []
    assert renewed_paragraph(said(old)) == said(new)
    assert errors_in(said(new)) == [] and renewed_paragraph(said(new)) == said(new)


def test_numbers_change_places_without_mixing(results) -> None:
    results(point("jacobi", 2.0), point("icd", 3.0), point("fast", 1.0))
    text = (f"Jacobi takes 3.0, ICD 2.0 and 13.0 is another number.\n<!-- {FILE} strain drape 0.01: jacobi / fast = 3.0 -->\n"
            f"<!-- {FILE} strain drape 0.01: icd / fast = 2.0 -->\n")
    assert renewed_paragraph(text).startswith("Jacobi takes 2.0, ICD 3.0 and 13.0 is another number.")
    assert errors_in(renewed_paragraph(text)) == []


def test_what_is_not_only_digits_is_left_to_the_author(results) -> None:
    results(point("jacobi", 2.0), point("icd", 3.0), point("fast", 1.0))
    same = (f"Jacobi and ICD take 5.0.\n<!-- {FILE} strain drape 0.01: jacobi / fast = 5.0 -->\n"
            f"<!-- {FILE} strain drape 0.01: icd / fast = 5.0 -->\n")
    for text in (same, said("5.0", words="five"), said("5.0", what="shake / fast")):
        assert renewed_paragraph(text) == text and errors_in(text) != []


def test_paragraphs_add_up_to_the_text() -> None:
    text = "# One\n\n* two\n  more\n* three\n\n\nfour\n"
    assert "".join(paragraphs(text)) == text and len(paragraphs(text)) == 6


# ---- intervals: the same as those of the program --------------------------------------------------------------------

def test_critical_counts_are_those_of_tables() -> None:
    """Hollander and Wolfe, two-sided 5 %: as tests/harness/base/statistics_test.cpp has them."""
    assert [critical_count(n, n) for n in (3, 4, 5, 9)] == [0, 1, 3, 18]
    assert critical_count(1, 9) == 0


def test_an_interval_holds_the_true_factor_in_95_of_100() -> None:
    seed = 20071114
    print("seed", seed)
    source = random.Random(seed)
    inside = 0
    for _ in range(2000):
        a, b = ([factor * source.lognormvariate(0, 0.1) for _ in range(9)] for factor in (1.3, 1.0))
        low, high = interval_of_ratio(a, b, None)
        inside += low <= 1.3 <= high
    assert 0.945 <= inside / 2000 <= 0.98


def test_steps_longer_than_a_frame_do_not_count_and_marked_points_come_first(results) -> None:
    results(point("jacobi", 0.1, step=0.2), point("jacobi", 3.5, best=False), point("jacobi", 4.0), point("fast", 1.0))
    assert errors_in(said("4.0")) == []
    results(point("jacobi", 0.1, step=0.2), point("jacobi", 3.5, best=False), point("fast", 1.0))
    assert errors_in(said("3.5")) == []
