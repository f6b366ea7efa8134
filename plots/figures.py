#!/usr/bin/python3
"""Draws the figures of a result file: cost over strain limit and over resolution, each solver at its best step; who is
fastest within a strain limit and an error; for step sweeps time against error, and the residual that a solver leaves; for a
stability sweep the matrix of hard cases; for known answers the deviations from them.

    plots/figures.py results/figure4.json [--out DIR]

writes <stem>-figure4a.svg and so on, and prints each path it wrote. Needs Debian's python3-matplotlib and nothing else.
drawings/ has one file a figure; parts/ what they are put together from.
"""

from __future__ import annotations

import argparse
import sys
from importlib import import_module
from pathlib import Path
from typing import Callable

sys.dont_write_bytecode = True  # a look at a result must not leave files in the source tree

try:
    import matplotlib
    from matplotlib.figure import Figure
except ImportError:
    print("figures.py: matplotlib is missing (Debian: apt-get install python3-matplotlib)", file=sys.stderr)
    sys.exit(2)

from parts.legend import legend_of
from parts.program import exit_code
from parts.result_file import Json, ResultError, load, load_analysis
from parts.sheet import save
from parts.style import RC

# Which figures there are, in the order that they are drawn in: the files of drawings/ (see there).
FIGURES = [import_module(f"drawings.{name}") for name in (
    "cost_over_strain",      # Figures 4a and 5a of the paper
    "cost_over_resolution",  # Figures 4b and 5b
    "plane",                 # who is fastest within a strain limit and an error
    "lead",                  # whose the lead is: the stepper's or the method's
    "budget",                # which strain a method reaches within a frame's time
    "growth",
    "work_precision",
    "residual",              # Figure 3
    "hard_cases",
    "known_answers",
)]


def all_figures(document: Json) -> dict[str, Callable[[], Figure]]:
    """Names of the figures that the document has points for, and what draws them."""
    legend = legend_of(document)
    figures: dict[str, Callable[[], Figure]] = {}
    for drawing in FIGURES:
        for name, draw in drawing.figures_of(document, legend):
            number = 2
            unique = name
            while unique in figures:  # names that differ only in what no file name can hold
                unique, number = f"{name}-{number}", number + 1
            figures[unique] = draw
    return figures


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="figures.py", description="Draws the figures of a result file.")
    parser.add_argument("result", type=Path, help="result file of the bench program (JSON)")
    parser.add_argument("--analysis", type=Path, metavar="FILE",
                        help="what `bench show RESULT.json --json` says of it; without it planes are not drawn")
    parser.add_argument("--out", type=Path, required=True, help="folder for the figures")
    return parser.parse_args(arguments)


def run(arguments: list[str]) -> None:
    options = parse(arguments)
    document = load(options.result)
    if options.analysis:
        document["analysis"] = load_analysis(options.analysis)
    figures = all_figures(document)
    if not figures:
        raise ResultError(f"{options.result}: no points to draw")
    with matplotlib.rc_context(RC):
        for name, draw in figures.items():
            path = options.out / f"{options.result.stem}-{name}.svg"
            save(draw(), path)
            print(path, flush=True)


if __name__ == "__main__":
    sys.exit(exit_code(run))
