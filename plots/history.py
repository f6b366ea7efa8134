#!/usr/bin/python3
"""Draws how the times of each solver's best points have changed over the result files of a folder, in the order of their
dates: one panel a scene, one line a solver.

    plots/history.py results/nightly [--out history.svg]

A solver's figure changes from one result to the next by the geometric mean of the ratios of times, over the points
that both have: points of a millisecond and of a second count alike, and a result that ran fewer points does not look faster.
A dashed line: another machine or build from here on, so that a jump says nothing.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # a look at a result must not leave files in the source tree

try:
    import matplotlib
except ImportError:
    print("history.py: matplotlib is missing (Debian: apt-get install python3-matplotlib)", file=sys.stderr)
    sys.exit(2)

from drawings.times_over_results import draw, entries_in
from parts.program import exit_code
from parts.result_file import ResultError
from parts.sheet import save
from parts.style import RC


def run(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="history.py", description="Draws times over the result files of a folder.")
    parser.add_argument("folder", type=Path, help="folder with result files of the bench program (JSON)")
    parser.add_argument("--out", type=Path, help="the figure, .svg or .png (default: history.svg in the folder)")
    options = parser.parse_args(arguments)
    out = options.out or options.folder / "history.svg"
    if out.suffix not in (".svg", ".png"):
        raise ResultError(f"{out}: the figure's name must end in .svg or .png")
    entries = entries_in(options.folder)
    with matplotlib.rc_context(RC):
        save(draw(entries), out)
    print(out, flush=True)


if __name__ == "__main__":
    sys.exit(exit_code(run))
