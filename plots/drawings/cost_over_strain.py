"""Cost over strain limit (the paper's Figures 4a and 5a), at any motion and where the motion is right."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib.figure import Figure

from parts.best_points import sweeps_in
from parts.cost_sheet import Axis, draw
from parts.legend import Legend
from parts.result_file import Json

PERMITTED = Axis("strain limit (%)", 100)


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    return [(data.name, partial(draw, data, document, legend, PERMITTED)) for data in sweeps_in(document, legend, "strain")]
