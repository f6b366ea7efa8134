"""What the report's scripts work on, as one JSON document: solvers with their looks, a row a point, and scenes in motion."""

import base64
import json
import shlex
import statistics
from operator import itemgetter
from pathlib import Path
from typing import Any, Callable

import numpy as np

from parts.result import Json, Result, seconds_of
from parts.style import styles_for


def _median(point: Json) -> float | None:
    """Of three samples or more."""
    samples = (point["seconds_per_simulated_second"] or {}).get("samples", [])
    return statistics.median(samples) if len(samples) >= 3 else None


# What a row holds; the scripts know it by these names.
FIELDS: dict[str, Callable[[Json], Any]] = {
    **{name: itemgetter(name) for name in ("id", "scene", "sweep", "vertices", "step", "status", "best", "adaptive")},
    "limit": itemgetter("strain_limit"), "detail": itemgetter("status_detail"),
    "seconds": seconds_of, "high": _median, "runs": lambda point: len((point["seconds_per_simulated_second"] or {}).get("samples", [])),
    "strain": itemgetter("max_strain"), "delivered": itemgetter("max_strain_after_collision"),
    "error": lambda point: point["error"]["trajectory"], "energy": lambda point: point["error"]["energy_gain"],
    "iterations": lambda point: point["work"]["iterations"], "factorizations": lambda point: point["work"]["factorizations"],
    "projections": lambda point: point["work"]["edge_projections"],
}


def embedded(results: dict[Path, Result], motions: list[Path]) -> Json:
    """Whatever a file calls its solvers, each has a look of its own: the legends are taken together."""
    solvers: dict[str, Json] = {}
    for result in results.values():
        for entry in result.document["legend"]["solvers"]:
            solvers.setdefault(entry["name"], entry)
    styles = styles_for([point["contestant"] for result in results.values() for point in result.points],
                        Result({"context": {}, "legend": {"solvers": list(solvers.values()), "statuses": []}}))
    number = {name: place for place, name in enumerate(styles)}
    return {
        "columns": ["file", "solver", *FIELDS],
        "points": [[file, number[point["contestant"]], *(read(point) for read in FIELDS.values())]
                   for file, result in enumerate(results.values()) for point in result.points],
        "files": [{"name": path.name, "command": repeat_command(result)} for path, result in results.items()],
        "solvers": [{"label": style.label, "color": style.color, "dashes": style.look.dashes, "marker": style.look.marker, "hollow": style.hollow,
                     "name": name} for name, style in styles.items()],
        "motions": [recorded(folder) for folder in motions],
    }


def repeat_command(result: Result) -> str:
    """The command that made the file, without what names files; a filter is added for one point."""
    words = iter(result.context.get("command", [])[1:])
    kept = ["./bench"]
    for word in words:
        if word in ("--out", "--filter"):
            next(words, None)
        elif word not in ("--force", "--resume", "--no-plots"):
            kept.append(shlex.quote(word))
    return " ".join(kept)


def recorded(folder: Path) -> Json:
    """What `bench film` recorded (harness/film/recording.h): positions as 16-bit steps of the box that holds them, too coarse to read
    strains off."""
    header = json.loads((folder / "film.json").read_text(encoding="utf-8"))
    x = np.fromfile(folder / "film.f32", dtype="<f4").reshape(-1, 3)
    low, high = x.min(axis=0), x.max(axis=0)
    span = np.where(high > low, high - low, 1)
    kept = ("scene", "frames_per_second", "vertices", "triangles", "edges", "strain_unit", "body", "body_triangles", "body_poses")
    return {**{key: header[key] for key in kept},
            "takes": [{key: take[key] for key in ("label", "strain_limit", "frames", "detail")} for take in header["takes"]],
            "low": low.tolist(), "span": span.tolist(),
            "positions": base64.b64encode(np.rint((x - low) / span * 65535).astype("<u2").tobytes()).decode(),
            "strains": base64.b64encode((folder / "film.u8").read_bytes()).decode()}


def script_text(value: Any) -> str:
    """As the text of a script element: nothing in it ends that element, whatever a file calls its solvers."""
    text = json.dumps(value, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
