"""Files that bench would not write: hostile names do no harm, and what cannot be drawn is one line and exit code 2."""

from __future__ import annotations

import copy
import json
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path
from typing import Any, Iterator

import pytest

import figures
from documents import (ROOT, Json, document, drawn, legend_labels, point, resolution_sweep, stability, step_sweep, strain_sweep,
                       texts_outside, written)
from parts.program import exit_code
from parts.result_file import ResultError, load
from parts.words import inches, shorten, wrap

SCRIPT = ROOT / "plots" / "figures.py"
HOSTILE = {
    "formula": r"$\frac{1}{2$ and $x^$",
    # Escapes, markup, a path, half a character, and what turns the direction of writing.
    "signs": "\\n\\x{41} %s {0} $\\alpha$ <script>alert(1)</script>-->]]>&amp; ../../etc/$HOME \ud800x \u202eabc",
    "lines": "one\ntwo\r\nthree\ttab\x00\x07\u2028end", "long": "W" * 500, "words": "wide words " * 50, "blank": " \n ",
}
SWEEPS = {"strain": strain_sweep, "resolution": resolution_sweep, "step": step_sweep}


def renamed(result: Json, name: str) -> Json:
    """Every text that a figure could show becomes the hostile one, each solver's with an ending of its own."""
    result = copy.deepcopy(result)
    for entry in result["legend"].get("solvers", []):
        entry |= {"name": f"{name}{entry['name']}", "label": f"{name}{entry['label']}", "family": f"{name}{entry['family']}"}
    for entry in result["legend"].get("statuses", []):
        entry |= {"letter": name, "meaning": name}
    for made in result.get("points", []):
        made |= {"scene": name, "solver": f"{name}{made['solver']}", "status_detail": name}
        made["scene_parameters"] = {name: name, "n": [name, 1]}
    for cell in result.get("matrix", []):
        cell |= {"row": f"{name}{cell['row']}", "case": name, "solver": f"{name}{cell['solver']}"}
    for entry in result.get("largest_steps", []):
        entry |= {"scene": name, "solver": f"{name}{entry['solver']}"}
    result["context"] |= {"cpu_model": name, "host_name": name, "library_build_type": name, "date": name, "seed": name}
    result["context"]["build"]["git"] = name
    result["context"]["suite"]["profile"] = name
    return result


def run(script: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["/usr/bin/python3", script, *map(str, arguments)], capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize("kind", HOSTILE)
@pytest.mark.parametrize("sweep", [*SWEEPS, "stability"])
def test_hostile_names_do_no_harm(sweep: str, kind: str, tmp_path: Path) -> None:
    result = renamed(SWEEPS[sweep]() if sweep in SWEEPS else stability(), HOSTILE[kind])
    path = tmp_path / "result.json"
    path.write_text(json.dumps(result))
    pictures = drawn(load(path))
    assert pictures
    for name, figure in pictures.items():
        assert texts_outside(figure) == [], name
        assert Path(name).name == name and len(name) < 200
        target = tmp_path / f"{name}.svg"
        figures.save(figure, target)
        for element in xml.parse(target).iter():
            assert not str(element.tag).endswith("script"), name
            assert not any(attribute.lower().startswith("on") for attribute in element.attrib), name
        assert "<script" not in target.read_text(encoding="utf-8")
    assert {file.name for file in tmp_path.iterdir()} == {"result.json", *(f"{name}.svg" for name in pictures)}


def test_names_that_files_cannot_tell_apart_get_a_file_each() -> None:
    result = document([point("shake", scene=scene, limit=limit, best=True) for scene in ("a/b", "a:b") for limit in (0.1, 0.01)])
    assert list(drawn(result)) == ["a_b-strain", "a_b-strain-2"]


def test_many_solvers_with_long_names_have_room() -> None:
    solvers = tuple(f"{'long words ' * 12}{number}" for number in range(30))
    for make in (strain_sweep, resolution_sweep):
        for name, figure in drawn(make(solvers=solvers)).items():
            assert len(legend_labels(figure)) == 30 and texts_outside(figure) == [], name


# ---- one line and exit code 2 -----------------------------------------------------------------------------------------

def good(**changes: Any) -> Json:
    return document([point("shake", best=True) | changes])


BAD: dict[str, tuple[Any, str]] = {
    "no JSON": ("{", "is not valid JSON"),
    "a constant": ('{"schema": NaN}', "NaN is not a JSON number"),
    "a list": ([], "is not a result file"),
    "another schema": ({"schema": "x/2"}, "schema is \"x/2\""),
    "a long schema": ({"schema": "x" * 10000}, "is not a result file"),
    "no points": ({"schema": "inextensible-bench/1"}, "no list of points"),
    "empty": (document([]), "no points to draw"),
    "a number as point": (document([3]), "points[0] is not an object"),
    "no solver": (good(solver=None), "points[0] has no solver"),
    "no status": (good(status=3), "points[0] has no status"),
    "vertices": (good(vertices=0), "positive number as vertices"),
    "endless": (good(strain_limit=1e300), "positive number as strain_limit"),
    "best without time": (good(seconds_per_simulated_second=None), "no positive time"),
    "legend": ({**good(), "legend": 3}, "legend is not an object"),
    "untimed": ({**good(), "context": {"timed": False}}, "made with --untimed"),
    "legend of words": ({**good(), "legend": {"solvers": ["shake"]}}, "legend.solvers is not a list of objects"),
    "matrix": ({"schema": "inextensible-stability/1"}, "no list of matrix"),
    "cell": ({"schema": "inextensible-stability/1", "matrix": [{}], "largest_steps": []}, "matrix[0] needs the texts"),
    "no cells": ({"schema": "inextensible-stability/1", "matrix": [], "largest_steps": []}, "no case was run"),
}


@pytest.mark.parametrize("what", BAD)
def test_a_bad_file_is_one_line_and_exit_code_2(what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str],
                                                monkeypatch: pytest.MonkeyPatch) -> None:
    content, message = BAD[what]
    path = tmp_path / "bad.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    monkeypatch.setattr(sys, "argv", ["figures.py", str(path), "--out", str(tmp_path)])
    assert exit_code(figures.run) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1 and said.err.startswith("figures.py: ") and len(said.err) < 500
    assert message in said.err


