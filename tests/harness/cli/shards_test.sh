#!/usr/bin/env bash
# The recipe of docs/using.md for many machines, run by GNU parallel on a sweep of three sizes: the shards are the whole sweep, and
# finished shards are not run again.
rm -rf -- ./*  # left by the last run
set -euo pipefail
command -v parallel >/dev/null || exit 77
ln -s "$BENCH_BINARY" bench
mkdir -p results/local
docs=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../../docs/using.md
sed -n '/^shards=/,/^```/p' "$docs" | sed '/^```/d; s/^shards=.*/shards=3/; s/--profile paper/--profile pairs --scene chain --solver fast_projection --reps 1/' >recipe.sh
[[ $(wc -l <recipe.sh) == 3 ]]
for time in first again; do
  bash -euo pipefail recipe.sh
  [[ $time == again ]] || sha256sum results/local/shard-*.json >sums.txt
done
sha256sum --quiet -c sums.txt
./bench show results/local/shard-*.json --json | /usr/bin/python3 -c '
import json, sys
assert {plane["vertices"] for plane in json.load(sys.stdin)["planes"]} == {20, 40, 80}'
