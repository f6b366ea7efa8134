"""Figures show what their runs ask for: scales, curves, names, failures, uncertainty and words; and hostile names do no harm."""

import copy
import json
import re
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import matplotlib
import numpy as np
import pytest

import figures
from documents import (ROOT, Json, analysed, axes_with, committed, curves, document, drawn, fits, known_answers, legend_labels, marks,
                       panels, point, resolution_sweep, stability, step_sweep, strain_sweep, strips, timing, two_questions, words)
from parts.curves import curves_in
from parts.style import RC

BLUE, GREEN, ORANGE = "#0072B2", "#009E73", "#E69F00"  # of fast projection, SHAKE and Jacobi
DOCUMENTS = {"strain": strain_sweep(), "resolution": resolution_sweep(), "step": step_sweep(), "stability": stability(),
             "answers": known_answers(), "two questions": two_questions()}
HOSTILE = {
    "formula": r"$\frac{1}{2$ and $x^$",
    # Escapes, markup, a path, and what turns the direction of writing.
    "signs": "\\n\\x{41} %s {0} $\\alpha$ <script>alert(1)</script>-->]]>&amp; ../../etc/$HOME x \u202eabc",
    "lines": "one\ntwo\r\nthree\ttab\x00\x07\u2028end", "long": "W" * 500, "words": "wide words " * 50, "blank": " \n "}


def renamed(result: Json, name: str) -> Json:
    """Every text that a figure could show becomes the hostile one, each solver's with an ending of its own."""
    result = copy.deepcopy(result)
    for entry in result["legend"]["solvers"]:
        entry |= {key: f"{name}{entry[key]}" for key in ("name", "label", "family")}
    for made in result.get("points", []):
        made |= {"scene": name, "solver": f"{name}{made['solver']}", "contestant": f"{name}{made['contestant']}", "status_detail": name}
    for cell in result.get("matrix", []):
        cell |= {"row": f"{name}{cell['row']}", "case": name, "solver": f"{name}{cell['solver']}"}
    result["context"] |= {"cpu_model": name, "host_name": name, "date": name}
    result["context"]["build"]["git"] = name
    return result


@pytest.fixture(scope="module")
def pictures() -> dict[str, dict]:
    return {name: drawn(result) for name, result in DOCUMENTS.items()}


def test_each_drawing_is_registered_and_drawn_by_one_of_these_documents() -> None:
    files = {f"drawings.{path.stem}" for path in (ROOT / "plots/drawings").glob("*.py")} - {"drawings.__init__"}
    results = [analysed(result) for result in DOCUMENTS.values()]
    assert [module.__name__ for module in figures.FIGURES if any(map(module.figures_of, results))] == [m.__name__ for m in figures.FIGURES]
    assert {module.__name__ for module in figures.FIGURES} == files


def test_no_words_run_out_of_a_figure(pictures: dict) -> None:
    assert [name for all_of in pictures.values() for name, figure in all_of.items() if not fits(figure)] == []


@pytest.mark.parametrize("result, names", [
    (resolution_sweep("flag"), ["flag-resolution"]),
    (document([point("shake", vertices=n, limit=limit, best=True, error={"trajectory": 0.2}) for n in (20, 80) for limit in (0.1, 0.01)]),
     ["figure4a-n20", "figure4a-n80", "plane-chain-n20", "plane-chain-n80"]),
    (document([point("shake", scene=scene, best=True, error={"trajectory": 0.2}) for scene in ("a/b", "a:b")]),
     ["a_b-strain", "a_b-strain-2", "plane-a_b", "plane-a_b-2"])])
def test_each_figure_has_a_file_of_its_own(result: Json, names: list[str]) -> None:
    assert list(figures.all_figures(analysed(result))) == names


def test_cost_over_strain(pictures: dict) -> None:
    figure = pictures["strain"]["figure4a-all"]
    main = axes_with(figure, ylabel="wall seconds per simulated second")
    found = {line.get_color(): line for line in curves(main)}
    assert len(found) == len(curves(main)) == 3
    assert np.allclose(found[BLUE].get_xdata(), [0.1, 1, 10])
    assert np.allclose(found[BLUE].get_ydata(), [0.01 / limit**0.5 for limit in (0.001, 0.01, 0.1)])
    assert len(found[ORANGE].get_xdata()) == 2, "Jacobi's failed limit is not a point of its curve"
    (strip,) = strips(figure)
    assert [label.get_text() for label in strip.get_yticklabels()] == ["Jacobi strain limiting"]
    assert marks(strip) == ["DT"], "from the coarsest step to the finest"


