#!/usr/bin/env bash
# bench compare, baseline, ab and point: exit codes, bad input, and faults put into a second build of the program that counters
# must find. What times must find is in plugin_test.sh and comparison_test.cpp, as is how single points are judged.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"

# edit FROM TO PYTHON: a file with the document `d` changed.
edit() {
  /usr/bin/python3 -c "import json; d = json.load(open('$1')); $3; json.dump(d, open('$2', 'w'))" || fail "edit $2"
}

# A few points in which no decision depends on time, at steps fine enough that one iteration more does not change the fate
# of a run.
cat >suite.txt <<'JSON'
{"name": "small", "reps": 1, "timeout": 60, "sweeps": [
  {"sweep": "strain", "scene": "chain", "solvers": ["jacobi", "gauss_seidel", "shake", "fast_projection"],
   "limits": [0.02, 0.01, 0.001], "scene_parameters": {"n": 20},
   "steps": {"coarsest": 0.005, "finest": 0.00125, "all": true}}]}
JSON
for run in base again faulty; do
  [[ $run == faulty ]] && binary=$BENCH_WITH_FAULTS || binary=$BENCH_BINARY
  "$binary" --sweep strain --config suite.txt --no-plots --out $run.json >/dev/null 2>&1 || fail "sweep $run"
done
echo '{"times": {"count": false}}  // this machine may be busy' >counters.json
gate=(--gate counters.json)

# Two runs of one program; of a program that does more, and fails, where a fault was put.
exits 0 '36 points: 36 SAME' compare base.json again.json "${gate[@]}"
exits 4 'NEWLY_FAILING' compare base.json faulty.json "${gate[@]}"
grep -qE '^NEWLY_FAILING +strain chain/jacobi/' stdout.txt && grep -qE '^SLOWER +strain chain/fast_projection/.*iterations' stdout.txt &&
  ! grep -qE 'chain/(shake|gauss_seidel)/|NEWLY_FAILING.*fast_projection' stdout.txt || fail "the changes by faults: $(cat stdout.txt)"
holds '
first, second = ({p["id"]: (p["max_strain"], p["rms_strain"]) for p in read(name)["points"]} for name in ("base.json", "again.json"))
assert first == second and any(all(pair) for pair in first.values()), first'
# The other way round the failures are fixed. Less work is a change that the baseline has to learn of.
exits 3 'FIXED' compare faulty.json base.json "${gate[@]}"
edit base.json fewer.json 'd["points"] = [p for p in d["points"] if p["solver"] != "jacobi"]'
exits 4 'MISSING' compare base.json fewer.json "${gate[@]}"
exits 0 'NEW' compare fewer.json base.json "${gate[@]}"

# A baseline compares like its result.
"$BENCH_BINARY" baseline base.json --out baseline.json >/dev/null || fail baseline
[[ $(grep -c '^{"sweep"' baseline.json) == 36 ]] && ! grep -q seconds baseline.json || fail "a baseline has times, or not one point a line"
exits 0 '36 SAME' compare baseline.json again.json
exits 4 'SLOWER' compare baseline.json faulty.json

# A result whose times are all longer does not pass: with enough runs it is slower, with one each it is undecided (exit code 6).
# Times must differ by more than the machine's own speed did.
# timed NAME RUNS FACTOR [SENTINEL]: base.json with RUNS samples a point, all longer by a factor.
timed() {
  local sentinel=${4-"{'noisy': False}"}
  edit base.json "$1.json" "[(lambda s: t.update(samples=s, **{key: s[0] * (1 + 0.001 * part * ($2 - 1)) for key, part in
    dict(min=0, q1=0.25, median=0.5, q3=0.75).items()}))([$3 * t['samples'][0] * (1 + 0.001 * i) for i in range($2)])
for p in d['points'] for t in [p['seconds_per_simulated_second']] if t]; d['context']['sentinel'] = $sentinel"
}
noisy="{'noisy': True, 'spread': 0.3}"
fast="{'noisy': False, 'seconds': [1e-3, 1.01e-3]}"
slow="{'noisy': False, 'seconds': [1.3e-3, 1.31e-3]}"
while IFS='|' read -r code before after words; do
  eval "timed before $before; timed after $after"
  exits "$code" "$words" compare before.json after.json
