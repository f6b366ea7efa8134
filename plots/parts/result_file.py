"""Reads a result file of schema inextensible-bench/1, inextensible-stability/1 or inextensible-answers/1, and checks what figures rely on."""

from __future__ import annotations

import json
import math
import statistics
from pathlib import Path
from typing import Any

SCHEMA = "inextensible-bench/1"
STABILITY_SCHEMA = "inextensible-stability/1"
ANSWERS_SCHEMA = "inextensible-answers/1"
ANALYSIS_SCHEMA = "inextensible-analysis/1"
SWEEPS = ("strain", "resolution", "step")
OK = "ok"  # the status of a run that has times to show; all others are failures, whatever their names

Json = dict[str, Any]


class ResultError(Exception):
    """The file cannot be drawn; the message is one line for the user."""


def _parsed(path: Path) -> Any:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not a text file"
        raise ResultError(f"cannot read {path}: {reason}") from error
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise ResultError(f"{path} is not valid JSON: {error}") from error


def load_analysis(path: Path) -> Json:
    """What `bench show --json` wrote."""
    document = _parsed(path)
    if not isinstance(document, dict) or document.get("schema") != ANALYSIS_SCHEMA or not isinstance(document.get("planes"), list):
        raise ResultError(f"{path} is not an analysis, \"{ANALYSIS_SCHEMA}\" (bench show RESULT.json --json)")
    return document


def leaders_in(document: Json, scene: str, sweep: str) -> set[str] | None:
    """Who is first somewhere or of the paper, by the program's analysis; None: the document has none of this scene."""
    planes = [plane for plane in object_in(document, "analysis").get("planes", [])
              if plane["scene"] == scene and plane["sweep"] == sweep]
    return {name for plane in planes for name in plane["leaders"]} if planes else None


def finding_in(document: Json, scene: str, sweep: str, vertices: float | None = None) -> list[str]:
    """The program's sentences on a scene; vertices: of one size."""
    for finding in object_in(document, "analysis").get("findings", []):
        if finding["scene"] == scene and finding["sweep"] == sweep and vertices in (None, finding["vertices"]):
            return list(finding["sentences"])
    return []


def load(path: Path) -> Json:
    """The parsed file, with every point that a figure needs checked."""
    document = _parsed(path)
    if isinstance(document, dict) and document.get("schema") == STABILITY_SCHEMA:
        _check_stability(document, path)
        return document
    if isinstance(document, dict) and document.get("schema") == ANSWERS_SCHEMA:
        _check_answers(document, path)
        return document
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        found = document.get("schema") if isinstance(document, dict) else None
        raise ResultError(f"{path} is not a result file: schema is {json.dumps(found)[:60]}, expected \"{SCHEMA}\"")
    if object_in(document, "context").get("timed") is False:
        raise ResultError(f"{path} was made with --untimed: its times say nothing, so there is nothing to draw")
    points = document.get("points")
    if not isinstance(points, list):
        raise ResultError(f"{path} has no list of points")
    for number, point in enumerate(points):
        if not isinstance(point, dict):
            raise ResultError(f"{path}: points[{number}] is not an object")
        if point.get("sweep") in SWEEPS:
            _check(point, f"{path}: points[{number}]")
    return document


def _check_stability(document: Json, path: Path) -> None:
    for name, keys in (("matrix", ("row", "case", "solver", "outcome")), ("largest_steps", ("scene", "solver"))):
        entries = document.get(name)
        if not isinstance(entries, list):
            raise ResultError(f"{path} has no list of {name}")
        for number, entry in enumerate(entries):
            if not isinstance(entry, dict) or not all(isinstance(entry.get(key), str) for key in keys):
                raise ResultError(f"{path}: {name}[{number}] needs the texts {', '.join(keys)}")


def _check_answers(document: Json, path: Path) -> None:
    for name, keys in (("answers", ("name", "scene", "quantity")), ("rows", ("answer", "solver"))):
        entries = document.get(name)
        if not isinstance(entries, list):
            raise ResultError(f"{path} has no list of {name}")
        for number, entry in enumerate(entries):
            if not isinstance(entry, dict) or not all(isinstance(entry.get(key), str) for key in keys):
                raise ResultError(f"{path}: {name}[{number}] needs the texts {', '.join(keys)}")
    for number, row in enumerate(document["rows"]):
        if not positive(row.get("step")) or not (row.get("deviation") is None or is_number(row["deviation"])):
            raise ResultError(f"{path}: rows[{number}] needs a step above 0, and a deviation or null")


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a JSON number")


def is_number(value: Any) -> bool:
    """Finite, and of a size that an axis can hold."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and (value == 0 or 1e-60 <= abs(value) <= 1e60)


def positive(value: Any) -> bool:
    return is_number(value) and value > 0


def object_in(parent: Any, key: str) -> Json:
    """The object under a key, {} where there is none."""
    value = parent.get(key) if isinstance(parent, dict) else None
    return value if isinstance(value, dict) else {}


def points_of(document: Json) -> list[Json]:
    """The points that load has checked; a stability result has none. The second of an A/A pair is no curve of its own:
    it shows in the file's noise."""
    if document["schema"] != SCHEMA:
        return []
    pair = noise_of(document).get("pair")
    double = pair[1] if isinstance(pair, list) and len(pair) == 2 else None
    return [point for point in document.get("points", [])
            if point.get("sweep") in SWEEPS and (double is None or contestant_of(point) != double)]


def noise_of(document: Json) -> Json:
    """How far apart the times of an A/A pair are; {} in a file without one."""
    return object_in(object_in(document, "context"), "noise")


def noise_factor(document: Json) -> float | None:
    """95 % of the pair's times are within this factor of each other."""
    q95 = noise_of(document).get("q95")
    return math.exp(q95) if is_number(q95) and 0 <= q95 < 50 else None


def contestant_of(point: Json) -> str:
    """Who competes: the solver, or another name of it. Older files have solvers only."""
    name = point.get("contestant")
    return name if isinstance(name, str) and name else point["solver"]


def suite_of(document: Json) -> Json:
    return object_in(object_in(document, "context"), "suite")


def _check(point: Json, where: str) -> None:
    """Only what the drawing relies on; configs/result.schema.json is the full description."""
    for key in ("scene", "solver", "status"):
        if not isinstance(point.get(key), str) or not point[key]:
            raise ResultError(f"{where} has no {key}")
    for key in ("vertices", "strain_limit"):
        if not positive(point.get(key)):
            raise ResultError(f"{where} needs a positive number as {key}")
    if point.get("best") is True and time_of(point) is None:
        raise ResultError(f"{where} is marked best but has no positive time in seconds_per_simulated_second")


def time_of(point: Json) -> float | None:
    return time_in(point, "seconds_per_simulated_second")


def time_in(point: Json, key: str) -> float | None:
    """The time that counts: the least sample (harness/base/statistics.h, time_of). Where a file has no samples, its median."""
    timing = object_in(point, key)
    times = _samples_in(point, key) or [timing.get("min"), timing.get("median")]
    return next((float(time) for time in times if positive(time)), None)


def spread_in(point: Json, key: str) -> tuple[float, float] | None:
    """From the least sample to the median: how much the samples were disturbed. None where there are fewer than three."""
    samples = _samples_in(point, key)
    return (samples[0], float(statistics.median(samples))) if len(samples) >= 3 else None


def _samples_in(point: Json, key: str) -> list[float]:
    """In order; none where one of them is no time."""
    samples = object_in(point, key).get("samples")
    if not isinstance(samples, list) or not all(positive(sample) for sample in samples):
        return []
    return sorted(float(sample) for sample in samples)
