"""Cost over resolution (the paper's Figures 4b and 5b), at any motion and where the motion is right. The paper's axes are linear;
with methods that differ a hundredfold such axes show the slowest alone."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib.figure import Figure

from parts.best_points import sweeps_in
from parts.cost_sheet import Axis, draw
from parts.legend import Legend
from parts.result_file import Json

VERTICES = Axis("vertices (dotted: slopes 1 and 2)", slopes=True)


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(data.name, partial(draw, data, document, legend, VERTICES))
            for data in sweeps_in(document, legend, "resolution")]
