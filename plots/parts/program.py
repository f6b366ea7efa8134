"""How a script of this folder ends."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Callable

from parts.result_file import ResultError


def exit_code(run: Callable[[list[str]], None]) -> int:
    """Exit code of the command line: 2, and a line on stderr, for a file that cannot be used."""
    try:
        run(sys.argv[1:])
    except ResultError as error:
        print(f"{Path(sys.argv[0]).name}: {error}", file=sys.stderr)
        return 2
    return 0
