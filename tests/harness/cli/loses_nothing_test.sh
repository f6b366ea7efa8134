#!/usr/bin/env bash
# A sweep against what ends sweeps: kill -9, Ctrl-C, a folder that is gone, a second run on the same output, a journal of something
# else. Points that crash are in execute_test.cpp, full disks in faults_test.sh.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"

# The set of runs does not depend on times.
cat >suite.json <<'JSON'
{"name": "small", "reps": 2, "timeout": 20, "sweeps": [
  {"sweep": "strain", "scene": "chain", "limits": [0.1, 0.01], "scene_parameters": {"n": 20},
   "solvers": ["jacobi", "gauss_seidel", "shake", "icd", "fast_projection"], "steps": {"finest": 0.005, "all": true}},
  {"sweep": "strain", "scene": "drape", "limits": [0.1], "scene_parameters": {"n": 7, "subdivisions": 1},
   "solvers": ["jacobi", "gauss_seidel", "shake", "icd", "fast_projection"], "steps": {"coarsest": 0.01, "finest": 0.005, "all": true}}]}
JSON
sweep=(--sweep strain --config suite.json --no-plots)

# same A B: two results agree in all but times and which point was fastest.
same() {
  python3 - "$1" "$2" <<'PYTHON'
import json, sys

def points(path):
    document = json.load(open(path))
    assert document["complete"], path
    times = {"seconds_per_simulated_second", "filter_seconds_per_simulated_second", "setup_seconds", "phases",
             "peak_rss_bytes", "frame_times", "cpu_seconds_per_simulated_second", "runs_per_sample", "retaken",
             "best", "best_at_errors", "at_ladder_end"}
    return [{key: value for key, value in point.items() if key not in times} for point in document["points"]]

a, b = map(points, sys.argv[1:])
for p, q in zip(a, b):
    assert p == q, (p["id"], [(key, p[key], q[key]) for key in p if p[key] != q[key]])
assert len(a) == len(b), (len(a), len(b))
PYTHON
}

# hold RESULT LINES [OPTION...]: a run in the background ($!), stopped by SIGSTOP once its journal has LINES lines. Tries again
# if the run finishes unseen on a busy machine.
hold() {
  for _ in $(seq 20); do
    "$BENCH_BINARY" "${sweep[@]}" "${@:3}" --out "$1" >/dev/null 2>err.txt &
    while kill -0 "$!" && ! [[ -e $1.journal && $(wc -l <"$1.journal") -ge $2 ]]; do sleep 0.01; done
    if kill -STOP "$!" && [[ $(wc -l <"$1.journal") -lt $whole ]]; then return; fi
    kill -KILL "$!" 2>/dev/null
    wait "$!"
    rm -f "$1" "$1.journal"
  done 2>/dev/null
  fail "no run was seen at $2 lines"
}

# let_go SIGNAL: sends it to the held run, continues and awaits that, and returns its exit code.
let_go() {
  kill "-$1" "$!"
  kill -CONT "$!" 2>/dev/null
  wait "$!" 2>/dev/null
}