done <<'TABLE'
6|1 1|1 3|too few runs
0|5 3|5 1|FASTER
0|5 1 "$noisy"|5 1 "$noisy"|SAME
3|5 1 "$noisy"|5 3|SLOWER
3|5 1|5 1.2|SLOWER
6|5 1|5 1.2 "$noisy"|too noisy a machine
6|5 1 "$fast"|5 1.2 "$slow"|own speed varied by as much
TABLE

# Not comparable: another build, other parameters, nothing in common. The way out is printed.
edit again.json other.json 'd["context"]["counters_fingerprint"] = "another"'
exits 5 'bench baseline other.json --out baseline.json' compare baseline.json other.json
edit again.json other.json 'd["points"][0]["scene_parameters"]["length"] = 7'
exits 5 'is not the same run in both' compare baseline.json other.json
edit again.json other.json '[p.update(id=p["id"] + "0") for p in d["points"]]'
exits 5 'no point in common' compare baseline.json other.json

# Bad input.
echo '{"schema": "another"}' >wrong.json && echo '{"schema": "inextensible-stability/1"}' >hard.json
edit base.json part.json 'd["complete"] = False'
while IFS='|' read -r words arguments; do
  refused "$words" $arguments
done <<TABLE
cannot read the gate 'missing.json'|compare base.json again.json --gate missing.json
'wrong.json' is not a result file|compare base.json wrong.json
a stability sweep, which cannot be compared|compare hard.json base.json
from an interrupted run|baseline part.json --out out.json
is not a result file|baseline baseline.json --out out.json
no point on standard input|point
'missing' is not a program|ab missing $BENCH_BINARY
--pairs|ab $BENCH_BINARY $BENCH_BINARY --pairs 3
TABLE
exits 2 "did you mean 'shake'" ab "$BENCH_BINARY" "$BENCH_BINARY" --solver shaek
exits 5 "has no command \`point\`" ab /bin/true "$BENCH_BINARY"

# Single points: the same counters as in the sweep, one line each; bad ones are refused before any runs.
/usr/bin/python3 -c "
import json
points = [p for p in json.load(open('base.json'))['points'] if p['strain_limit'] == 0.01 and p['step'] == 0.005]
print('\n'.join(json.dumps(p) for p in points))" >points.txt
"$BENCH_BINARY" point --samples 3 <points.txt >printed.txt || fail point
holds '
given, printed = ([json.loads(line) for line in open(name)] for name in ("points.txt", "printed.txt"))
assert len(given) == len(printed) == 4 and any(b["status"] == "ok" for b in printed)
for a, b in zip(given, printed):
    assert all(a[key] == b[key] for key in ("id", "status", "work", "max_strain", "settings")), (a, b)
    assert a["status"] != "ok" or len(b["seconds_per_simulated_second"]["samples"]) == 3'
while IFS='|' read -r words replacement; do
  { head -n 1 points.txt && sed -n "1{s/$replacement/;p}" points.txt; } | "$BENCH_BINARY" point >stdout.txt 2>stderr.txt
  [[ ${PIPESTATUS[1]} == 2 && ! -s stdout.txt && $(wc -l <stderr.txt) == 1 ]] && grep -F "line 2" stderr.txt | grep -qF "$words" ||
    fail "point, $replacement: $(cat stdout.txt stderr.txt)"
done <<'TABLE'
'solver': no solver 'jacob'; did you mean 'jacobi'?|"solver": "jacobi"/"solver": "jacob"
'step' is 0|"step": 0.005/"step": 0
'strain_limit' is -1|"strain_limit": 0.01/"strain_limit": -1
'settings': no setting|"settings": {}/"settings": {"targt": 1}
[json|"seed"/"sed"
TABLE

# bench ab finds both faults in pairs of one step, which every solver gets through. Counters fail by a gate only.
ab=(ab "$BENCH_BINARY" "$BENCH_WITH_FAULTS" --scene chain --filter 'strain:0.01/h:0.0025$' --pairs 4 --solver)
exits 4 'strain chain/jacobi' "${ab[@]}" jacobi
grep -q '^NEWLY_FAILING *strain chain/jacobi' stdout.txt || fail "a failing solver: $(cat stdout.txt)"
echo '{"counters": {"rule": "exact"}}' >exact.json
exits 3 'iterations ' "${ab[@]}" fast_projection --gate exact.json
grep -q '^SLOWER *strain chain/fast_projection' stdout.txt || fail "more work: $(cat stdout.txt)"

finish
