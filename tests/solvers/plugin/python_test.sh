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

# ---- The module, by the page's example; fast projection as in contestants/ moves a chain and a net as the built-in one does ----
sed -n '/^<!-- file: module.py -->$/,/^```$/p' "$SOURCE_FOLDER/solvers/README.md" | sed '1,2d;$d' >module.py
export PYTHONPATH=$BUILD_FOLDER:$examples PYTHONDONTWRITEBYTECODE=1
/usr/bin/python3 - <<'PYTHON' >module.txt 2>&1 || fail "the module: $(cat module.txt)"
import gc
import types
import numpy as np
from module import figures, inextensible, scene, solver, x
from fast_projection import FastProjection

assert not any(getattr(scene, name).flags.writeable for name in ("x", "v", "gravity", "mass", "inverse_mass", "edges"))
edges, d = scene.edges, np.diff(solver.x[scene.edges], axis=1)[:, 0]
strain = abs(np.linalg.norm(d, axis=1) / scene.rest_length - 1).max()
assert 0 < strain <= 0.01 and np.isclose(strain, figures["strain"], atol=1e-14) and abs(solver.time - 0.5) < 1e-12, (strain, figures)
assert np.isclose(figures["kinetic_energy"], 0.5 * (scene.mass @ (solver.v**2).sum(axis=1)), rtol=1e-12), figures
assert 0 < scene.judge(x)["strain"] <= 0.01 < scene.judge(1.05 * scene.x)["strain"]
del scene, solver
gc.collect()
assert edges.max() == 120  # the array keeps what it is a view of

for name, n in (("chain", 20), ("spinning_net", 9)):
    scene = inextensible.Scene(name, n=n, **({} if name == "chain" else {"shear": 0}))
    solver, theirs, h = inextensible.Solver(scene, "fast_projection", linear_solver="multifrontal"), FastProjection(scene, 200), 0.002
    solver.step(h)
    x, v = solver.x.copy(), solver.v.copy()
    step = types.SimpleNamespace(iterations=0, assemblies=0, factorizations=0, back_solves=0)
    for _ in range(299):
        solver.step(h)
        step.x = x + h * (v + h * scene.gravity) * (scene.inverse_mass > 0)[:, None]
        assert theirs.filter(step) is None
        x, v = step.x, (step.x - x) / h
    assert abs(x - solver.x).max() < 1e-9 and abs(x - scene.x).max() > 0.1 and step.iterations > 50, (name, abs(x - solver.x).max(), step.iterations)

def refused(error, *words, **settings):
    try:
        words[0](*words[1:], **settings)
    except error:
        return
    raise AssertionError((words, settings))
refused(ValueError, inextensible.Scene, "chan")
refused(ValueError, inextensible.Scene, "chain", m=3)
refused(ValueError, inextensible.Scene, "chain", n="long")
refused(ValueError, inextensible.Solver, scene, "fast_projection", most=3)
refused(ValueError, solver.step, -1)
refused(ValueError, solver.project, x[1:], x, h)
refused(RuntimeError, solver.project, x, np.nan * x, h)
PYTHON

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
bad 'no method filter(self, step)' "${solver/filter/filtre}"
printf '%b' "$solver" >math.py
refused "there is a module 'math' already" --plugin ./math.py list solvers

# ---- What a step does wrong: its own run is refused and says why ----
wrong() {
  printf '%b' "import locale\nprint('a line of its own')\nlocale.setlocale(locale.LC_ALL, 'C.UTF-8')\n${solver/step): pass/step): $2}" >wrong.py
  holds 'print(json.dumps(read("sweep.json")["points"][0] | {"solver": "a", "contestant": "a"}))' >point.txt
  bench --plugin ./wrong.py point <point.txt >point.json 2>err.txt || fail "$2: $(cat err.txt)"
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
