#!/usr/bin/env bash
# A solver that is a program of its own: it conforms and is swept; what it does wrong costs one line, or its own run.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../harness/cli/functions.sh"

engine=(--plugin "cmd:$SOURCE_FOLDER/contestants/process/my_engine.py")
bench "${engine[@]}" check --quick --solver my_engine >check.txt 2>&1 || fail "check: $(cat check.txt)"
bench "${engine[@]}" --sweep strain --profile pairs --scene chain --n 20 --filter 'strain:0.1/' --reps 1 --solver my_engine --steps all --finest 0.01 \
  --no-plots --out sweep.json >sweep.txt 2>&1 || fail "a sweep: $(cat sweep.txt)"
holds '
document = read("sweep.json")
assert document["context"]["plugins"][0]["file"] == "my_engine.py", document["context"]["plugins"]
mine = [p for p in document["points"] if p["solver"] == "my_engine" and p["status"] == "ok"]
assert mine, document["points"]
for p in mine:  # the time of the program counts, and its own clock and the crossing are told apart
    assert p["phases"]["filter"] > 0 and p["phases"]["copy"] > 0, p
    assert min(p["cpu_seconds_per_simulated_second"]) > 0.5 * p["phases"]["filter"], p
    assert all(median > 0 for _, median, *_ in p["frame_times"]), p'
/usr/bin/python3 -c '
import json
print(json.dumps([p for p in json.load(open("sweep.json"))["points"] if p["solver"] == "my_engine"][0]))' >point.txt

# bad PART PROGRAM: refused in one line that names PART.
bad() {
  printf '#!/bin/sh\n%b' "$2" >bad.sh
  refused "$1" --plugin 'cmd:sh bad.sh' list solvers
}
bad 'the program has ended' 'exit 3\n'
bad '"inextensible": 1' 'echo {}\ncat\n'
bad 'is not JSON' 'echo hello\ncat\n'
bad "it takes 'cows'" 'echo '\''{"inextensible": 1, "name": "a", "summary": "b", "takes": ["cows"]}'\''\n'
bad "there is a solver 'icd' already" 'echo '\''{"inextensible": 1, "name": "icd", "summary": "b"}'\''\n'

# wrong PART PYTHON: what follows the greeting; the run of it fails and says PART.
wrong() {
  sed '/^    say({})/,$d' "$SOURCE_FOLDER/contestants/process/my_engine.py" >wrong.py
  printf '    %s\n' "$2" >>wrong.py
  bench --plugin 'cmd:/usr/bin/python3 wrong.py' point <point.txt >out.json 2>err.txt || fail "$2: $(cat err.txt)"
  grep -q "$1" out.json || fail "$2: $(head -c 400 out.json)"
}
wrong 'no pins today' 'say({"refused": "no pins today"})'
wrong 'the program has ended' 'say({})'
wrong 'the program refused the step' 'say({}); sys.stdin.buffer.read(8 * (2 + 6 * len(inverse_mass))); sys.stdout.buffer.write(array("d", [1] * (2 + 6 * len(inverse_mass))).tobytes())'
wrong 'not_finite' 'say({}); sys.stdin.buffer.read(8 * (2 + 6 * len(inverse_mass))); sys.stdout.buffer.write(array("d", [0] + [math.nan] * (1 + 6 * len(inverse_mass))).tobytes())'

finish
