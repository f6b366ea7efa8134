#!/usr/bin/env bash
# bench ab: a solver that fails and an extra iteration are found. Slowdowns and false alarms are tested with a fake clock
# (pairs_test.cpp), and a plug-in that is slower in plugin_test.sh.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"

# against PROGRAM [OPTIONS...]: its exit code; what it printed is in table.txt. One step, which every solver gets through.
against() {
  "$BENCH_BINARY" ab "$BENCH_BINARY" "$@" --scene chain --filter 'strain:0.01/h:0.0025$' >table.txt 2>log.txt
}

against "$BENCH_WITH_FAULTS" --solver jacobi --pairs 4
[[ $? == 4 ]] && grep -q '^NEWLY_FAILING *strain chain/jacobi' table.txt || fail "a failing solver: $(cat table.txt log.txt)"

# An extra iteration is reported, and is a regression with a gate on counters.
echo '{"counters": {"rule": "exact"}}' >exact.json
against "$BENCH_WITH_FAULTS" --solver fast_projection --pairs 4 --gate exact.json --junit more.xml
[[ $? == 3 ]] && grep -q 'iterations [0-9]* -> ' table.txt || fail "an extra iteration: $(cat table.txt log.txt)"
grep -q 'name="chain/fast_projection' more.xml || fail "more.xml: $(cat more.xml)"

finish
