"""What the report's scripts work on: solvers with their looks, and a row a point, as one JSON document."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import Any

from parts.best_points import FILTER_TIME, TIME, delivered_strain
from parts.legend import Legend
from parts.result_file import Json, contestant_of, is_number, time_in, spread_in, object_in, points_of
from parts.style import styles_for

# Fields of a point in this order; the scripts know them by these names.
COLUMNS = ("file", "id", "scene", "sweep", "vertices", "limit", "step", "solver", "status", "detail", "seconds", "low", "high",
           "filter", "strain", "delivered", "error", "energy", "iterations", "factorizations", "projections", "runs", "best",
           "adaptive")


def document_data(documents: dict[Path, Json], legend: Legend) -> Json:
    names = list(dict.fromkeys(contestant_of(point) for document in documents.values() for point in points_of(document)))
    styles = styles_for(names, legend)
    order = list(styles)
    rows = [_row(number, point, order) for number, document in enumerate(documents.values()) for point in points_of(document)]
    return {
        "columns": COLUMNS,
        "files": [{"name": path.name, "command": repeat_command(document)} for path, document in documents.items()],
        "solvers": [{"name": name, "label": styles[name].label, "color": styles[name].color, "dashes": styles[name].dashes, "marker": styles[name].marker,
                     "unranked": styles[name].hollow, "ranked": legend.ranked(name)} for name in order],
        "statuses": {name: status.meaning for name, status in legend.statuses.items()},
        "points": rows,
    }


def _row(file: int, point: Json, order: list[str]) -> list[Any]:
    interval = spread_in(point, TIME) or (None, None)
    error, work = object_in(point, "error"), object_in(point, "work")

    def number(parent: Json, key: str) -> float | None:
        return parent[key] if is_number(parent.get(key)) else None

    samples = object_in(point, TIME).get("samples")
    return [file, str(point.get("id", "")), point["scene"], point["sweep"], point["vertices"], point["strain_limit"],
            number(point, "step"), order.index(contestant_of(point)), point["status"], str(point.get("status_detail", "")),
            time_in(point, TIME), *interval, time_in(point, FILTER_TIME), number(point, "max_strain"),
            delivered_strain(point), number(error, "trajectory"), number(error, "energy_gain"), number(work, "iterations"),
            number(work, "factorizations"), number(work, "edge_projections"), len(samples) if isinstance(samples, list) else 0,
            point.get("best") is True, point.get("adaptive") is True]


def repeat_command(document: Json) -> str:
    """The command that made the file, without what names files; a filter is added for one point."""
    words = object_in(document, "context").get("command")
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        return "./bench"
    kept, skip = [], False
    for word in words[1:]:
        if skip:
            skip = False
        elif word in ("--out", "--filter"):
            skip = True
        elif word not in ("--force", "--resume", "--no-plots"):
            kept.append(shlex.quote(word))
    return " ".join(["./bench", *kept])


def embedded(value: Any) -> str:
    """As the text of a script element: nothing in it ends that element, whatever a file calls its solvers."""
    text = json.dumps(value, separators=(",", ":"), allow_nan=False, ensure_ascii=True)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
