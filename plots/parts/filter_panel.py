"""The panel of the inextensibility filter's own time: where a collider takes part, the whole is partly the collider's."""

from __future__ import annotations

from dataclasses import replace

from matplotlib.axes import Axes

from parts.best_points import Curve, FigureData
from parts.curves import Styles, draw_curves
from parts.scales import log_y

FILTER_LABEL = "filter alone (s)"


def draw_filter(axes: Axes, figure: FigureData, styles: Styles, x_factor: float = 1.0) -> None:
    """The same curves as above it, of the filter's part of the time."""
    parts = replace(figure, curves={name: Curve(curve.filter) for name, curve in figure.curves.items()})
    log_y(axes, parts)
    draw_curves(axes, parts, styles, x_factor)
    axes.set_ylabel(FILTER_LABEL)
