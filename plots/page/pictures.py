"""The figures of result files as parts of a page: each as SVG that cannot run anything, and as the numbers that it draws."""

from __future__ import annotations

import base64
import csv
import io
from dataclasses import dataclass
from typing import Callable

import numpy as np
from matplotlib.figure import Figure


@dataclass(frozen=True)
class Picture:
    name: str
    title: str
    svg: str  # as data: addresses
    csv: str


def picture(name: str, draw: Callable[[], Figure]) -> Picture:
    figure = draw()
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return Picture(name, _title(figure) or name, _address("image/svg+xml", text.getvalue()), _address("text/csv", numbers(figure)))


def _title(figure: Figure) -> str:
    titles = [figure.get_suptitle()] if hasattr(figure, "get_suptitle") else [figure._suptitle.get_text() if figure._suptitle else ""]
    titles += [axes.get_title(loc=side) for axes in figure.axes for side in ("left", "center")]
    return next((" ".join(title.split()) for title in titles if title), "")


def numbers(figure: Figure) -> str:
    """A line a drawn point: panel, what its axes are, series, x, y; of a picture made of cells: column, row, value."""
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow(("panel", "x axis", "y axis", "series", "x", "y", "value"))
    for number, axes in enumerate(figure.axes):
        panel = [" ".join(text.split()) for text in (axes.get_title() or axes.get_title(loc="left") or str(number + 1),
                                                     axes.get_xlabel(), axes.get_ylabel())]
        for line in axes.get_lines():
            label = str(line.get_label())
            if label.startswith("_") and len(line.get_xdata()) < 2:
                continue
            for x, y in zip(line.get_xdata(), line.get_ydata()):
                writer.writerow((*panel, "" if label.startswith("_") else label, x, y, ""))
        for collection in axes.collections:
            label = str(collection.get_label())
            values = collection.get_array()
            for index, (x, y) in enumerate(np.asarray(collection.get_offsets())):
                value = "" if values is None or index >= np.size(values) else np.ravel(values)[index]
                writer.writerow((*panel, "" if label.startswith("_") else label, x, y, value))
        for image in axes.get_images():
            for row, cells in enumerate(np.asarray(image.get_array())):
                for column, value in enumerate(np.atleast_1d(cells)):
                    if np.ndim(value) == 0:
                        writer.writerow((*panel, "", column, row, value))
    return out.getvalue()


def _address(kind: str, text: str) -> str:
    return f"data:{kind};base64,{base64.b64encode(text.encode()).decode()}"
