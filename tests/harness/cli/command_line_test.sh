#!/usr/bin/env bash
# The finished program: bad input is one clear line and exit 2 with nothing written; Ctrl-C leaves valid JSON.
rm -rf -- ./*  # of the last time
set -u
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../..
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# refused PART ARGUMENTS...: exit 2, one line on stderr that contains PART, nothing on stdout, no file made.
refused() {
  local part=$1 code lines
  shift
  rm -rf out.json
  "$BENCH_BINARY" "$@" >stdout.txt 2>stderr.txt </dev/null
  code=$?
  lines=$(wc -l <stderr.txt)
  [[ $code == 2 && $lines == 1 && ! -s stdout.txt && ! -e out.json ]] && grep -qF -- "$part" stderr.txt ||
    fail "$* -> exit $code, $lines lines: $(cat stderr.txt)"
}

sweep=(--sweep strain --profile quick --out out.json --no-plots)
refused "did you mean 'strain'" --sweep strian --out out.json
refused "did you mean 'fast_projection'" "${sweep[@]}" --solver fast_projectoin
refused "did you mean 'drape'" "${sweep[@]}" --scene drap
refused "did you mean 'quick'" --sweep strain --profile quik --out out.json
refused "no point is left" "${sweep[@]}" --filter nothing
refused "not a regular expression" "${sweep[@]}" --filter '('
refused "nothing to do"
refused "no case matches" --sweep stability --case nothing --out out.json
refused "--case goes with --sweep stability" "${sweep[@]}" --case Q1
refused "did you mean 'ratios'" --sweep stability --values ratio=2 --out out.json
refused "'x' is not a number" --sweep stability --values ratios=1,x --out out.json
refused "'distances' has 2" --sweep stability --values distances=2 --out out.json
refused "did you mean 'adaptive'" "${sweep[@]}" --steps adaptiv
refused "--steps adaptive does not go with" --sweep step --profile quick --steps adaptive --out out.json
refused "--reps" "${sweep[@]}" --reps 0
refused "whose second number is below" "${sweep[@]}" --reps 9..5
refused "must be i/N" "${sweep[@]}" --shard 2
refused "i must be from 1 to N" "${sweep[@]}" --shard 3/2
refused "--memory" "${sweep[@]}" --memory much
refused "cannot read the result file" show missing.json missing.json
refused "--unknown" "${sweep[@]}" --unknown
refused "cannot read the suite" --sweep strain --config missing.json --out out.json
echo '{"sweeps": [{"sweep": "strain", "scene": "chain", "limits": [0.1, -1]}]}' >suite.json
refused "'limits' is -1" --sweep strain --config suite.json --out out.json
echo 'not JSON' >suite.json
refused "is not JSON" --sweep strain --config suite.json --out out.json
echo 'a file' >blocked
refused "there is no folder 'blocked'" --sweep strain --profile quick --out blocked/result.json
refused "there is no folder 'nowhere'" film --out nowhere/x.png
[[ ! -e nowhere ]] || fail "a refused --out made its folder"
refused "no option '--limt'; did you mean '--limit'?" "${sweep[@]}" --limt 0.01
refused "no option '--stils=1' of bench film; did you mean '--stills'?" film --stils=1 --out x.png
refused "no command 'shwo'; did you mean 'show'?" shwo one.json
refused "unexpected argument 'two.json' of bench film (see bench film --help)" film two.json
refused "no command 'foo' (see bench --help)" help foo
refused "--solver is required (see bench check --help)" check
for seed in 99999999999999999999 -1 1.5; do
  refused "'$seed', must be a whole number of at least 0 and at most 9007199254740992" check --solver icd --seed $seed
  refused "'$seed', must be a whole number of at least 0 and at most 9007199254740992" "${sweep[@]}" --seed $seed
done
"$BENCH_BINARY" help check >help.txt && grep -q -- '--quick' help.txt || fail "help of a verb"
refused "'1' must be a number above 0 and below 1" "${sweep[@]}" --limit 1
refused "'' must be a number above 0 and below 1" "${sweep[@]}" --limit 0.01,
refused "'-1' must be a number of at least 0" film --stills=-1 --out x.png
refused "99 s is not within the film" film --stills 99 --out x.png
refused "did you mean 'shake'" film --solver icd,shakee --out x.png
refused "did you mean 'solvers'" list solver
refused "--finest-error needs references, missing: chain-n7" --sweep strain --profile quick --scene chain --out out.json --finest-error 0.02 \
  --config <(echo '{"sweeps": [{"sweep": "strain", "scene": "chain", "limits": [0.1], "scene_parameters": {"n": 7}}]}')
refused "--finest-error" "${sweep[@]}" --finest-error -1
refused "cannot read the result file 'missing.json': No such file or directory" claims missing.json
mkdir -p folder && ln -sf nowhere.json dangling.json && : >empty.json
refused "cannot read the result file 'folder': it is a folder" show folder
refused "'dangling.json': it is a link to 'nowhere.json', which does not exist" show dangling.json
refused "cannot read the result file 'empty.json': it is empty" show empty.json
echo '{"schema": "another"}' >other.json
refused "is not a result file" claims other.json
refused "did you mean 'drape'" reference --scene drap
refused "--finest" reference --finest 0

# A step sweep: an error and a sample in every point, a plane of its own; claims are judged from the file.
"$BENCH_BINARY" --sweep step --profile quick --scene chain --solver 'rattle|^fast_projection$' --filter 'strain:0.0001/' \
  --reps 1 --no-plots --out steps.json >steps.txt 2>/dev/null || fail "a step sweep"
grep -q 'vertices, step sweep: the fastest within a strain limit and an error' steps.txt || fail "no plane of the step sweep"
/usr/bin/python3 - <<'PYTHON' || fail "the step sweep's file"
import json
document = json.load(open("steps.json"))
ok = [p for p in document["points"] if p["status"] == "ok"]
assert len({p["step"] for p in ok}) >= 4
assert all(0 < p["error"]["trajectory"] < 1 for p in ok)
assert [r["name"] for r in document["references"]] == ["chain-n80.json"]
fast = {p["step"]: p["error"] for p in ok if p["solver"] == "fast_projection"}
finest = min(fast)
assert fast[finest]["trajectory"] < 0.6 * fast[2 * finest]["trajectory"] + 0.01, fast
assert fast[2 * finest]["residual_first"] > fast[finest]["residual_first"] > 0
PYTHON
"$BENCH_BINARY" claims steps.json --markdown - >claims.txt || fail "claims"
[[ $(grep -c '^| C' claims.txt) == 16 ]] || fail "claims has no 16 rows"
/usr/bin/python3 -c 'import json; d = json.load(open("steps.json")); d["points"] = []; json.dump(d, open("nothing.json", "w"))'
refused "is what a claim is about" claims nothing.json

# Which solver to take: what it says keeps strain and error, and follows from no file.
refused "must be 24, 30 or 60" choose --fps 50
refused "must be such as 2ms" choose --budget 2
refused "did you mean 'drape'" choose --scene drap
"$BENCH_BINARY" choose --scene chain --n 20 --limit 0.01 --error 0.05 --solver 'rattle|fast_projection' --seconds 20 --json \
  >choice.json 2>/dev/null || fail "choose"
/usr/bin/python3 - <<'PYTHON' || fail "what choose says"
import json
choice = json.load(open("choice.json"))
take = choice["take"]
assert take["solver"] in ("rattle", "fast_projection"), take
assert take["max_strain"] <= 0.01 and take["error"] <= 0.05 and take["step"] <= 1 / 60 + 1e-9, take
assert 0 < take["frame_seconds"]["median"] <= take["frame_seconds"]["p99"] <= take["frame_seconds"]["worst"] * (1 + 1e-12), take
assert choice["runner_up"] is None or choice["runner_up"]["seconds_per_simulated_second"] >= take["seconds_per_simulated_second"]
PYTHON

# Hard cases: SHAKE refuses Q1, as theory says, so that nothing is unexpected.
"$BENCH_BINARY" --sweep stability --case '^Q1$' --solver 'shake|^fast_projection$' --no-plots --out hard.json \
  >hard.txt 2>/dev/null || fail "hard cases"
/usr/bin/python3 - <<'PYTHON' || fail "the hard cases' file"
import json
cells = {c["solver"]: c for c in json.load(open("hard.json"))["matrix"]}
assert cells["shake"]["at_fixed_step"] == "refused" and "edge 0" in cells["shake"]["detail"], cells["shake"]
assert cells["fast_projection"]["outcome"] == "survived"
PYTHON

"$BENCH_BINARY" show hard.json >shown.txt || fail "show of hard cases"
grep -Eq '^shake +[0-9]+' shown.txt || fail "show of hard cases names no solver"

# Known answers: show says what the program said.
"$BENCH_BINARY" answers --answer net_place --solver '^fast_projection$' --no-plots --out known.json >known.txt 2>/dev/null ||
  fail "a known answer"
"$BENCH_BINARY" show known.json >shown.txt || fail "show of known answers"
grep -q '^net_place' shown.txt && grep -Eq '^  fast_projection  +h = ' shown.txt || fail "show of known answers names nothing"

# A step controller: one point a search, its rejections counted.
"$BENCH_BINARY" --sweep strain --profile quick --scene chain --solver '^fast_projection$' --steps adaptive --filter "strain:0.0" --reps 1 \
  --no-plots --out "$PWD/adaptive.json" >/dev/null 2>&1 || fail "adaptive steps"
/usr/bin/python3 - <<'PYTHON' || fail "the file of adaptive steps"
import json
document = json.load(open("adaptive.json"))
assert "adaptive.json" in document["context"]["command"] and "/" not in "".join(document["context"]["command"])
points = document["points"]
assert all(p["id"].endswith("h:adaptive") and p["status"] == "ok" for p in points), points
assert any(p["work"]["rejected_steps"] > 0 and p["smallest_step"] < p["step"] for p in points)
PYTHON

# Ctrl-C: valid JSON, not complete, exit 130.
"$BENCH_BINARY" --sweep strain --profile paper --scene drape --solver gauss_seidel --out interrupted.json --no-plots --force \
  >/dev/null 2>&1 &
pid=$!
for _ in $(seq 3000); do [[ -s interrupted.json.journal ]] && break; sleep 0.01; done
sleep 1
# Meanwhile nobody else takes times; who takes none need not wait, and nothing reads its times.
one=(--scene chain --solver '^fast_projection$' --filter 'strain:0.01/h:0.01$')
refused "process $pid is taking times" "${sweep[@]}" "${one[@]}" --no-wait
refused "process $pid is taking times" tune --scene chain --out out.json --no-wait
"$BENCH_BINARY" "${sweep[@]:0:4}" "${one[@]}" --untimed --no-plots --out untimed.json >/dev/null 2>&1 || fail "an untimed run"
refused "was made with --untimed" plot untimed.json
refused "was made with --untimed" claims untimed.json
"$BENCH_BINARY" "${sweep[@]:0:4}" "${one[@]}" --no-plots --out waited.json >/dev/null 2>waited.txt &
waiting=$!
kill -TERM $pid  # background jobs of a script ignore SIGINT; SIGTERM takes the same way
wait $pid
[[ $? == 130 ]] || fail "an interrupted run must exit 130"
wait $waiting && [[ -s waited.json ]] || fail "a run that had to wait"
/usr/bin/python3 -c 'import json; assert json.load(open("interrupted.json"))["complete"] is False' || fail "interrupted.json"

# Cloth of one's own, without a body: there is no reference, so a finer run takes its place.
/usr/bin/python3 - <<'PYTHON'
n = 7
with open("curtain.obj", "w") as file:
    file.writelines(f"v {i / (n - 1)} {1 - j / (n - 1)} 0\n" for j in range(n) for i in range(n))
    file.writelines(f"f {a} {a + 1} {a + n + 1} {a + n}\n" for j in range(n - 1) for a in range(j * n + 1, j * n + n))
PYTHON
"$BENCH_BINARY" choose --scene mesh:curtain.obj --pins 'y > 0.99 and x < 0.02' --solver 'yarn_projection|fast_projection' --seconds 20 \
  >chosen.txt 2>err.txt || fail "choose for a mesh: exit $?, $(tail -1 err.txt)"
grep -q '^curtain.obj, 49 vertices' chosen.txt && grep -q '^take  .* error [0-9.e-]* %' chosen.txt || fail "choose for a mesh: $(cat chosen.txt)"

# Settings are searched and put among those of other solvers.
cp "$root/configs/tuned.json" .
"$BENCH_BINARY" tune --scene chain --solver icd --again --trials 4 --timeout 30 --out tuned.json --quiet >/dev/null || fail "tune"
/usr/bin/python3 - "$root/configs/tuned.json" <<'PYTHON' || fail "tuned.json"
import json, sys
before, after = ({(e["kind"], e["solver"]): e for e in json.load(open(name))["tuned"]} for name in (sys.argv[1], "tuned.json"))
found = after[("chain", "icd")]
assert found["budget"] == 4 and all(0 < p["evaluations"] <= 4 for p in found["places"]), found
assert {p["resolution"] for p in found["places"]} <= {50, 200, 25, 12} and found["places"], found
assert len(before) > 10 and {**before, ("chain", "icd"): found} == after, before.keys() ^ after.keys()
PYTHON
refused "did you mean 'chain'" tune --scene chian --out out.json
refused "did you mean 'icd'" tune --solver idc --out out.json

((failures == 0)) && echo "all well"

# ---- Standard streams that are closed or full, outputs that are links, devices and pipes ----
tiny=(--sweep strain --profile quick --scene chain --solver '^fast_projection$' --filter 'strain:0.1/' --reps 1 --no-plots)
"$BENCH_BINARY" "${tiny[@]}" --out closed.json >/dev/null 2>&- || fail "stderr closed: exit $?"
python3 -c 'import json; assert json.load(open("closed.json"))["complete"]' || fail "stderr closed: the result"
"$BENCH_BINARY" list >/dev/full 2>err.txt
[[ $? == 1 ]] && grep -q "cannot write to 'standard output'" err.txt || fail "a full standard output: $(cat err.txt)"
"$BENCH_BINARY" list >&- 2>err.txt
[[ $? == 1 ]] || fail "a closed standard output goes unnoticed"
echo '{"times": {"count": false}}' >untimed.json  # this machine may be busy
"$BENCH_BINARY" compare closed.json closed.json --gate untimed.json --markdown /dev/stdout --junit junit.xml >both.txt 2>/dev/null ||
  fail "--markdown /dev/stdout: exit $?"
grep -q '^### bench compare' both.txt || fail "--markdown /dev/stdout: nothing there"
[[ $("$BENCH_BINARY" compare closed.json closed.json --gate untimed.json --markdown - | grep -c '^###') -gt 0 && ! -e - ]] || fail "--markdown -"
"$BENCH_BINARY" compare closed.json closed.json --gate untimed.json --markdown /dev/null >/dev/null && [[ -c /dev/null ]] || fail "--markdown /dev/null"
mkdir there && ln -s there/result.json link.json
"$BENCH_BINARY" "${tiny[@]}" --out link.json >/dev/null 2>&1 || fail "--out is a link: exit $?"
[[ -L link.json && -f there/result.json ]] || fail "--out lost its link"
mkfifo pipe
refused "no regular file" "${tiny[@]}" --out pipe
refused "no regular file" "${tiny[@]}" --out -
"$BENCH_BINARY" "${tiny[@]}" --out=-dash.json >/dev/null 2>&1 && [[ -f ./-dash.json ]] || fail "a name that begins with -"

# ---- A finished result is not replaced without a word ----
cp closed.json kept.json
"$BENCH_BINARY" "${tiny[@]}" --out closed.json >/dev/null 2>err.txt
[[ $? == 2 ]] && grep -q "exists: --force replaces it" err.txt && cmp -s closed.json kept.json || fail "a finished result: $(cat err.txt)"
"$BENCH_BINARY" "${tiny[@]}" --out closed.json --force >/dev/null 2>&1 || fail "--force over a finished result: exit $?"
cmp -s closed.json kept.json && fail "--force did not replace it"

# ---- Options that would do nothing, alternatives that match nothing, numbers that are none ----
for option in "--scene drape" "--filter x" "--config c.json" "--steps adaptive" "--reps 3" "--timeout 3"; do
  refused "goes with --sweep strain, resolution and step" --sweep stability $option --out out.json
done
refused "no solver 'fast'" "${sweep[@]}" --solver 'fast|shake|icd'
for number in nan inf -1 0 x 1e999; do
  refused "must be a number" "${sweep[@]}" --timeout $number
  refused "must be a number" "${sweep[@]}" --rel-ci $number
  refused "must be a number" "${sweep[@]}" --finest-error $number
done
refused "--memory" "${sweep[@]}" --memory -1
long=$(head -c 100000 /dev/zero | tr '\0' '(')
refused "not a regular expression" "${sweep[@]}" --filter "$long"
for suite in '"name": "../x"' '"reps": 1e300' '"seed": -1' '"timeout": 0' '"name": "a", "name": "b"'; do
  echo "{$suite, \"sweeps\": [{\"sweep\": \"strain\", \"scene\": \"chain\", \"limits\": [0.1]}]}" >suite.json
  refused "suite" --sweep strain --config suite.json --out out.json
done
for parameters in '"duration": 0.001' '"duration": 1e9'; do
  echo "{\"sweeps\": [{\"sweep\": \"strain\", \"scene\": \"chain\", \"limits\": [0.1], \"scene_parameters\": {$parameters}, \"steps\": {\"coarsest\": 0.01}}]}" >suite.json
  refused "'duration' is" --sweep strain --config suite.json --out out.json
done
for settings in '"linear_solver": 3' '"max_iterations": 0.5' '"max_iterations": -1' '"no_such": 1'; do
  echo "{\"sweeps\": [{\"sweep\": \"strain\", \"scene\": \"chain\", \"limits\": [0.1], \"solver_options\": {\"fast_projection\": {$settings}}}]}" >suite.json
  refused "solver_options" --sweep strain --config suite.json --out out.json
done
for document in '{"schema": "inextensible-bench/1"}' "$(head -c 100000 /dev/zero | tr '\0' '[')" '{"schema": 1, "schema": 2}' '[]' '3'; do
  echo "$document" >bad.json
  for verb in "show bad.json" "compare bad.json bad.json" "baseline bad.json --out out.json" "claims bad.json" "results bad.json"; do
    refused "bad.json" $verb
  done
done

# ---- Words and options for people ----
"$BENCH_BINARY" sweep strain "${tiny[@]:2}" --out worded.json >/dev/null 2>&1 || fail "bench sweep strain: exit $?"
[[ $("$BENCH_BINARY" help show) == "$("$BENCH_BINARY" show --help)" ]] || fail "bench help show"
"$BENCH_BINARY" --help | grep -q "^Usage: bench" || fail "the usage does not begin with bench"
"$BENCH_BINARY" -V | grep -qE '^bench [0-9.]+.*(Release|Debug) by ' || fail "-V: $("$BENCH_BINARY" -V)"
"$BENCH_BINARY" show worded.json | grep -q 'fast_projection' || fail "bench show"
"$BENCH_BINARY" list --json | python3 -c 'import json, sys
d = json.load(sys.stdin)
assert {"fast_projection", "icd"} <= {s["name"] for s in d["solvers"]} and {"chain", "drape"} <= {s["name"] for s in d["scenes"]}' ||
  fail "bench list --json"
# A verb's name after a verb is a word of it. Help has every verb.
"$BENCH_BINARY" list answers | grep -q '^  net_place (spinning_net): ' || fail "bench list answers"
[[ $("$BENCH_BINARY" help sweep) == "$("$BENCH_BINARY" --help)" ]] || fail "bench help sweep"
"$BENCH_BINARY" --help >help.txt
"$BENCH_BINARY" list verbs | sed -n 's/^  \([a-z]*\): .*/\1/p' >verbs.txt
[[ $(wc -l <verbs.txt) -gt 15 && $(head -n 1 verbs.txt) == sweep ]] || fail "bench list verbs: $(cat verbs.txt)"
while read -r verb; do
  grep -q "^  $verb  " help.txt || fail "no help of $verb"
