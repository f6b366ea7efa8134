#!/usr/bin/env python3
"""An engine as a program of its own, in plain Python: symplectic Euler, then passes over all edges (Müller et al. 2007).

bench --plugin 'cmd:contestants/process/my_engine.py' --sweep strain --scene chain (docs/plugins.md has the protocol)"""

import json
import math
import sys
import time
from array import array


def say(line):
    print(json.dumps(line), flush=True)


def step(scene, inverse_mass, passes, h, x, v):
    start = x[:]
    for i in range(len(x)):
        if inverse_mass[i // 3] > 0:
            x[i] += h * (v[i] + h * scene["gravity"][i % 3])
    for _ in range(passes):
        for (a, b), rest in zip(scene["edge"], scene["rest_length"]):
            d = [x[3 * b + c] - x[3 * a + c] for c in range(3)]
            share = (1 - rest / math.hypot(*d)) / (inverse_mass[a] + inverse_mass[b])
            for c in range(3):
                x[3 * a + c] += inverse_mass[a] * share * d[c]
                x[3 * b + c] -= inverse_mass[b] * share * d[c]
    return x, array("d", ((now - before) / h for now, before in zip(x, start)))


say({"inextensible": 1, "name": "my_engine", "version": "1.0", "summary": "passes over all edges, in plain Python", "takes": [],
     "settings": {"passes": [20, 1, 10000, "over all edges a step"]}})
task = json.loads(sys.stdin.buffer.readline() or "null")
if task:  # else bench has only asked what this is
    with open(task["scene"] + "/scene.json") as file:
        scene = json.load(file)
    inverse_mass = [0 if i in scene["pinned"] else 1 / m for i, m in enumerate(scene["mass"])]
    say({})
    size = 3 * len(inverse_mass)
    while frame := sys.stdin.buffer.read(8 * (2 + 2 * size)):
        begin = time.perf_counter()
        numbers = array("d", frame)
        x, v = step(scene, inverse_mass, int(task["settings"]["passes"]), numbers[0], numbers[2:2 + size], numbers[2 + size:])
        answer = array("d", [0, time.perf_counter() - begin]) + x + v
        sys.stdout.buffer.write(answer.tobytes())
        sys.stdout.buffer.flush()
