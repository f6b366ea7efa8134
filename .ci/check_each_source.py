"""Parses each source of a build's compile_commands.json on its own, with Clang: joined with others, it may lack an include unseen.

    check_each_source.py BUILD_FOLDER

Headers that many sources include, themselves or by others, are parsed once for all that include the same of them. A source gets none
beforehand that it does not include.
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

LARGE = ("Eigen/Core", "gtest/gtest.h", "harness/points/point.h", "nlohmann/json.hpp", "solvers/problem/problem.h", "solvers/registry.h")
ALIGNMENT = "-DEIGEN_MAX_ALIGN_BYTES"
top = Path(__file__).resolve().parent.parent
compiler = ["clang++", "-std=c++20", f"{ALIGNMENT}=64", "-DGTEST_HAS_PTHREAD=1", "-isystem", "/usr/include/eigen3", f"-I{top}"]


@cache
def large_headers(path):
    """Those of LARGE that a file includes."""
    found = set()
    for name in re.findall(r'^#include [<"]([^>"]+)', path.read_text(encoding="utf-8"), re.MULTILINE):
        found |= {name} & set(LARGE)
        own = [folder / name for folder in (top, top / "tests", path.parent) if (folder / name).is_file()]
        found |= large_headers(own[0]) if own else set()
    return frozenset(found)


def flags_for_parsing(words):
    """Definitions, folders of headers and warnings; what else a command says would not fit headers that others use."""
    for word, following in zip(words, words[1:]):
        if word == "-isystem":
            yield from (word, following)
        elif re.match("-[DIW]", word) and not word.startswith(ALIGNMENT):
            yield word


def main(build):
    sources = {}  # by the headers that are parsed for them
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        source = Path(entry["file"])
        command = [*compiler, *flags_for_parsing(shlex.split(entry["command"])), "-fsyntax-only", source]
        sources.setdefault(large_headers(source), []).append(command)

    def run(command):
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def parse(numbered):
        number, headers = numbered
        text = build / f"large{number}.h"
        text.write_text("".join(f"#include <{header}>\n" for header in headers), encoding="utf-8")
        result = text.with_suffix(".pch")
        return result, run([*compiler, "-fpch-instantiate-templates", "-x", "c++-header", text, "-o", result])

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        parsed = list(pool.map(parse, enumerate(sources)))
        commands = [[*command, "-include-pch", file] for (file, _), group in zip(parsed, sources.values()) for command in group]
        results = [*(result for _, result in parsed), *pool.map(run, commands)]
    for result in results:
        sys.stderr.write(result.stderr)
    return any(result.returncode for result in results)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
