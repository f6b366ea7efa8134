#!/usr/bin/env bash
# From an installed bench: the solver of docs/plugins.md and a program out of the tree are built; the solver is listed, swept,
# recorded and checked; what does not fit gives one clear line and exit 2.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../harness/cli/functions.sh"

# quietly COMMAND...: shows what it printed only if it fails, and ends the test.
quietly() {
  "$@" >quietly.txt 2>&1 || { cat quietly.txt; echo "FAILED: $*"; exit 1; }
}

quietly cmake --install "$BUILD_FOLDER" --prefix "$PWD/installed"
bench=$PWD/installed/bin/bench plugin=./my_solver.so
BENCH_BINARY=$bench  # of `refused`

# The page's solver, by the page's command; and strictly by the standard, without bench's flags.
sed -n '/^<!-- file: my_solver.c -->$/,/^```$/p' "$SOURCE_FOLDER/docs/plugins.md" | sed '1,2d;$d' >my_solver.c
ln -s "$SOURCE_FOLDER/solvers" solvers
quietly "$CC" -std=c99 -Wall -Wextra -Wpedantic -Werror -O2 -shared -fPIC -Iinstalled/include my_solver.c -o strict.so -lm
eval "quietly $(grep -m1 '^cc -O2 -shared' "$SOURCE_FOLDER/docs/plugins.md")"

# The program of solvers/README.md. With the core it needs no library beyond the compiler's.
sed -n '/^<!-- file: cloth.cpp -->$/,/^```$/p' "$SOURCE_FOLDER/solvers/README.md" | sed '1,2d;$d' >cloth.cpp
for library in core solvers; do
  CMAKE_GENERATOR=Ninja quietly cmake -S "$SOURCE_FOLDER/tests/solvers/plugin/installed" -B build-$library -DCMAKE_PREFIX_PATH="$PWD/installed" \
    -DCLOTH="$PWD/cloth.cpp" -DLIBRARY=$library
  quietly cmake --build build-$library
  build-$library/cloth >cloth.txt || fail "the program of one's own: $(cat cloth.txt)"
done
ldd build-core/cloth build-core/libshared.so | grep -Ei 'blas|lapack|cholmod|umfpack|amd|gomp' && fail "the core needs more than Eigen"
ldd build-solvers/libshared.so | grep -q cholmod || fail "the shared library lacks CHOLMOD"

# The option may stand before and after the command.
"$bench" --plugin "$plugin" list solvers | grep -q '^  symmetric_sweeps: ' || fail "list does not show the plug-in's solver"
"$bench" list --plugin "$plugin" solvers | grep -q '^  symmetric_sweeps: ' || fail "--plugin after the command"
"$bench" list solvers | grep -q symmetric && fail "a solver that was not loaded"

[[ ! -e $BUILD_FOLDER/libinextensible_python.so ]] ||
  "$bench" --plugin "$SOURCE_FOLDER/contestants/python/gauss_seidel.py" list solvers | grep -q numpy_gauss || fail "an installed bench without Python"