def test_the_fastest_run_of_any_motion_and_of_motion_that_is_right(pictures: dict) -> None:
    assert list(pictures["two questions"]) == ["figure4a", "figure4a-all", "plane-chain"]
    chosen = [{line.get_color(): line.get_ydata()[-1] for line in curves(axes)} for axes in panels(pictures["two questions"]["figure4a"])]
    assert (chosen[0][GREEN], chosen[1][GREEN]) == (0.1, 0.4)


def test_cost_over_resolution(pictures: dict) -> None:
    figure = pictures["resolution"]["figure5b-all"]
    assert [len(curves(axes)) for axes in panels(figure)] == [3, 3]
    assert [marks(strip) for strip in strips(figure)] == [["N"], ["N"]]


@pytest.mark.parametrize("profile, complete, warning", [("quick", True, "QUICK PROFILE"), ("default", False, "INCOMPLETE")])
def test_warnings(profile: str, complete: bool, warning: str) -> None:
    told = words(drawn({**strain_sweep(profile=profile), "complete": complete})["figure4a"])
    assert [part in told for part in ("QUICK PROFILE", "INCOMPLETE")] == [warning == "QUICK PROFILE", warning == "INCOMPLETE"]


@pytest.mark.parametrize("make, name", [(strain_sweep, "figure4a"), (resolution_sweep, "figure5b"), (step_sweep, "work-precision-chain")])
def test_the_noise_of_a_pair_is_told_and_the_second_no_curve(make, name: str) -> None:
    result = make()
    assert "A/A pair" not in words(drawn(result)[name]).replace("No A/A pair", "")
    result["points"] += [{**made, "contestant": "fast_projection_again", "id": made["id"] + "again", "seconds_per_simulated_second": timing(99.0)}
                         for made in result["points"] if made["solver"] == "fast_projection"]
    result["context"]["noise"] = {"pair": ["fast_projection", "fast_projection_again"], "places": 3, "median": 0.1, "q95": 0.2}
    assert "within 22 % (A/A pair)" in words(drawn(result)[name])  # e^0.2
    assert not any("again" in label for label in [words(drawn(result)[name]), *legend_labels(drawn(result)[f"{name}-all"])])


RUNS = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((ROOT / "results").glob("*.json"))]
COSTS = [result for result in RUNS if any(made["sweep"] in ("strain", "resolution") for made in result.get("points", []))]


@pytest.mark.parametrize("document_of", COSTS, ids=lambda result: result["context"]["suite"]["name"])
def test_of_the_committed_results(document_of: Json) -> None:
    """Nothing that is marked as failed has a run that counts there, or at a tighter limit; the first figures are short and name methods
    as people do."""
    result = analysed(document_of)
    for figure in result.analysis["curves"]:
        axis, fixed = ("vertices", "strain_limit")[::1 if figure["sweep"] == "resolution" else -1]
        for panel, most in (("any", np.inf), ("within", result.analysis["headline_error"])):
            failed = [(name, x) for name, curve in curves_in(figure[panel] or {}, result).items() for x, _ in curve.failures]
            assert not [(made["id"], x) for made in result.points for name, x in failed
                        if result.at_any_settings(made["contestant"]) == name and made["status"] == "ok" and made["scene"] == figure["scene"]
                        and (made["error"]["trajectory"] or 0) <= most and made[fixed] == figure["fixed"] and made["sweep"] == figure["sweep"]
                        and (made[axis] == x or made[axis] < x and axis == "strain_limit")]
    with matplotlib.rc_context(RC):
        for name, draw in figures.all_figures(result).items():
            drawing = draw()
            assert not [solver for solver in result.solvers if re.search(rf"(?<![\w@]){solver}(?![\w@])", words(drawing)) and {"_", "@"} & {*solver}]
            assert "plane" in name or len(panels(drawing)) <= 2 and all(len(axes.texts) <= 8 for axes in panels(drawing))


def test_a_plug_in_leads_beside_the_papers_and_the_best_of_others() -> None:
    names = ("fast_projection", "shake", "yarn_projection@bdf2", "fast_projection_adaptive@bdf2", "rattle", "admm", "mine")
    result = document([point(name, seconds=1 + place, best=True) for place, name in enumerate(names)])
    result["legend"]["solvers"].append({**result["legend"]["solvers"][0], "name": "mine", "label": "my own", "family": "mine", "origin": "elsewhere"})
    pictures = drawn(result)
    assert sorted(text.get_text().replace("\n", " ") for text in panels(pictures["figure4a"])[0].texts) == sorted(
        ["fast projection", "SHAKE", "yarn projection in BDF2", "RATTLE", "my own"])
    assert "my own" in legend_labels(pictures["figure4a-all"])