done < <(tail -n +2 verbs.txt)
"$BENCH_BINARY" --sweep strain --profile quick --scene patch --n 5 --limit 0.1,0.05 --solver '^fast_projection$' --reps 1 --no-plots \
  --out patch.json >/dev/null 2>&1 || fail "a scene that the suite has not: exit $?"
python3 - <<'PYTHON' || fail "--scene, --n and --limit"
import json
points = json.load(open("patch.json"))["points"]
assert {p["scene"] for p in points} == {"patch"} and {p["vertices"] for p in points} == {25}, points
assert {p["strain_limit"] for p in points} == {0.1, 0.05}
PYTHON
refused "must be a whole number" "${sweep[@]}" --n 2.5
refused "must be a number above 0" "${sweep[@]}" --limit 0.1,x
refused "has one size" "${sweep[@]}" --n 10,20
refused "give --n" --sweep resolution --profile quick --scene patch --out out.json
"$BENCH_BINARY" --sweep strain --profile quick --scene chain --dry-run | grep -q 'searches for a best step' || fail "--dry-run"

# ---- Hard cases go on where they were ----
cases=(--sweep stability --case 'Q[1-4]' --solver 'icd|fast_projection' --no-plots)
"$BENCH_BINARY" "${cases[@]}" --dry-run | grep -q 'cells' || fail "--dry-run of hard cases"
"$BENCH_BINARY" "${cases[@]}" --out whole.json >/dev/null 2>&1 || fail "hard cases: exit $?"
[[ ! -e whole.json.journal ]] || fail "a journal is left of hard cases"
"$BENCH_BINARY" "${cases[@]}" --out cut.json >/dev/null 2>&1 &
for _ in $(seq 500); do [[ -e cut.json.journal && $(wc -l <cut.json.journal) -ge 3 ]] && break; sleep 0.01; done
kill -KILL $! 2>/dev/null
wait $! 2>/dev/null
if [[ -e cut.json.journal ]]; then
  "$BENCH_BINARY" "${cases[@]}" --out cut.json >/dev/null 2>err.txt
  [[ $? == 2 ]] && grep -q -- "--resume continues it" err.txt || fail "an unfinished stability sweep is not asked about: $(cat err.txt)"
