#!/usr/bin/env bash
# bench compare, baseline and point: exit codes, bad input, and faults put into a second build of the program that counters
# must find. What times must find is in ab_test.sh.
rm -rf -- ./*  # of the last time
set -u
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# exits CODE PART ARGUMENTS...: that exit code, and PART in what is printed.
exits() {
  local wanted=$1 part=$2 code
  shift 2
  "$BENCH_BINARY" "$@" >stdout.txt 2>stderr.txt </dev/null
  code=$?
  [[ $code == "$wanted" ]] && cat stdout.txt stderr.txt | grep -qF -- "$part" ||
    fail "$* -> exit $code: $(cat stdout.txt stderr.txt)"
}

# refused PART ARGUMENTS...: exit 2, one line on stderr that contains PART, nothing on stdout, no report made.
refused() {
  rm -f out.xml out.md out.json
  exits 2 "$@"
  [[ $(wc -l <stderr.txt) == 1 && ! -s stdout.txt && ! -e out.xml && ! -e out.md && ! -e out.json ]] ||
    fail "${*:2}: $(cat stdout.txt stderr.txt)"
}

# A few points in which no decision depends on time, at steps fine enough that one iteration more does not change the fate
# of a run.
cat >suite.txt <<'JSON'
{"name": "small", "reps": 1, "timeout": 60, "sweeps": [
  {"sweep": "strain", "scene": "chain", "solvers": ["jacobi", "gauss_seidel", "shake", "fast_projection"],
   "limits": [0.02, 0.01, 0.001], "scene_parameters": {"n": 20},
   "steps": {"coarsest": 0.005, "finest": 0.00125, "all": true}}]}
JSON

# sweep FILE [OPTIONS...]
sweep() {
  local out=$1
  shift
  "${binary:-$BENCH_BINARY}" --sweep strain --config suite.txt --no-plots --out "$out" "$@" >/dev/null 2>&1 ||
    fail "sweep $out"
}

# edit FROM TO PYTHON: a file with the document `d` changed.
edit() {
  /usr/bin/python3 -c "import json; d = json.load(open('$1')); $3; json.dump(d, open('$2', 'w'))" || fail "edit $2"
}

rm -f ./*.json
sweep base.json
sweep again.json
binary=$BENCH_WITH_FAULTS sweep faulty.json
cat >counters.json <<'GATE'
{"times": {"count": false}}  // this machine may be busy
GATE
gate=(--gate counters.json)

# Two runs of one program; of a program that does more, and fails, where a fault was put.
exits 0 '36 points: 36 SAME' compare base.json again.json "${gate[@]}"
/usr/bin/python3 - <<'PYTHON' || fail "two runs differ in their strain"
import json
first, second = ({p["id"]: (p["max_strain"], p["rms_strain"]) for p in json.load(open(name))["points"]} for name in ("base.json", "again.json"))
assert first == second and any(all(pair) for pair in first.values()), first
PYTHON
exits 4 'NEWLY_FAILING' compare base.json faulty.json "${gate[@]}" --junit faults.xml --markdown faults.md
/usr/bin/python3 - <<'PYTHON' || fail "the changes by faults"
import xml.etree.ElementTree as tree
suite = tree.parse("faults.xml").getroot().find("testsuite")
changes = {}
for case in suite.findall("testcase"):
    failure = case.find("failure")
    changes.setdefault(case.get("name").split("/")[1], set()).add("SAME" if failure is None else failure.get("type"))
    if case.get("name").startswith("chain/fast_projection/") and failure is not None:
        assert "iterations" in failure.get("message"), failure.get("message")
assert changes["shake"] == {"SAME"} and changes["gauss_seidel"] == {"SAME"}, changes
assert changes["jacobi"] <= {"NEWLY_FAILING", "SAME"} and "NEWLY_FAILING" in changes["jacobi"], changes
assert "SLOWER" in changes["fast_projection"] and "NEWLY_FAILING" not in changes["fast_projection"], changes
assert int(suite.get("tests")) == 36 and int(suite.get("failures")) > 2
PYTHON
grep -q '^| \*\*NEWLY\\_FAILING\*\* | strain | chain/jacobi' faults.md || fail "faults.md: $(cat faults.md)"
# The other way round the failures are fixed. Less work is a change that the baseline has to learn of.
exits 3 'FIXED' compare faulty.json base.json "${gate[@]}"
edit base.json more.json 'd["points"][0]["work"]["iterations"] += 1'
exits 3 'SLOWER' compare base.json more.json "${gate[@]}"
exits 3 'CHANGED' compare more.json base.json "${gate[@]}"
echo '{"times": {"count": false}, "counters": {"rule": "rise"}}' >rise.json
exits 0 'FASTER' compare more.json base.json --gate rise.json
edit faulty.json extra.json 'd["points"] = [p for p in d["points"] if p["solver"] != "jacobi"]'
edit base.json fewer.json 'd["points"] = [p for p in d["points"] if p["solver"] != "jacobi"]'
exits 3 'SLOWER' compare fewer.json extra.json "${gate[@]}"
exits 4 'MISSING' compare base.json fewer.json "${gate[@]}"
exits 0 'NEW' compare fewer.json base.json "${gate[@]}"

# A baseline says the same as the result it is of.
"$BENCH_BINARY" baseline base.json --out baseline.json >/dev/null || fail baseline
[[ $(grep -c '^{"sweep"' baseline.json) == 36 ]] || fail "not one point a line"
grep -q 'seconds' baseline.json && fail "times in a baseline"
exits 0 '36 SAME' compare baseline.json again.json
exits 4 'SLOWER' compare baseline.json faulty.json

# A result whose every time is tripled does not pass: with enough runs it is slower, with one each nobody can say, which has an
# exit code of its own.
timed='[t.update(samples=[f(x, i) for i in range(n) for x in t["samples"][:1]]) for p in d["points"] for t in [p["seconds_per_simulated_second"]] if t]; d["context"]["sentinel"] = {"noisy": False}'
edit base.json slow1.json "n = 1; f = lambda x, i: 3 * x; $timed"
edit base.json one.json "n = 1; f = lambda x, i: x; $timed"
exits 6 'too few runs' compare one.json slow1.json
edit base.json five.json "n = 5; f = lambda x, i: x * (1 + 0.001 * i); $timed"
edit base.json slow5.json "n = 5; f = lambda x, i: 3 * x * (1 + 0.001 * i); $timed"
exits 3 'SLOWER' compare five.json slow5.json
exits 0 'FASTER' compare slow5.json five.json
# On a machine that was busy, or not as fast in both, times must differ by more than its own speed did. What is equal is equal.
edit five.json little.json "n = 5; f = lambda x, i: 1.2 * x * (1 + 0.001 * i); $timed"
edit five.json busy.json 'd["context"]["sentinel"] = {"noisy": True, "spread": 0.3}'
exits 0 'SAME' compare busy.json busy.json
exits 3 'SLOWER' compare busy.json slow5.json
edit little.json busy_little.json 'd["context"]["sentinel"] = {"noisy": True, "spread": 0.3}'
exits 3 'SLOWER' compare five.json little.json
exits 6 'too noisy a machine' compare five.json busy_little.json
edit five.json fast_machine.json 'd["context"]["sentinel"] = {"noisy": False, "seconds": [1e-3, 1.01e-3]}'
edit little.json slow_machine.json 'd["context"]["sentinel"] = {"noisy": False, "seconds": [1.3e-3, 1.31e-3]}'
exits 6 'own speed varied by as much' compare fast_machine.json slow_machine.json

# Not comparable: another build, other parameters, nothing in common. The way out is printed.
edit again.json other.json 'd["context"]["counters_fingerprint"] = "another"'
exits 5 'bench baseline other.json --out baseline.json' compare baseline.json other.json
edit again.json other.json 'd["points"][0]["scene_parameters"]["length"] = 7'
exits 5 'is not the same run in both' compare baseline.json other.json
edit again.json other.json '[p.update(id=p["id"] + "0") for p in d["points"]]'
exits 5 'no point in common' compare baseline.json other.json

# Bad input.
refused "cannot read the result file 'missing.json'" compare missing.json base.json --junit out.xml
refused "cannot read the gate 'missing.json'" compare base.json again.json --gate missing.json --markdown out.md
echo '{"schema": "another"}' >wrong.json
refused "'wrong.json' is not a result file" compare base.json wrong.json --junit out.xml
echo '{"schema": "inextensible-bench/1", "points": []}' >wrong.json
refused "'wrong.json' is not a result file" compare base.json wrong.json --junit out.xml
echo '{"schema": "inextensible-stability/1"}' >wrong.json
refused "a stability sweep, which cannot be compared" compare wrong.json base.json
echo '{"counters": {"rul": "exact"}}' >wrong.json
refused "gate 'wrong.json': 'counters': no key 'rul'; did you mean 'rule'?" compare base.json again.json --gate wrong.json --junit out.xml
refused "required" compare base.json
refused "there is no folder 'base.json'" compare base.json again.json --junit base.json/out.xml
refused "cannot read the result file" baseline missing.json --out out.json
edit base.json wrong.json 'd["complete"] = False'
refused "of an interrupted run" baseline wrong.json --out out.json
refused "is not a result file" baseline baseline.json --out out.json
refused "leaves no step" --sweep strain --profile quick --finest 0.05 --out out.json
refused "--finest" --sweep strain --profile quick --finest -1 --out out.json
refused "does not go with adaptive steps" --sweep strain --profile quick --steps adaptive --finest 0.01 --out out.json

# Single points: the same counters as in the sweep, one line each; bad ones are refused before any runs.
/usr/bin/python3 -c "
import json
points = [p for p in json.load(open('base.json'))['points'] if p['strain_limit'] == 0.01 and p['step'] == 0.005]
print('\n'.join(json.dumps(p) for p in points))" >points.txt
"$BENCH_BINARY" point --samples 3 <points.txt >printed.txt || fail point
/usr/bin/python3 - <<'PYTHON' || fail "points that were printed"
import json
given, printed = ([json.loads(line) for line in open(name)] for name in ("points.txt", "printed.txt"))
assert len(given) == len(printed) == 4
for a, b in zip(given, printed):
    assert all(a[key] == b[key] for key in ("id", "status", "work", "max_strain", "settings")), (a, b)
    assert a["status"] != "ok" or len(b["seconds_per_simulated_second"]["samples"]) == 3
assert any(b["status"] == "ok" for b in printed)
PYTHON
refused_point() {
  local part=$1
  { head -n 1 points.txt && sed -n "1{$2;p}" points.txt; } | "$BENCH_BINARY" point >stdout.txt 2>stderr.txt
  [[ ${PIPESTATUS[1]} == 2 && ! -s stdout.txt && $(wc -l <stderr.txt) == 1 ]] && grep -qF "line 2: $part" stderr.txt ||
    fail "point, $2: $(cat stdout.txt stderr.txt)"
}
refused_point "no solver 'jacob'; did you mean 'jacobi'?" 's/"solver": "jacobi"/"solver": "jacob"/'
refused_point "no scene 'chian'; did you mean 'chain'?" 's/"scene": "chain"/"scene": "chian"/'
refused_point "'step' is 0" 's/"step": 0.005/"step": 0/'
refused_point "'strain_limit' is -1" 's/"strain_limit": 0.01/"strain_limit": -1/'
refused_point "'vertices' is 81" 's/"vertices": 20/"vertices": 81/'
refused_point "'settings': no setting" 's/"settings": {}/"settings": {"targt": 1}/'
refused_point "[json" 's/"seed"/"sed"/'
refused_point "[json" 's/}$//'
refused "no point on standard input" point

# Two programs against each other: what can be said before anything is measured.
refused "'missing' is no program" ab missing "$BENCH_BINARY" --junit out.xml
refused "--pairs" ab "$BENCH_BINARY" "$BENCH_BINARY" --pairs 3
exits 2 "did you mean 'shake'" ab "$BENCH_BINARY" "$BENCH_BINARY" --solver shaek
exits 5 "has no command \`point\`" ab /bin/true "$BENCH_BINARY"

((failures == 0)) && echo "all well"
exit $((failures > 0))