def test_time_against_error(pictures: dict) -> None:
    figure = pictures["step"]["work-precision-chain"]
    axes = axes_with(figure, "trajectory error over the scene's size", "wall seconds per simulated second")
    assert len(curves(axes)) == 2


@pytest.mark.parametrize("solvers, names", [((), []), (("shake",), ["residual-chain"]),
                                            (("fast_projection", "shake"), ["residual-fast_projection-chain", "residual-shake-chain"])])
def test_residuals_of_those_that_have_one(solvers: tuple[str, ...], names: list[str]) -> None:
    pictures = {name: figure for name, figure in drawn(step_sweep(residuals_of=solvers)).items() if "residual" in name}
    assert list(pictures) == names
    for name, figure in pictures.items():
        over_time, over_step = axes_with(figure, "time (s)", "mean |F| (m)"), axes_with(figure, "time step (s)")
        assert len(over_time.lines) == 4
        assert [text.get_text() for text in over_step.get_legend().get_texts()] == ["first iteration: slope 2.00",
                                                                                    "last iteration: slope 3.00"]


def test_matrix_of_hard_cases(pictures: dict) -> None:
    figure = pictures["stability"]["matrix"]
    (matrix,) = figure.axes
    assert [label.get_text() for label in matrix.get_yticklabels()] == ["SHAKE", "fast projection"]
    assert [label.get_text() for label in matrix.get_xticklabels()] == ["Q1", "whip"]
    framed = {text.get_text(): patch.get_linewidth() > 1 for text, patch in zip(matrix.texts, matrix.patches)}
    assert framed == {"R": False, "D": True, "S": False}, "the worst of each row; a thick frame: not as expected"
    assert "1 of 2" in words(figure)


def test_known_answers_have_a_panel_each_and_a_curve_for_each_solver(pictures: dict) -> None:
    figure = pictures["answers"]["deviations"]
    panels_of_answers = [axes for axes in figure.axes if axes.get_xlabel() == "time step (s)"]
    assert [axes.get_title(loc="left") for axes in panels_of_answers] == ["place: distance", "rate: distance"], "what tells the two apart"
    for axes in panels_of_answers:
        assert sorted(len(line.get_xdata()) for line in curves(axes)) == [2, 3]
    assert len(figure.legends[0].get_texts()) == 2
    assert "SHAKE comes closest in 2 of 2" in words(figure)


@pytest.mark.parametrize("name", [solver["name"] for solver in committed("figure1.json")["legend"]["solvers"]])
def test_no_code_knows_a_solver_by_name(name: str) -> None:
    assert [path.name for path in (ROOT / "plots").rglob("*.py") if f'"{name}"' in path.read_text(encoding="utf-8")] == []


@pytest.mark.parametrize("kind", HOSTILE)
@pytest.mark.parametrize("document_of", ["strain", "resolution", "step", "stability"])
def test_hostile_names_do_no_harm(document_of: str, kind: str, tmp_path: Path) -> None:
    pictures = drawn(renamed(DOCUMENTS[document_of], HOSTILE[kind]))
    assert pictures
    for name, figure in pictures.items():
        assert fits(figure), name
        assert Path(name).name == name and len(name) < 200
        target = tmp_path / f"{name}.svg"
        figure.savefig(target)
        for element in xml.parse(target).iter():
            assert not str(element.tag).endswith("script"), name
            assert not any(attribute.lower().startswith("on") for attribute in element.attrib), name


def test_the_program_names_the_files_it_wrote_and_writes_the_same_twice(tmp_path: Path) -> None:
    (tmp_path / "result.json").write_text(json.dumps(analysed(strain_sweep()).document))
    written = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        ran = subprocess.run([sys.executable, ROOT / "plots/figures.py", tmp_path / "result.json", "--out", tmp_path / name],
                             capture_output=True, text=True, check=False)
        assert (ran.returncode, ran.stderr) == (0, "")
        assert ran.stdout.split()[0] == str(tmp_path / name / "result-figure4a.svg")
        written.append([Path(path).read_bytes() for path in ran.stdout.split()])
    assert written[0] == written[1]
