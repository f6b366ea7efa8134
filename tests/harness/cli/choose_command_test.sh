#!/usr/bin/env bash
# bench choose, interrupted at several moments, without the time for any run, with budgets that cannot be kept, and with solvers
# that the scene has no use for: it says what it knows, and its exit code says whether that is an answer.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"
set -m  # a background process does not ignore SIGINT
cloth=("$BENCH_BINARY" choose --scene cape --n 15 --seconds 120)

# The moments: before anything, once the finer run begins, and after so many ladders' runs.
# interrupted SIGNAL LINES: sends the signal when so many lines are on standard error.
interrupted() {
  local code
  "${cloth[@]}" >out.txt 2>err.txt &
  local bench=$!
  for _ in $(seq 1500); do
    (($(wc -l <err.txt) < $2)) && kill -0 $bench 2>/dev/null || break
    sleep 0.02
  done
  kill -"$1" $bench 2>/dev/null
  wait $bench
  code=$?
  [[ $code == 130 || $code == 143 ]] || fail "$1 after $2 lines: exit $code: $(cat out.txt err.txt)"
  [[ ! -s out.txt ]] || fail "$1 after $2 lines, an answer: $(cat out.txt)"
  (($2 == 0)) || grep -q 'interrupted' err.txt || fail "$1 after $2 lines, nothing of it is said: $(cat err.txt)"
}
for lines in 0 1 2 4 5 6 8 12; do
  interrupted INT $lines
  interrupted TERM $lines
done

exits 6 'no run ended within its strain limit in this time' choose --no-wait --scene drape --n 71 --seconds 0.5
! grep -q '^take' stdout.txt || fail "a solver to take, without any run"
chain=(choose --no-wait --scene chain --n 10 --error 0.5 --seconds 10 --solver 'fast_projection|yarn_projection@midpoint')
exits 0 'take  ' "${chain[@]}" --budget 10s
exits 6 'no solver that was tried keeps the budget' "${chain[@]}" --budget 0.000001us
! grep -q '^take' stdout.txt || fail "a solver to take, above the budget: $(cat stdout.txt)"
for name in fast_projection yarn_projection@midpoint; do
  grep -q "$name" stdout.txt || fail "$name was named and is nowhere: $(cat stdout.txt)"
done
finish
