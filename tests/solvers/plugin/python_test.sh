#!/usr/bin/env bash
# Solvers in Python: the examples conform, agree with bench's own and are swept; what is wrong with a file gives one line, and what
# a step raises costs its own run alone.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../harness/cli/functions.sh"

[[ -e $BUILD_FOLDER/libinextensible_python.so ]] || { echo "bench was built without Python"; exit 77; }
examples=$SOURCE_FOLDER/contestants/python
plugins=(--plugin "$examples/gauss_seidel.py" --plugin "$examples/fast_projection.py")

bench "${plugins[@]}" check --quick --solver 'numpy_gauss_seidel,scipy_fast_projection' >check.txt 2>&1 || fail "check: $(cat check.txt)"
bench "${plugins[@]}" --sweep strain --profile pairs --scene chain --n 20 --untimed --filter 'strain:0.1/' \
  --solver 'numpy_gauss_seidel,gauss_seidel_colored' --no-plots --out sweep.json >sweep.txt 2>&1 || fail "a sweep: $(cat sweep.txt)"
holds '
document = read("sweep.json")
plugins = {p["file"]: p for p in document["context"]["plugins"]}
assert set(plugins) == {"gauss_seidel.py", "fast_projection.py"} and len({p["hash"] for p in plugins.values()}) == 2, plugins
assert plugins["gauss_seidel.py"]["version"].startswith("Python 3."), plugins
mine, theirs = ([p for p in document["points"] if p["solver"] == solver and p["status"] == "ok"] for solver in ("numpy_gauss_seidel", "gauss_seidel_colored"))
assert mine and {p["step"] for p in mine} & {p["step"] for p in theirs}, (mine, theirs)
for a, b in ((a, b) for a in mine for b in theirs if a["step"] == b["step"]):
    assert a["max_strain"] <= 0.1 and a["work"]["edge_projections"] > 0, a
    assert abs(a["error"]["trajectory"] - b["error"]["trajectory"]) < 0.02, (a["error"], b["error"])'

# run SOLVER [SETTINGS]: runs of it on a chain and on a net, as points.
run() {
  /usr/bin/python3 - "$1" "${2-{\}}" "$(bench list scenes --json)" >specs.txt <<'PYTHON'
import json
import sys
solver, settings, scenes = sys.argv[1:]
defaults = {scene["name"]: {p["name"]: p["default"] for p in scene["parameters"]} for scene in json.loads(scenes)}
for scene, n in (("chain", 20), ("spinning_net", 9)):
    print(json.dumps({"scene": scene, "solver": solver, "settings": json.loads(settings), "strain_limit": 1e-4, "step": 0.002, "seed": 1,
                      "scene_parameters": defaults[scene] | {"n": n}, "sweep": "step", "resolution": n, "vertices": 1, "constraints": 1}))
PYTHON
  bench "${@:3}" point <specs.txt
}
# Fast projection, both with all digits: distances to the reference and strains along the whole run agree to rounding.
run fast_projection '{"linear_solver": "multifrontal"}' >theirs.txt 2>points.err || fail "points: $(cat points.err)"
run scipy_fast_projection '{}' "${plugins[@]}" >mine.txt 2>points.err || fail "points: $(cat points.err)"
holds '
for line, other in zip(open("mine.txt"), open("theirs.txt"), strict=True):
    a, b = json.loads(line), json.loads(other)
    assert a["status"] == b["status"] == "ok" and a["scene"] == b["scene"], (a, b)
    assert a["work"]["iterations"] == b["work"]["iterations"] > 100, (a["work"], b["work"])
    for key in ("trajectory", "trajectory_mean", "trajectory_max", "energy_drift"):
        assert abs(a["error"][key] - b["error"][key]) < 1e-9 and a["error"][key] > 1e-6, (key, a["error"], b["error"])
    for key in ("max_strain", "rms_strain"):
        assert abs(a[key] - b[key]) < 1e-9 < a[key], (key, a[key], b[key])
    assert abs(a["kinetic_energy_mean"] / b["kinetic_energy_mean"] - 1) < 1e-9, (a, b)'

# ---- What is wrong with a file ----
# bad PART TEXT: the file is refused in one line that names PART; what it prints goes to standard error.
bad() {
  printf '%b' "$2" >bad.py
  refused "$1" --plugin ./bad.py list solvers
}
solver='class A:\n  name, summary = "a", "b"\n  def __init__(self, scene): pass\n  def filter(self, step): pass\n'
bad 'bad.py, line 2: SyntaxError' 'x = 1\nclass A\n'
bad 'no class with `name` and `summary`' 'x = 1\n'
bad 'bad.py, line 2: SystemExit: 0' 'import sys\nsys.exit(0)\n'
bad 'bad.py, line 3: ValueError: of two lines' 'def f():\n\n  raise ValueError("of\\ntwo lines")\nf()\n'
bad 'ended with exit code 3' 'import os\nos._exit(3)\n'
bad 'killed by SIGSEGV' 'import ctypes\nctypes.string_at(0)\n'
bad "A.takes: 'cows', must be one of collider" "$solver  takes = {'cows'}\n"
bad "settings['gain'] is (1, 2)" "${solver/scene/scene, gain}  settings = {'gain': (1, 2)}\n"
bad "__init__(self, scene, **settings) and \`settings\` do not match" "$solver  settings = {'gain': (1, 0, 2, 'g')}\n"
bad "'gain' begins outside its range" "${solver/scene/scene, gain}  settings = {'gain': (3, 0, 2, 'g')}\n"
bad 'no method filter(self, step)' "${solver/filter/filtre}"
bad "there is a solver 'a' already" "${solver}solvers = [A, A]\n"
printf '%b' "$solver" >math.py
refused "there is a module 'math' already" --plugin ./math.py list solvers

# ---- What a step does wrong: its own run is refused and says why ----
wrong() {
  printf '%b' "import locale\nprint('a line of its own')\nlocale.setlocale(locale.LC_ALL, 'C.UTF-8')\n${solver/step): pass/step): $2}" >wrong.py
  head -n 1 specs.txt | sed 's/scipy_fast_projection/a/' | bench --plugin ./wrong.py point >point.json 2>err.txt || fail "$2: $(cat err.txt)"
  /usr/bin/python3 - "$1" <<'PYTHON' || fail "$2: $(head -c 300 point.json)"
import json
import sys
point = json.load(open("point.json"))
assert point["status"] == "not_converged" and sys.argv[1] in point["status_detail"], (sys.argv, point["status_detail"])
PYTHON
  grep -q 'a line of its own' err.txt || fail "what it prints is lost"
}
wrong 'wrong.py, line 7: ValueError: could not broadcast' 'step.x[:] = [1, 2]'
wrong 'step.x or step.v was replaced' 'step.x = step.x + 1'
wrong "has no attribute 'iteration'" 'step.iteration = 1'
wrong 'a counter of the step is not a whole number' 'step.iterations = 1.5'
wrong 'neither None nor a text' 'return True'
wrong 'not today' 'return chr(10).join(("not", "today"))'
wrong 'SystemExit: 3' 'raise SystemExit(3)'
wrong 'read-only' 'step.x_start[0] = 0'

finish