fi
"$BENCH_BINARY" "${cases[@]}" --resume --out cut.json >/dev/null 2>&1 || fail "resumed hard cases: exit $?"
python3 - <<'PYTHON' || fail "resumed hard cases are not undisturbed ones"
import json
def cells(name):
    return [{k: v for k, v in c.items() if k != "seconds"} for c in json.load(open(name))["matrix"]]
assert cells("whole.json") == cells("cut.json")
PYTHON
# ... and a result that an interrupt left goes on too, without its journal.
python3 - <<'PYTHON'
import json
document = json.load(open("whole.json"))
document["complete"] = False
document["matrix"] = document["matrix"][:3]
json.dump(document, open("part.json", "w"))
PYTHON
"$BENCH_BINARY" "${cases[@]}" --resume --out part.json >/dev/null 2>&1 || fail "hard cases resumed from a result: exit $?"
# Shards are the whole, in its order, whichever comes first.
for i in 1 2 3; do
  "$BENCH_BINARY" "${cases[@]}" --shard "$i/3" --out "shard$i.json" >/dev/null 2>&1 || fail "shard $i of hard cases: exit $?"
done
"$BENCH_BINARY" show shard1.json shard3.json | grep -q "a shard is missing" || fail "a missing shard of hard cases"
same_table() { diff <("$BENCH_BINARY" show whole.json | tail -n +2) <("$BENCH_BINARY" show "$@" | tail -n +2); }
same_table shard1.json shard2.json shard3.json || fail "shards of hard cases are not the whole"
same_table part.json || fail "hard cases resumed from a result are not the whole"

exit $((failures > 0))
