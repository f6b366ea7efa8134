#!/usr/bin/python3
"""Draws the figures of a result file: cost over permissible strain and over resolution, each solver at its best step, and
for step sweeps time against error, error over step, and the residual of fast projection; for a stability sweep the matrix
of hard cases.

    plots/figures.py results/figure4.json [--out DIR] [--format svg,png]

writes <stem>-figure4a.svg and so on, and prints each path it wrote. Needs Debian's python3-matplotlib and nothing else.
results.py reads and sorts the points; cost.py, precision.py and matrix.py draw, the first two on sheets (sheet.py) of
panels (panels.py); looks are set in style.py; caption.py has the words.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Callable

sys.dont_write_bytecode = True  # a look at a result must not leave files in the source tree

try:
    import matplotlib
    from matplotlib.figure import Figure
except ImportError:
    print("figures.py: matplotlib is missing (Debian: apt-get install python3-matplotlib)", file=sys.stderr)
    sys.exit(2)

import cost
import matrix
import precision
from results import STABILITY_SCHEMA, Json, ResultError, figures_in, load, runs_in
from sheet import save
from style import RC

FORMATS = ("svg", "png")


def all_figures(document: Json) -> list[tuple[str, Callable[[], Figure]]]:
    """Names of the figures that the document has points for, and what draws them."""
    if document["schema"] == STABILITY_SCHEMA:
        return [("matrix", lambda: matrix.draw(document))]
    figures = [(data.name, lambda data=data: cost.draw(data, document)) for data in figures_in(document)]
    figures += [(f"{data.name}-growth", lambda data=data: cost.draw_growth(data, document))
                for data in figures_in(document) if data.sweep == "resolution"]
    for data in runs_in(document):
        figures += [(name, lambda data=data, draw=draw: draw(data, document)) for name, draw in precision.figures_of(data)]
    return figures


def formats(text: str) -> list[str]:
    wanted = [part.strip().lower() for part in text.split(",") if part.strip()]
    unknown = [part for part in wanted if part not in FORMATS]
    if unknown or not wanted:
        raise argparse.ArgumentTypeError(f"'{text}': give one or more of {', '.join(FORMATS)}")
    return wanted


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="figures.py", description="Draws the figures of a result file.")
    parser.add_argument("result", type=Path, help="result file of the bench program (JSON)")
    parser.add_argument("--out", type=Path, help="folder for the figures (default: the result file's folder)")
    parser.add_argument("--format", type=formats, default=list(FORMATS), metavar="svg,png",
                        help="file formats (default: both)")
    return parser.parse_args(arguments)


def run(arguments: list[str]) -> None:
    options = parse(arguments)
    document = load(options.result)
    figures = all_figures(document)
    if not figures:
        raise ResultError(f"{options.result}: no points to draw")
    folder = options.out or options.result.parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ResultError(f"cannot make folder {folder}: {error.strerror}") from error
    with matplotlib.rc_context(RC):
        for name, draw in figures:
            figure = draw()
            for suffix in options.format:
                path = folder / f"{options.result.stem}-{name}.{suffix}"
                save(figure, path)
                print(path, flush=True)


def main() -> int:
    try:
        run(sys.argv[1:])
    except ResultError as error:
        print(f"figures.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
