#!/usr/bin/env bash
# The finished program: bad input is one clear line and exit 2 with nothing written; Ctrl-C leaves valid JSON.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../..
# makes NAME ARGUMENTS...: runs the program quietly into NAME.
makes() { bench "${@:2}" --out "$1" >"$1.txt" 2>"$1.err" || fail "$* -> exit $?: $(tail -1 "$1.err")"; }

# ---- Bad input ----
echo '{"sweeps": [{"sweep": "strain", "scene": "chain", "limits": [0.1], "scene_parameters": {"n": 7}}]}' >small.json
: >empty.json
mkdir -p folder && ln -sf nowhere.json dangling.json
refused "nothing to do"
# A line "PART <- ARGUMENTS" each. SWEEP and SUITE stand for what precedes most of them.
while read -r line; do
  words=${line#* <- }
  words=${words/SWEEP/--sweep strain --profile pairs --out out.json --no-plots}
  words=${words/SUITE/--sweep strain --out out.json --config}
  eval "refused \"\${line%% <- *}\" $words"
done <<'TABLE'
did you mean 'strain' <- --sweep strian --out out.json
no point is left <- SWEEP --filter nothing
no profile of hard cases <- --sweep stability --profile large --out out.json
--filter goes with --sweep strain, resolution and step only (--case chooses <- --sweep stability --filter x --out out.json
is '1', must be a number above 0 and below 1 <- SWEEP --limit 0.01,1
--memory <- SWEEP --memory much
has one size <- SWEEP --n 10,20
give --n <- --sweep resolution --profile pairs --scene patch --out out.json
leaves no step <- SWEEP --finest 0.05
'99999999999999999999', must be a whole number <- check --solver icd --seed 99999999999999999999
cannot read the suite <- SUITE missing.json
--finest-error needs references, missing: chain-n7 <- SUITE small.json --profile pairs --scene chain --finest-error 0.02
there is no folder 'nowhere' <- film --out nowhere/x.png
no option '--limt' <- SWEEP --limt 0.01
unexpected argument 'two.json' of bench film (see bench film --help) <- film two.json
no command 'foo' (see bench --help) <- help foo
--solver is required (see bench check --help) <- check
99 s is not within the film <- film --stills 99 --out x.png
cannot read the result file 'missing.json': No such file or directory <- claims missing.json
cannot read the result file 'folder': it is a folder <- show folder
'dangling.json': it is a link to 'nowhere.json', which does not exist <- show dangling.json
cannot read the result file 'empty.json': it is empty <- show empty.json
must be 24, 30 or 60 <- choose --fps 50
TABLE
[[ ! -e nowhere ]] || fail "a refused --out made its folder"
for document in '{"schema": "inextensible-bench/1"}' "$(head -c 100000 /dev/zero | tr '\0' '[')" '{"schema": 1, "schema": 2}' '[]'; do
  echo "$document" >bad.json
  for verb in "show bad.json" "compare bad.json bad.json" "baseline bad.json --out out.json" "results bad.json"; do
    refused "bad.json" $verb
  done
done

# ---- Sweeps ----
sweep=(--sweep strain --profile pairs --no-plots --reps 1 --solver '^fast_projection$')
# A step sweep: every point has an error and a sample; the file, which claims are judged from, names no folder of this machine.
makes "$PWD/steps.json" --sweep step --profile pairs --scene chain --solver 'rattle|^fast_projection$' --filter 'strain:0.0001/' --reps 1 --no-plots
holds '
document = read("steps.json")
ok = [p for p in document["points"] if p["status"] == "ok"]
assert len({p["step"] for p in ok}) >= 4 and all(0 < p["error"]["trajectory"] < 1 for p in ok)
assert [r["name"] for r in document["references"]] == ["chain-n80.json"]
command = document["context"]["command"]
assert "steps.json" in command and not any(word.startswith("/") for word in command)'
bench claims steps.json >claims.txt && [[ $(grep -c '^C[0-9]* (' claims.txt) == 16 ]] || fail "claims has no 16 rows"
holds 'd = read("steps.json"); d["points"] = []; json.dump(d, open("nothing.json", "w"))'
refused "is what a claim is about" claims nothing.json
bench show steps.json --frame 1e9 >/dev/null || fail "show --frame: exit $?"
refused "no run with frames of at most 1e-09 ms" show steps.json --frame 1e-9
makes patch.json "${sweep[@]}" --scene patch --n 5 --limit 0.1,0.05  # not in the suite
holds 'assert {(p["scene"], p["vertices"], p["strain_limit"]) for p in read("patch.json")["points"]} == {("patch", 25, 0.1), ("patch", 25, 0.05)}'

# Google Benchmark's compare.py sets two solvers of one file against each other: rows match, and with nine runs its U test runs.
compare=/usr/share/benchmark/compare.py
if [[ -e $compare ]]; then
  makes nine.json --sweep strain --profile pairs --scene chain --solver 'icd|fast_projection' --filter 'strain:0.01/h:0.01$' --reps 9 --no-plots
  /usr/bin/python3 $compare filters nine.json chain/icd chain/fast_projection >table.txt
  grep -q 'vs. chain/fast_projection' table.txt && grep -q pvalue table.txt || fail "compare.py: $(cat table.txt)"
fi

# ---- Ctrl-C: exit 130, and a whole result stays until the new one is whole ----
tiny=("${sweep[@]}" --scene chain --filter 'strain:0.1/')
one=("${sweep[@]}" --scene chain --filter 'strain:0.01/h:0.01$')
makes old.json "${tiny[@]}"
cp old.json kept.json
"$BENCH_BINARY" --sweep strain --profile paper --scene drape --solver gauss_seidel --out old.json --no-plots --force >/dev/null 2>&1 &
pid=$!
for _ in $(seq 3000); do [[ -s old.json.journal && $(wc -l <old.json.journal) -gt 1 ]] && break; sleep 0.01; done
# Meanwhile other timed runs are refused; an untimed one need not wait, and its times are refused.
refused "process $pid is timing runs" "${one[@]}" --out out.json --no-wait
refused "process $pid is timing runs" tune --scene chain --out out.json --no-wait
makes untimed.json "${one[@]}" --untimed
refused "was made with --untimed" plot untimed.json
refused "was made with --untimed" show untimed.json --json
refused "was made with --untimed" claims untimed.json
"$BENCH_BINARY" "${one[@]}" --out waited.json >/dev/null 2>waited.txt &
waiting=$!
kill -TERM $pid  # background jobs of a script ignore SIGINT; SIGTERM takes the same way
wait $pid
[[ $? == 130 ]] || fail "an interrupted run must exit 130"
wait $waiting && [[ -s waited.json ]] || fail "a run that had to wait"
cmp -s old.json kept.json || fail "an interrupted run took the place of a whole result"
holds 'assert len(open("old.json.journal").readlines()) > 1'

# ---- A finished result is not replaced without --force ----
rm old.json.journal
bench "${tiny[@]}" --out old.json >/dev/null 2>err.txt
[[ $? == 2 ]] && grep -q "exists: --force replaces it" err.txt && cmp -s old.json kept.json || fail "a finished result: $(cat err.txt)"
makes old.json "${tiny[@]}" --force
cmp -s old.json kept.json && fail "--force did not replace it"

# ---- Standard streams that are closed or full ----
bench "${tiny[@]}" --out closed.json >/dev/null 2>&- || fail "stderr closed: exit $?"
holds 'assert read("closed.json")["complete"]'
(ulimit -f 1 && exec "$BENCH_BINARY" "${tiny[@]}" --out large.json) >/dev/null 2>err.txt
[[ $? == 2 ]] && grep -q "cannot write 'large.json" err.txt || fail "a file beyond ulimit -f: $(cat err.txt)"
bench list >/dev/full 2>err.txt
[[ $? == 1 ]] && grep -q "cannot write to 'standard output'" err.txt || fail "a full standard output: $(cat err.txt)"
bench list >&- 2>err.txt
[[ $? == 1 ]] || fail "a closed standard output goes unnoticed"
bench "${tiny[@]}" --out=-dash.json >/dev/null 2>&1 && [[ -f ./-dash.json ]] || fail "a name that begins with -"

((SANITIZED)) && finish  # what follows takes minutes with sanitizers, and the tests of its folders run there

# ---- Other verbs ----
# A user's cloth without a body has no reference, so a quick one is computed.
holds '
n = 7
with open("curtain.obj", "w") as file:
    file.writelines(f"v {i / (n - 1)} {1 - j / (n - 1)} 0\n" for j in range(n) for i in range(n))
    file.writelines(f"f {a} {a + 1} {a + n + 1} {a + n}\n" for j in range(n - 1) for a in range(j * n + 1, j * n + n))'
bench choose --scene mesh:curtain.obj --pins 'y > 0.99 and x < 0.02' --limit 0.01 --error 0.05 --solver 'yarn_projection|fast_projection' \
  --seconds 20 >chosen.txt 2>err.txt || fail "choose for a mesh: exit $?, $(tail -1 err.txt)"
# The recommended solver keeps strain and error.
holds '
import re
text = open("chosen.txt").read()
take = re.search(r"^take  (yarn|fast)_projection at 1/(\S+) s .*: (\S+) ms a frame, 99 % below (\S+), worst (\S+); strain (\S+) %, error (\S+) %", text, re.M)
rate, median, p99, worst, strain, error = (float(number) for number in take.groups()[1:])
assert strain <= 1 and error <= 5 and rate >= 60 and 0 < median <= p99 <= worst and re.match(r"curtain.obj \([0-9a-f]{4}\), 49 vertices", text), text'
# Its reference is named after the file's content, not its path, and is stored with the user's results.
place=$(bench reference --scene mesh:curtain.obj --pins 'y > 0.99 and x < 0.02' --set duration=0.08 --finest 0.0005 2>err.txt | tail -1)
[[ $place == */references/mesh-* && -s $place ]] || fail "the reference of a mesh: '$place', $(tail -1 err.txt)"
mkdir elsewhere && cp curtain.obj elsewhere/other.obj
bench reference --scene mesh:elsewhere/other.obj --n 1 --pins 'y > 0.99 and x < 0.02' --set duration=0.08 | grep -q 'nothing is missing' ||
  fail "the same file under another name"
# With other content the same name is another scene, whose error is unknown.
for faces in 36 35; do
  head -n $((49 + faces)) curtain.obj >elsewhere/curtain.obj
  makes "faces$faces.json" --sweep strain --profile pairs --scene mesh:elsewhere/curtain.obj --pins 'y > 0.99 and x < 0.02' \
    --set duration=0.08 --limit 0.01 --solver '^icd$' --untimed --no-plots
done
grep -q 'no reference, so no trajectory error' faces35.json.err || fail "a reference of other content: $(cat faces35.json.err)"
holds '
known, other = (read(f"faces{faces}.json")["points"] for faces in (36, 35))
assert known[0]["error"]["trajectory"] > 0 and not any(p["error"] and p["error"]["trajectory"] for p in other), (known, other)
assert not {p["id"] for p in known} & {p["id"] for p in other}
assert all(p["id"].startswith("mesh:curtain.obj,pins=") for p in known), known'
exits 5 'have no point in common' compare faces36.json faces35.json
rm -f "$place"
# A mesh is described and drawn, also before anything holds it.
exits 0 'a scene once it is held' mesh curtain.obj
(($(grep -c . stdout.txt) > 9)) && grep -q '36 quads' stdout.txt || fail "a mesh's description: $(cat stdout.txt)"
exits 2 'all vertices are pinned' mesh curtain.obj --pins 'y < 9'
grep -q '36 quads' stdout.txt || fail "a description of what is no scene: $(cat stdout.txt)"
refused 'cannot read the mesh' mesh nowhere.obj
# Without time for a run, or with an impossible budget, nothing is recommended; a solver named in full is tried.
exits 6 'no run ended within its strain limit in this time' choose --no-wait --scene drape --n 71 --seconds 0.5
exits 6 'no solver that was tried keeps the budget' choose --no-wait --scene chain --n 10 --error 0.5 --seconds 10 \
  --solver 'fast_projection|yarn_projection@midpoint' --budget 1e-9
! grep -q '^take' stdout.txt && grep -q fast_projection stdout.txt && grep -q yarn_projection@midpoint stdout.txt ||
  fail "a budget that cannot be kept: $(cat stdout.txt)"
# Settings are searched and stored beside those of other solvers.
cp "$root/configs/tuned.json" before.json
cp before.json tuned.json
makes tuned.json tune --scene chain --solver icd --again --trials 4 --timeout 30
holds '
before, after = ({(e["kind"], e["solver"]): e for e in read(name)["tuned"]} for name in ("before.json", "tuned.json"))
found = after[("chain", "icd")]
assert found["budget"] == 4 and all(0 < p["evaluations"] <= 4 for p in found["places"]), found
assert {p["resolution"] for p in found["places"]} <= {50, 200, 25, 12} and found["places"], found
assert len(before) > 10 and {**before, ("chain", "icd"): found} == after, before.keys() ^ after.keys()'
# Known answers can be shown.
makes known.json answers --answer net_place --solver '^fast_projection$' --no-plots
bench show known.json | grep -q '^net_place' || fail "show of known answers names nothing"

# ---- Hard cases: a partial result is completed without its journal, and pieces are the whole (kill -9: loses_nothing_test.sh) ----
cases=(--sweep stability --solver 'icd|^fast_projection$|shake' --no-plots --case)
makes whole.json "${cases[@]}" 'Q[1-4]'
holds 'd = read("whole.json"); d["complete"] = False; d["matrix"] = d["matrix"][:3]; json.dump(d, open("part.json", "w"))'
makes part.json "${cases[@]}" 'Q[1-4]' --resume
for half in 12 34; do makes "half$half.json" "${cases[@]}" "Q[$half]"; done
for files in part.json "half12.json half34.json"; do
  diff <(bench show whole.json | tail -n +2) <(bench show $files | tail -n +2) || fail "$files: not the whole"
done

# ---- Terminal, page of results, report and figures agree, in the same words, on a committed result ----
result=$root/results/paper-strain-chain.json
bench show "$result" >terminal.txt || fail "show"
bench show "$result" --json >analysis.json || fail "show --json"
bench results "$result" >page.md || fail "results"
for words in "report $result --out report.html" "plot $result --all --out figures"; do bench $words >/dev/null || fail "$words"; done
holds '
import html, re
from pathlib import Path
sentence = read("analysis.json")["findings"][0]["sentences"][0]
assert re.search(" is the fastest:| are the fastest, too close to rank:", sentence), sentence
# The words of a picture stand in its comments, a line each.
told = {str(path): " ".join(re.findall(r"<!-- (.*?) -->", path.read_text())) for path in Path("figures").glob("*.svg")}
assert any("figure4a" in name for name in told) and any("plane" in name for name in told), sorted(told)
told.update((name, html.unescape(Path(name).read_text())) for name in ("terminal.txt", "page.md", "report.html"))
# Pictures have the names that people say, the page a cell.
parts = {".svg": re.search("takes [0-9.]+ ", sentence)[0], ".md": re.search(r"takes ([0-9.]+ \(\S+\)) times", sentence)[1] + " `"}
silent = [name for name, text in told.items() if parts.get(Path(name).suffix, sentence) not in " ".join(text.split())]
assert not silent, f"{silent} do not say: {sentence}"'

finish