def leaves(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value[:1]) if isinstance(value, list) else ()
    for key, inner in items:
        yield from leaves(inner, (*path, key))


def corrupted(result: Json, path: tuple[Any, ...], value: Any) -> Json:
    result = copy.deepcopy(result)
    inner = result
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return result


@pytest.mark.parametrize("sweep", [*SWEEPS, "stability"])
def test_whatever_one_field_holds_the_file_is_drawn_or_refused(sweep: str, tmp_path: Path) -> None:
    """Every field of the first points becomes something else, in turn."""
    small = SWEEPS[sweep]() if sweep in SWEEPS else stability()
    odd = (None, True, -1, 0, 1e300, 10**400, "text", [], [[]], {}, {"a": [1]})
    outcomes = {"drawn": 0, "refused": 0}
    with figures.matplotlib.rc_context(figures.RC):
        for number, path in enumerate(leaves(small)):
            value = odd[number % len(odd)]
            try:
                for draw in figures.all_figures(load(written(corrupted(small, path, value), tmp_path))).values():
                    draw()
                outcomes["drawn"] += 1
            except ResultError:
                outcomes["refused"] += 1
            except Exception as error:
                raise AssertionError(f"{path} = {value!r}") from error
    assert outcomes["drawn"] > 10 and outcomes["refused"] > 3


# ---- the programs -----------------------------------------------------------------------------------------------------

def test_the_program_names_the_files_it_wrote_and_writes_the_same_twice(tmp_path: Path) -> None:
    path = written(strain_sweep(), tmp_path)
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    first, second = run(SCRIPT, path, "--out", tmp_path / "one"), run(SCRIPT, path, "--out", tmp_path / "two")
    assert (first.returncode, first.stderr) == (0, "")
    name = "result-figure4a.svg"
    assert first.stdout.split() == [str(tmp_path / "one" / name)]
    assert second.returncode == 0
    assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_the_programs_refuse_what_they_cannot_do(tmp_path: Path) -> None:
    missing = run(SCRIPT, tmp_path / "none.json", "--out", tmp_path)
    assert missing.returncode == 2 and missing.stderr.count("\n") == 1 and "cannot read" in missing.stderr


# ---- words ------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("text", ["a few short words that go on", "W" * 100, "i W " * 40, ""])
def test_wrapped_lines_fit_and_lose_nothing(text: str) -> None:
    lines = wrap(text, 1.5, 8)
    assert all(inches(line, 8) <= 1.5 for line in lines)
    assert "".join("".join(lines).split()) == "".join(text.split())


def test_shortened_words_fit_and_end_in_an_ellipsis() -> None:
    assert shorten("short", 1, 8) == "short"
    cut = shorten("W" * 100, 1, 8)
    assert inches(cut, 8) <= 1 and cut.endswith("\u2026") and cut.startswith("WW")
