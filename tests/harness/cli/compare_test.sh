#!/usr/bin/env bash
# Google Benchmark's compare.py reads our result files and can set two solvers of one file against each other.
rm -rf -- ./*  # of the last time
set -eu
compare=/usr/share/benchmark/compare.py
[[ -e $compare ]] || { echo "no compare.py here"; exit 77; }

"$BENCH_BINARY" --sweep strain --profile quick --scene chain --solver 'icd|fast_projection' --filter 'strain:0.01/h:0.01$' \
  --reps 9 --out result.json --no-plots >/dev/null 2>&1
/usr/bin/python3 "$compare" filters result.json chain/icd chain/fast_projection >table.txt
cat table.txt
grep -q 'vs. chain/fast_projection' table.txt  # the rows were matched
grep -q 'pvalue' table.txt                     # nine repetitions: its U test ran
