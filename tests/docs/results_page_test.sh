#!/usr/bin/env bash
# docs/results.md is what its own command makes of the committed result files, and short enough to be read.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
here=$PWD
cd "$root"
command=$(sed -n '/^```sh$/,/^```$/{/^```/d;p}' docs/results.md)
[[ $command == './bench results '*' --out docs/results.md' ]] || { echo "docs/results.md names no command: $command"; exit 1; }
read -ra words <<<"${command% --out *}"
"$BENCH_BINARY" "${words[@]:1}" >"$here/results.md"
sed 's/ --out docs\/results.md$//' docs/results.md >"$here/committed.md"
diff "$here/committed.md" "$here/results.md" || { echo "docs/results.md is not what its command makes: $command"; exit 1; }
lines=$(wc -l <docs/results.md)
((lines <= 300)) || { echo "docs/results.md has $lines lines, 300 are to be read"; exit 1; }
