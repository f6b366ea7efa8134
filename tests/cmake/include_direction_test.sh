# The build stops at an include that goes against the direction of the folders, and names it.
set -uo pipefail
source_dir=$(cd "$(dirname "$0")/../.." && pwd)
fail() { echo "FAILED: $*"; exit 1; }
mkdir -p tree/solvers/low tree/solvers/high tree/harness/base
cat >rules.cmake <<'EOF'
set(folders solvers/low;solvers/high;harness/base)
set(seen_by_solvers/low solvers/low)
set(seen_by_solvers/high solvers/high;solvers/low)
set(seen_by_harness/base harness/base;solvers)
EOF
check() { cmake -DSOURCE="$PWD/tree" -DRULES="$PWD/rules.cmake" -P "$source_dir/cmake/CheckIncludes.cmake" 2>message; }

echo '#include "solvers/low/b.h"' | tee tree/solvers/high/a.h tree/harness/base/a.cpp tree/solvers/low/a.cpp >/dev/null
check || fail "refused what is allowed: $(cat message)"

# refuses SOURCE INCLUDED
refuses() {
  local before
  before=$(cat "tree/$1")
  printf '%s\n#include "%s"\n' "$before" "$2" >"tree/$1"
  check && fail "$1 may include $2"
  grep -q "^ *$1: #include \"$2\"" message || fail "the message does not name it: $(cat message)"
  echo "$before" >"tree/$1"
}
refuses solvers/low/a.cpp solvers/high/a.h
refuses solvers/high/a.h harness/base/a.h
refuses harness/base/a.cpp harness/cli/a.h
echo ok