tiny() {
  "$bench" --plugin "$plugin" --sweep strain --profile pairs --scene chain --n 20 --reps 1 --filter 'strain:0.01/' "$@"
}
refused "did you mean 'symmetric_sweeps'" --plugin "$plugin" --sweep strain --solver symetric_sweeps --out out.json
refused "no solver 'symmetric_sweeps'" --sweep strain --solver symmetric_sweeps --out out.json
# By default an installed bench writes to the current folder; a sweep that names no solvers has the plug-in's among them.
tiny --exclude 'jacobi|icd|shake|rattle|springs|yarn_projection|adaptive|xpbd|bdf2|colored' --no-plots >sweep.txt 2>&1 || fail "a sweep: $(cat sweep.txt)"
holds '
document = read("results/local/pairs-strain.json")
plugin, = document["context"]["plugins"]
assert len(plugin.pop("hash")) == 16, plugin
assert plugin == {"file": "my_solver.so", "version": "1.0", "solvers": ["symmetric_sweeps"], "optimized": True}, plugin
best = {p["solver"] for p in document["points"] if p["best"]}
assert {"symmetric_sweeps", "gauss_seidel", "fast_projection"} <= best, best
mine = [p for p in document["points"] if p["solver"] == "symmetric_sweeps" and p["best"]][0]
assert 0 < mine["max_strain"] <= 0.01 and mine["work"]["edge_projections"] > 0, mine'
mkdir figures
tiny --solver 'symmetric_sweeps|gauss_seidel' --out figures/out.json >sweep.txt 2>&1 || fail "a sweep with figures: $(cat sweep.txt)"
grep -q 'could not be drawn' sweep.txt && fail "no figures: $(cat sweep.txt)"
ls figures/*.svg >/dev/null || fail "no figures"
"$bench" --plugin "$plugin" report figures/out.json --out page.html >report.txt 2>&1 || fail "a page of an installed bench: $(cat report.txt)"
[[ -n $(find installed -name LICENSE) && -n $(find installed -name NOTICE) ]] || fail "the license is not installed"
[[ $("$bench" --version) == *MIT*'GPL, version 3 or later'* ]] || fail "--version does not name the licenses"

# ---- Every verb of an installed bench ----
tiny --solver fast_projection --no-plots --out small.json >sweep.txt 2>&1 || fail "a small sweep: $(cat sweep.txt)"
holds 'print(json.dumps(read("small.json")["points"][0]))' >point.txt
cp installed/share/inextensible/configs/tuned.json .

# use VERB: a small use of it. A verb that is not named here is called alone, and named here if it needs words.
use() {
  local words=()
  case $1 in
    sweep) words=(strain --profile pairs --scene chain --dry-run) ;;
    show | results) words=(small.json) ;;
    repeat) words=(small.json --no-wait) ;;
    plot) words=(small.json --out drawn) ;;
    report) words=(small.json --out page.html) ;;
    answers) words=(--answer net_place --solver fast_projection --no-plots --out known.json) ;;
    film) words=(--scene chain --set n=9 --set duration=0.1 --solver fast_projection --stills 0.05 --width 160 --out film.png) ;;
    choose) words=(--scene chain --n 5 --solver fast_projection --seconds 20 --error 0.5) ;;
    check) words=(--solver fast_projection --quick) ;;
    claims) words=("$SOURCE_FOLDER/results/paper-strain-chain.json") ;;
    compare) words=(small.json small.json) ;;
    baseline) words=(small.json --out baseline.json) ;;
    ab) words=("$bench" "$bench" --scene chain --solver fast_projection --filter 'strain:0.01/' --pairs 4 --sample-seconds 0.001) ;;
    export) words=(--scene chain --out exported) ;;
    mesh) words=(exported/cloth.obj) ;;
    judge) words=(exported exported/reference.npz) ;;
    tune) words=(--scene chain --solver icd --out tuned.json) ;;  # there already
    reference) words=(--profile pairs --scene chain) ;;           # there already
  esac
  "$bench" "$1" "${words[@]}" <point.txt
}
while read -r verb <&3; do
  use "$verb" >verb.txt 2>&1
  code=$?
  ((code == 0)) || [[ $verb == ab && $code != [12] ]] ||  # whose verdict a busy machine may change
    fail "an installed bench $verb: exit $code, $(tail -n 2 verb.txt)"
done 3< <("$bench" list verbs --json | /usr/bin/python3 -c 'import json, sys; print(*(v["name"] for v in json.load(sys.stdin)), sep="\n")')
for part in '</html>' '<style>' 'const points = '; do grep -q "$part" page.html || fail "the page of an installed bench lacks $part"; done

kinds=$BUILD_FOLDER/tests
"$bench" check --solver symmetric_sweeps --plugin "$plugin" >check.txt 2>&1 || fail "a sound solver: $(cat check.txt)"
grep -q '^symmetric_sweeps conforms: ' check.txt || fail "it must conform: $(cat check.txt)"
grep -q '^PASS  hard cases' check.txt || fail "no hard cases: $(cat check.txt)"
"$bench" --plugin "$kinds/libplugin_broken.so" check --solver misfit --quick >check.txt 2>&1
[[ $? == 4 ]] || fail "a broken solver must exit 4: $(cat check.txt)"
grep -q '^FAIL  limit .*(allowed 1)$' check.txt && grep -q '^      -> .*edge [0-9]* is strained' check.txt &&
  grep -q '^misfit does not conform: ' check.txt || fail "a broken solver must not conform: $(cat check.txt)"
refused "did you mean 'symmetric_sweeps'" --plugin "$plugin" check --solver symetric_sweeps

# What it throws costs it its own points, and how it rounds when it is loaded no one else's.
point() { "$bench" "$@" point <point.txt | /usr/bin/python3 -c 'import json, sys; p = json.load(sys.stdin); print(p["status"], p["max_strain"], p["rms_strain"])'; }
sed 's/fast_projection/misfit/g' point.txt >thrown.txt
"$bench" --plugin "$kinds/libplugin_throws_later.so" point <thrown.txt | grep -q 'the plug-in threw an exception' || fail "a plug-in that throws"
[[ $(point) == "$(point --plugin "$kinds/libplugin_plain.so")" ]] || fail "a plug-in's rounding mode reaches others"

# ---- What a row may lack ----
sound() { printf '%s' "$kinds/libplugin_$1.so"; }
"$bench" --plugin "$(sound bare)" --sweep strain --profile pairs --reps 1 --filter 'strain:0.0*1/' --solver sound \
  --no-plots --out bare.json >sweep.txt 2>&1 || fail "a solver without collider: $(cat sweep.txt)"
grep -q 'left out, because .*drape by sound (collider)' sweep.txt || fail "a scene left out in silence: $(cat sweep.txt)"
holds '
points = [p for p in read("bare.json")["points"] if p["solver"] == "sound"]
assert any(p["best"] for p in points if p["scene"] == "chain"), points
assert not any(p["scene"] == "drape" for p in points), "a suite that names no solvers leaves out those that do not take its scene"'
"$bench" --plugin "$(sound bare)" check --solver sound --quick >check.txt 2>&1
code=$?
grep -q '^sound conforms: ' check.txt && [[ $code == 0 ]] || fail "a sound solver without shear and collider: exit $code, $(cat check.txt)"

# ---- Two versions of a plug-in, timed against each other ----
"$bench" ab bench bench --old-plugin "$(sound plain)" --new-plugin "$(sound slow)" --scene drape \
  --profile pairs --solver sound --filter 'strain:0.001/' --pairs 8 --confirm 8 --sample-seconds 0.02 >ab.txt 2>&1
# A busy machine may leave it open, but never says that they are the same.
[[ $? == [36] ]] && grep -Eq '^(SLOWER|AMBIGUOUS).*sound' ab.txt || fail "a plug-in that has become slower: $(cat ab.txt)"
"$bench" --plugin "$(sound plain)" --sweep strain --profile pairs --scene chain --solver sound --filter 'strain:0.1/' --untimed \
  --no-plots --out sound.json >sweep.txt 2>&1 || fail "a sound solver's sweep: $(cat sweep.txt)"
/usr/bin/python3 -c 'import json; print(json.dumps(json.load(open("sound.json"))["points"][0]))' |
  "$bench" --plugin "$(sound loud)" point >point.json 2>loud.txt || fail "a point of a plug-in that prints: $(tail -n 1 loud.txt)"
/usr/bin/python3 -c 'import json; assert json.load(open("point.json"))["solver"] == "sound"' || fail "no result: $(head -c 200 point.json)"
grep -q "a line of the solver's own" loud.txt || fail "what a plug-in prints is lost"
refused "there is no such file" ab "$bench" "$bench" --old-plugin "$(sound plain)" --new-plugin missing.so

seq 100 >text.so
refused "there is no such file" --plugin missing.so list
refused "invalid ELF header" --plugin text.so list
refused "has no function inextensible_plugin" --plugin "$(ldd "$bench" | awk '/libm\.so/ {print $3}')" list
refused "built for version 999 of the interface, this program has version 1" --plugin "$kinds/libplugin_another_version.so" list
refused "there is a solver 'shake' already" --plugin "$kinds/libplugin_taken_name.so" list
refused "no licence for today" --plugin "$kinds/libplugin_throws.so" list
refused "killed by SIGSEGV" --plugin "$kinds/libplugin_crashes.so" list
refused "ended with exit code 3" --plugin "$kinds/libplugin_exits.so" list
refused "there is a solver 'symmetric_sweeps' already" --plugin "$plugin" list --plugin "$plugin"
refused "there is no such file" --plugin "$plugin" --plugin missing.so "--sweep" strain --out out.json

finish
