#!/usr/bin/env bash
# docs/results.md is what its own command makes of the committed result files.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
here=$PWD
cd "$root"
command=$(sed -n '/^```sh$/,/^```$/{/^```/d;p}' docs/results.md | sed 's/ *\\$//' | tr '\n' ' ')
[[ $command == './bench results '*' --out docs/results.md '* ]] || { echo "docs/results.md names no command: $command"; exit 1; }
read -ra words <<<"${command% --out *}"
"$BENCH_BINARY" "${words[@]:1}" | grep -v '^  --out ' >"$here/results.md"
grep -v '^  --out ' docs/results.md >"$here/committed.md"
# The line before --out ends in a backslash that the page without --out does not have.
sed -i 's/ \\$//' "$here/committed.md" "$here/results.md"
diff "$here/committed.md" "$here/results.md" || { echo "docs/results.md is not what its command makes: $command"; exit 1; }
