#!/usr/bin/env bash
# bench ab: a program that is three times as slow in one solver is never the same. A solver that fails and an extra iteration are
# found. False alarms and small slowdowns are tested with a fake clock (pairs_test.cpp), for a busy machine may leave them open (6).
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"

# against PROGRAM [OPTIONS...]: its exit code; what it printed is in table.txt. One step, which every solver gets through.
against() {
  "$BENCH_BINARY" ab "$BENCH_BINARY" "$@" --scene chain --filter 'strain:0.01/h:0.0025$' >table.txt 2>log.txt
}

against "$BENCH_WITH_FAULTS" --solver 'gauss_seidel|icd' --pairs 15 --sample-seconds 0.05 --junit slow.xml
[[ $? == [36] ]] || fail "three times as slow: $(cat table.txt log.txt)"
grep -Eq '^(SLOWER|AMBIGUOUS) *strain chain/gauss_seidel' table.txt || fail "the slower solver: $(cat table.txt)"
grep -q '^SLOWER *strain chain/icd' table.txt && fail "the other solver: $(cat table.txt)"
grep -q 'name="chain/gauss_seidel' slow.xml || fail "slow.xml: $(cat slow.xml)"

against "$BENCH_WITH_FAULTS" --solver jacobi --pairs 4
[[ $? == 4 ]] && grep -q '^NEWLY_FAILING *strain chain/jacobi' table.txt || fail "a failing solver: $(cat table.txt log.txt)"

# An extra iteration is reported, and is a regression with a gate on counters.
echo '{"counters": {"rule": "exact"}}' >exact.json
against "$BENCH_WITH_FAULTS" --solver fast_projection --pairs 4 --gate exact.json
[[ $? == 3 ]] && grep -q 'iterations [0-9]* -> ' table.txt || fail "an extra iteration: $(cat table.txt log.txt)"

finish
