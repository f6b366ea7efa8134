"""Pictures of `bench film`: what is drawn is what was recorded."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import film
from documents import ROOT

SCRIPT = ROOT / "plots" / "film.py"
needs_povray = pytest.mark.skipif(not shutil.which("povray"), reason="povray is not installed")


def recorded(folder: Path, stretched: float = 1.0, chain: bool = False, body: bool = False, moves: bool = False) -> Path:
    """Two takes of three frames: a square of 4 x 4 vertices, or a chain, that falls; the second is stretched."""
    n = 4
    count = n if chain else n * n
    flat = np.array([[i % n / (n - 1), 0, i // n / (n - 1)] for i in range(count)], dtype="<f4")
    edges = [[i, i + 1] for i in range(count - 1) if (i + 1) % n] + ([] if chain else [[i, i + n] for i in range(count - n)])
    triangles = [] if chain else [t for i in range(n - 1) for j in range(n - 1) for a in [i * n + j]
                                  for t in ([a, a + 1, a + n], [a + n + 1, a + 1, a + n])]
    takes = [np.stack([flat - [0, 0.1 * frame, 0] for frame in range(3)]), np.stack([flat * stretched] * 3)]
    np.concatenate(takes).astype("<f4").tofile(folder / "film.f32")
    tetrahedron = [[0, -1, 0], [1, -1.2, 0], [0, -1.2, 1], [0, -2, 0]]
    header = {"schema": "inextensible-film/1", "scene": "falling", "scene_parameters": {}, "step": 0.01, "frames_per_second": 10,
              "vertices": count, "triangles": triangles, "edges": edges, "rest_length": [1 / (n - 1)] * len(edges),
              "body": tetrahedron if body else [], "body_triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] if body else [],
              "body_poses": [[0, 0, 1, frame, 0, 1, 0, 0, -1, 0, 0, 0] for frame in range(3)] if moves else [],
              "takes": [{"solver": name, "label": name, "strain_limit": 0.01, "detail": "", "frames": 3,
                         "largest_strain": [0.0] * 3, "seconds": [0.01] * 2} for name in ("one", "other")]}
    (folder / "film.json").write_text(json.dumps(header))
    return folder


def run(*arguments: object) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, str(SCRIPT), *map(str, arguments)], capture_output=True, text=True, check=False)


def test_strain_is_that_of_the_edges(tmp_path: Path) -> None:
    made = film.load(recorded(tmp_path, stretched=1.04))
    assert np.allclose(made.strain(made.takes[0][2]), 0, atol=1e-6)
    assert np.allclose(made.strain(made.takes[1][0]), 0.04, atol=1e-6)


def test_colours_go_from_cloth_to_alarm() -> None:
    shades = film.colour(np.array([0.0, 1.0, 4.0, 100.0]))
    assert shades[3].tolist() == shades[2].tolist()
    assert shades[2][0] > 2 * shades[2][2]  # red
    assert shades[1][2] > shades[1][0]      # blue


def test_a_body_goes_where_its_pose_takes_it(tmp_path: Path) -> None:
    made = film.load(recorded(tmp_path, body=True, moves=True))
    assert np.allclose(film.body_at(made.header, 2)[1], [2, -1.2, -1])  # a quarter turn about y, then 2 along x
    (tmp_path / "still").mkdir()
    still = film.load(recorded(tmp_path / "still", body=True))
    assert np.allclose(film.body_at(still.header, 2)[1], [1, -1.2, 0])


def test_normals_of_a_flat_square_are_upright() -> None:
    x = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]], dtype=float)
    assert np.allclose(np.abs(film.normals(x, np.array([[0, 1, 2], [3, 2, 1]]))), [0, 1, 0])


@needs_povray
@pytest.mark.parametrize("chain", [False, True])
def test_stills_show_each_solver_and_strain_as_colour(tmp_path: Path, chain: bool) -> None:
    out = tmp_path / "stills.png"
    done = run(recorded(tmp_path, stretched=1.04, chain=chain, body=True), out, "--width", 120, "--stills", "0,0.2")
    assert done.returncode == 0, done.stderr
    with Image.open(out) as picture:
        pixels = np.asarray(picture.convert("RGB"), dtype=int)
    assert pixels.shape[1] == 240
    row = (pixels.shape[0] - 3 * film.LINE - film.MARGIN) // 2  # legend and time lie below

    def red(part: np.ndarray) -> int:
        return int(np.sum((part[:, :, 0] > 1.6 * part[:, :, 2]) & (part[:, :, 0] > 60)))

    assert red(pixels[:row]) == 0, "an unstrained cloth is not red"
    assert red(pixels[row:2 * row]) > 20, "one strained four times its limit is"


@needs_povray
def test_a_film_has_all_frames(tmp_path: Path) -> None:
    out = tmp_path / "film.webp"
    done = run(recorded(tmp_path), out, "--width", 48)
    assert done.returncode == 0, done.stderr
    with Image.open(out) as picture:
        assert picture.n_frames == 3
        assert picture.size[0] == 96


def test_what_is_missing_is_said_in_a_line(tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, str(SCRIPT), str(recorded(tmp_path)), str(tmp_path / "x.png")], capture_output=True, text=True,
                          check=False, env={"PATH": "/nowhere"})
    assert done.returncode == 2
    assert done.stderr.startswith("film.py: povray missing") and done.stderr.count("\n") == 1
