#!/usr/bin/python3
"""Draws the figures of a result file.

    plots/figures.py figure4.json --out DIR

writes figure4-figure4a.svg and so on, and prints each path it wrote. `bench plot` runs it with a file that it has checked, and has put
its analysis of a sweep into. Needs Debian's python3-matplotlib and nothing else. drawings/ has one file a kind of figure; parts/ what
they share.
"""

import argparse
import json
import sys
from functools import partial
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

from parts.result import Result
from parts.style import RC

# Which figures there are, in the order that they are drawn in: the files of drawings/ (see there).
FIGURES = [import_module(f"drawings.{name}") for name in (
    "cost", "plane", "work_precision", "residual", "hard_cases",
    "known_answers",
)]


def all_figures(result: Result, every: bool = False) -> dict[str, Callable[[], Figure]]:
    """Names of the figures that the result has runs for, and what draws them; every: also complete ones, of all solvers."""
    figures: dict[str, Callable[[], Figure]] = {}
    for name, draw, *of in (figure for drawing in FIGURES for figure in drawing.figures_of(result, every)):
        unique, number = name, 2
        while unique in figures:  # names that differ only in what no file name can hold
            unique, number = f"{name}-{number}", number + 1
        figures[unique] = partial(draw, *of)
    return figures


def main() -> int:
    parser = argparse.ArgumentParser(prog="figures.py", description="Draws the figures of a result file.")
    parser.add_argument("result", type=Path, help="result file of the bench program, checked and analysed (JSON)")
    parser.add_argument("--out", type=Path, required=True, help="folder for the figures")
    parser.add_argument("--all", action="store_true", help="also the complete figures, of all solvers")
    options = parser.parse_args()
    figures = all_figures(Result(json.loads(options.result.read_text(encoding="utf-8"))), options.all)
    if not figures:
        print(f"figures.py: {options.result.name}: no points to draw", file=sys.stderr)
        return 2
    with matplotlib.rc_context(RC):
        for name, draw in figures.items():
            path = options.out / f"{options.result.stem}-{name}.svg"
            draw().savefig(path, metadata={"Date": None})  # so that the same result gives the same bytes
            print(path, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
