"""Parses each source of a build's compile_commands.json on its own, with Clang: joined with others, it may lack an include unseen.

    check_each_source.py BUILD_FOLDER

Headers that many sources include, themselves or by others, are parsed once for all that include the same of them and are compiled
alike. A source gets none beforehand that it does not include.
"""

import json
import os
import re
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path

LARGE = ("Eigen/Core", "harness/points/point.h", "nlohmann/json.hpp", "solvers/problem/problem.h", "solvers/registry.h")
top = Path(__file__).resolve().parent.parent


@cache
def large_headers(path):
    """Those of LARGE that a file includes."""
    names = re.findall(r'^#include [<"]([^>"]+)', path.read_text(encoding="utf-8"), re.MULTILINE)
    own = [top / name for name in names if (top / name).is_file()]
    return frozenset(LARGE).intersection(names).union(*map(large_headers, own))


def main(build):
    sources = {}  # by their flags and the headers that are parsed for them
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        words, source = shlex.split(entry["command"]), Path(entry["file"])
        flags = tuple(words[:words.index("-o")])
        sources.setdefault((flags, large_headers(source)), []).append(source)

    def run(command):
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def parse(numbered):
        number, (flags, headers) = numbered
        text = build / f"large{number}.h"
        text.write_text("".join(f"#include <{header}>\n" for header in headers), encoding="utf-8")
        result = text.with_suffix(".pch")
        return result, run([*flags, "-fpch-instantiate-templates", "-x", "c++-header", text, "-o", result])

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        parsed = list(pool.map(parse, enumerate(sources)))
        commands = [[*flags, "-fsyntax-only", "-include-pch", file, source]
                    for (file, _), ((flags, _), group) in zip(parsed, sources.items()) for source in group]
        results = [*(result for _, result in parsed), *pool.map(run, commands)]
    for result in results:
        sys.stderr.write(result.stderr)
    return any(result.returncode for result in results)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