bench "${sweep[@]}" --out whole.json >/dev/null 2>&1 || fail "undisturbed run: exit $?"
[[ ! -e whole.json.journal ]] || fail "a journal is left of a run that was finished"
# The journal has a header, the points, the repetitions of those that may be best.
whole=$(python3 -c 'import json; p = json.load(open("whole.json"))["points"]
print(1 + len(p) + sum(len((q["seconds_per_simulated_second"] or {"samples": [0]})["samples"]) - 1 for q in p))')

# ---- kill -9 (at any moment: execute_test.cpp), and Ctrl-C, which leaves a part of the result ----
hold killed.json 20
let_go KILL
[[ ! -e killed.json ]] || fail "a result before the end"
hold killed.json 45 --resume
let_go INT
[[ $? == 130 ]] || fail "Ctrl-C: exit $?"
holds 'd = read("killed.json"); assert not d["complete"] and len(d["points"]) >= 4'
before=$(wc -l <killed.json.journal)
refused "--resume continues it" "${sweep[@]}" --out killed.json
[[ $(wc -l <killed.json.journal) == "$before" ]] || fail "an unfinished run was touched"
bench "${sweep[@]}" --resume --out killed.json >/dev/null 2>&1 || fail "resumed run: exit $?"
same whole.json killed.json || fail "killed and resumed is not undisturbed"
[[ ! -e killed.json.journal ]] || fail "a journal is left of a resumed run"
cp killed.json copy.json
bench "${sweep[@]}" --resume --out killed.json >stdout.txt 2>&1 || fail "--resume of a finished run: exit $?"
grep -q "complete already" stdout.txt && cmp -s killed.json copy.json || fail "--resume touched a finished run"

# ---- Two runs on one output ----
hold both.json 3
refused "another bench (process $!) is writing" "${sweep[@]}" --resume --out both.json
let_go CONT || fail "the first of two runs: exit $?"
same whole.json both.json || fail "the first of two runs was disturbed"

# ---- A journal of something else ----
hold other.json 5
let_go KILL
cp other.json.journal kept
refused "suite/reps is 3, was 2" "${sweep[@]}" --reps 3 --resume --out other.json
{ cat "$BENCH_BINARY"; echo; } >other_bench && chmod +x other_bench
BENCH_BINARY=./other_bench refused "program is" "${sweep[@]}" --resume --out other.json
cmp -s other.json.journal kept || fail "a refused journal was touched"
./other_bench "${sweep[@]}" --resume --force --out other.json >/dev/null 2>&1 || fail "--resume --force: exit $?"
same whole.json other.json || fail "resumed by another build"

# ---- Another occasion: best points alone, added to the file, in place of noisy ones, or nothing ----
python3 -c 'import json; d = json.load(open("whole.json")); d["warning"] = "noisy"; json.dump(d, open("again.json", "w"))'
bench repeat again.json --no-wait >/dev/null 2>&1 || fail "repeat of a noisy file: exit $?"
holds '
was, now = read("whole.json"), read("again.json")
assert was["context"]["suite"] == now["context"]["suite"] and "warning" not in now and "occasions" not in now["context"]
for p, q in zip(was["points"], now["points"]):
    assert (p == q) != (p["best"] or bool(p["best_at_errors"])) and p["error"] == q["error"] and p["work"] == q["work"], p["id"]'
cp whole.json again.json
bench repeat again.json --no-wait >/dev/null 2>&1 || fail "repeat: exit $?"
holds '
was, now = read("whole.json")["points"], read("again.json")["points"]
assert len(read("again.json")["context"]["occasions"]) == 1
for p, q in zip(was, now):
    assert bool(q.pop("occasions")) == (p["status"] == "ok" and (p["best"] or bool(p["best_at_errors"]))), q["id"]
    assert p.pop("occasions") == [] and p == q, q["id"]'
python3 -c 'import json; d = json.load(open("whole.json")); d["complete"] = False; json.dump(d, open("part.json", "w"))'
refused "not a complete, timed result" repeat part.json
cp again.json before.json
"$BENCH_BINARY" repeat again.json --no-wait >/dev/null 2>&1 &
while kill -0 "$!" && ! [[ -e again.json.journal && $(wc -l <again.json.journal) -ge 3 ]]; do sleep 0.01; done
kill -INT "$!" && wait "$!"
[[ $? == 130 ]] && cmp -s again.json before.json || fail "an interrupted repetition touched its file"
bench repeat again.json --no-wait >/dev/null 2>&1 || fail "repetition that goes on: exit $?"
holds 'assert len(read("again.json")["context"]["occasions"]) == 2'

# ---- The mesh changes its content ----
grid() {  # a square of 6 x 6 vertices, the lower half pulled down by so much
  for i in {0..5}; do for j in {0..5}; do echo "v $j -$i$([[ $i -gt 2 ]] && echo "$1") 0"; done; done
  for i in {0..4}; do for j in {1..5}; do echo "f $((6*i+j)) $((6*i+j+1)) $((6*i+j+7)) $((6*i+j+6))"; done; done
}
sweep+=(--scene mesh:m.obj --pins 'y >= 0' --set duration=0.3 --steps all)
whole=1000
grid .0 >m.obj
hold mesh.json 5
let_go INT
grid .5 >m.obj
refused "content=" "${sweep[@]}" --resume --out mesh.json
bench "${sweep[@]}" --resume --force --out mesh.json >/dev/null 2>&1 || fail "resumed with another mesh: exit $?"
bench "${sweep[@]}" --out fresh.json >/dev/null 2>&1 || fail "a sweep of a mesh: exit $?"
same fresh.json mesh.json || fail "points of another mesh were kept"
sweep=("${sweep[@]:0:5}")

# ---- The folder goes ----
mkdir gone
hold gone/result.json 5
rm -rf gone
let_go CONT
[[ $? == 1 ]] && grep -q "removed meanwhile" err.txt || fail "a folder that is gone: $(tail -1 err.txt)"

finish
