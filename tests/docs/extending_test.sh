#!/usr/bin/env bash
# What docs/extending.md says to add is added to a copy of the sources, built, and run. Slow: it compiles the program.
#
# In the page, a comment before a block of code says where the block goes:
#   <!-- new file: path -->           the block is the file
#   <!-- path, after: some text -->   the block follows the first line that holds the text
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
tree=$PWD/tree
fail() { echo "extending_test: $*" >&2; exit 1; }

rm -rf "$tree" && mkdir "$tree"
(cd "$root" && tar c CMakeLists.txt CMakePresets.json cmake configs harness plots results/references solvers) | tar x -C "$tree"

/usr/bin/python3 - "$root/docs/extending.md" "$tree" <<'PYTHON'
import re
import sys
from pathlib import Path

page, tree = Path(sys.argv[1]).read_text(encoding="utf-8"), Path(sys.argv[2])
blocks = re.findall(r"<!-- (?:new file: (\S+)|(\S+), after: (.+?)) -->\n\n?```\w*\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
if not blocks:
    sys.exit("the page has nothing to add")
for new, path, anchor, code in blocks:
    place = tree / (new or path)
    if new and place.exists():
        sys.exit(f"{new} is there already")
    lines = [] if new else place.read_text(encoding="utf-8").splitlines(keepends=True)
    at = 0 if new else next((number for number, line in enumerate(lines, 1) if anchor in line), None)
    if at is None:
        sys.exit(f"{path} has no line with '{anchor}'")
    lines.insert(at, code)
    place.write_text("".join(lines), encoding="utf-8")
print(f"{len(blocks)} pieces added")

# The table of files to edit, of each section that has pieces.
table = {row[0]: (int(row[1]), set(re.findall(r"`([^`]+)`", row[2])))
         for row in re.findall(r"^\| ([a-z ]+) \| (\d+) \| (.*) \|$", page, re.MULTILINE)}
for title, text in re.findall(r"^## An? (.*?)$(.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL):
    edited = set(re.findall(r"^<!-- (\S+), after:", text, re.MULTILINE))
    if edited and table.get(title) != (len(edited), edited):
        sys.exit(f"the table says {table.get(title)} of a {title}, whose pieces edit {sorted(edited)}")
PYTHON

cd "$tree"
# Clang takes half of GCC's time, and has its own opinion.
command -v clang++ >/dev/null && export CC=clang CXX=clang++
cmake --preset debug -DBUILD_TESTING=OFF -DCMAKE_CXX_FLAGS_DEBUG=-O0 \
  -DINEXTENSIBLE_UNITY=ON -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 >../configure.log 2>&1 || { cat ../configure.log; fail "not configured"; }
cmake --build build/debug --target bench >../build.log 2>&1 || { grep -E 'error|FAILED' ../build.log; fail "not built"; }
bench=$tree/build/debug/bench

"$bench" list solvers | grep '^ *symmetric_sweeps:' >/dev/null || fail "the filter is not listed"
"$bench" list scenes | grep '^ *swing:' >/dev/null || fail "the scene is not listed"
"$bench" check --solver symmetric_sweeps --quick || fail "the filter does not conform"

cat >../tiny.json <<'JSON'
{
  "name": "tiny", "description": "the new scene", "profile": "tiny", "seed": 1, "reps": 1, "timeout": 20,
  "sweeps": [{"sweep": "strain", "scene": "swing", "limits": [0.01], "scene_parameters": {"n": 10, "duration": 0.2}}]
}
JSON
"$bench" --sweep strain --config ../tiny.json --solver 'symmetric_sweeps|fast_projection' --no-plots --force --out ../tiny-result.json \
  >../sweep.log || { cat ../sweep.log; fail "the sweep failed"; }
"$bench" --sweep stability --case thrown --solver 'symmetric_sweeps|fast_projection' --no-plots --force --out ../hard.json >../hard.log ||
  { cat ../hard.log; fail "the hard case does not end as it says"; }
"$bench" plot ../tiny-result.json | grep 'tiny-result-strain-over-step.svg$' >/dev/null || fail "the figure is not drawn"
/usr/bin/python3 - ../tiny-result.json ../hard.json <<'PYTHON'
import json
import sys

points = json.load(open(sys.argv[1], encoding="utf-8"))["points"]
best = {p["solver"]: p for p in points if p["best"]}
hard = json.load(open(sys.argv[2], encoding="utf-8"))["matrix"]
assert len(hard) == 2 and all(row["case"] == "thrown" and row["as_expected"] for row in hard), hard
assert set(best) == {"symmetric_sweeps", "fast_projection"}, set(best)
assert all(p["scene"] == "swing" for p in points)
assert all(-1.1 < p["lowest_height"] < 0 for p in best.values()), [p["lowest_height"] for p in best.values()]
PYTHON
