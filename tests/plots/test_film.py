"""Pictures of `bench film`: what is drawn is what was recorded."""

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

WIDTH, HEIGHT = 260, 120  # pixels


def recorded(folder: Path, body: bool = False) -> Path:
    """Two takes of three frames: a square of four vertices that falls, and one that stays."""
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]], dtype="<f4")
    falling = [flat - np.float32([0, 0.1 * frame, 0]) for frame in range(3)]
    np.stack([*falling, *[flat] * 3]).tofile(folder / "film.f32")
    np.zeros(6 * len(flat), dtype="u1").tofile(folder / "film.u8")
    header = {"schema": "inextensible-film/1", "scene": "falling", "scene_parameters": {}, "frames_per_second": 10,
              "vertices": 4, "triangles": [[0, 1, 2], [3, 1, 2]], "edges": [[0, 1], [2, 3], [0, 2], [1, 3]], "strain_unit": 1 / 60,
              "body": [[0, -1, 0], [1, -1.2, 0], [0, -1.2, 1], [0, -2, 0]] if body else [],
              "body_triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] if body else [], "body_poses": [],
              "takes": [{"solver": name, "label": name, "strain_limit": 0.01, "step": 0.01, "energy_gained": "", "detail": "", "frames": 3,
                         "largest_strain": [0.0] * 3, "seconds": [0.01] * 2, "sag": {"lower_edge": [0.0, 0.011, 0.022]}}
                        for name in ("one", "other")]}
    (folder / "film.json").write_text(json.dumps(header))
    return folder


def pictured(folder: Path, frames: list[int], ends: int = 3) -> Path:
    """The same with pictures: of take 0 blue, of take 1 orange, which ends after so many frames."""
    header = json.loads((recorded(folder) / "film.json").read_text())
    header["takes"][1].update(frames=ends, detail="gave up at t = 0.06 s: iteration limit" if ends < 3 else "")
    (folder / "film.json").write_text(json.dumps(header))
    (folder / "pictures.json").write_text(json.dumps({"width": WIDTH, "height": HEIGHT, "frames": frames, "legend_end": 4,
                                                      "legend": [[200, 190, 180], [200, 30, 20]]}))
    for take, rgb in enumerate(((40, 80, 200), (240, 140, 30))):
        for frame in range(3 if take == 0 else ends):
            Image.new("RGB", (WIDTH, HEIGHT), rgb).save(folder / f"{take}-{frame}.ppm")
    return folder


def run(folder: Path, out: Path, **more: object) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, ROOT / "plots/film.py", folder, "--out", out], capture_output=True, text=True, check=False, **more)


def pixels(picture: Image.Image) -> np.ndarray:
    return np.asarray(picture.convert("RGB"), dtype=int)


def colourful(part: np.ndarray) -> float:
    """The part of pixels that are not grey."""
    return float(np.mean(part.max(axis=2) - part.min(axis=2) > 60))


@pytest.mark.parametrize("frames, columns, below", [([0, 2], [[40, 80, 200]] * 2, True), ([2], [[40, 80, 200], [240, 140, 30]], False)])
def test_stills_have_a_row_for_each_take_and_one_time_has_takes_side_by_side(frames: list[int], columns: list, below: bool, tmp_path: Path) -> None:
    out = tmp_path / "stills.png"
    done = run(pictured(tmp_path, frames), out)
    assert done.returncode == 0, done.stderr
    with Image.open(out) as picture:
        shown = pixels(picture)
    assert shown.shape[1] == 2 * WIDTH
    assert np.array_equal(shown[HEIGHT // 2, [WIDTH // 2, WIDTH * 3 // 2]], columns)
    assert any(np.array_equal(row[WIDTH // 2], [240, 140, 30]) for row in shown[HEIGHT:]) == below


def test_a_film_has_all_frames(tmp_path: Path) -> None:
    out = tmp_path / "film.webp"
    assert run(pictured(tmp_path, [0, 1, 2]), out).returncode == 0
    with Image.open(out) as picture:
        assert (picture.n_frames, picture.size[0]) == (3, 2 * WIDTH)
    if shutil.which("ffmpeg"):
        out = tmp_path / "film.mp4"
        assert run(tmp_path, out).returncode == 0 and out.stat().st_size > 0


def test_a_run_that_gave_up_is_grey_and_says_so(tmp_path: Path) -> None:
    made = film.Film(pictured(tmp_path, [0, 1, 2], ends=1))
    runs, ended, before = (pixels(film.panel(made, take, frame))[:HEIGHT] for take, frame in ((0, 2), (1, 2), (1, 0)))
    assert colourful(runs) > 0.9 and colourful(ended) < 0.1 and colourful(before) > 0.9
    word = ended[HEIGHT // 2:]
    assert np.any((word[:, :, 0] > 100) & (word[:, :, 1] < 80)), "the word is on the picture"


def test_a_run_that_gains_energy_is_framed_in_every_picture(tmp_path: Path) -> None:
    made = film.Film(pictured(tmp_path, [0, 1, 2]))
    plain = pixels(film.panel(made, 0, 0))
    made.takes[0]["energy_gained"] = "energy 4 of weight times size"
    for frame in range(3):
        marked = pixels(film.panel(made, 0, frame))
        assert np.array_equal(marked[HEIGHT // 4, WIDTH // 2], plain[HEIGHT // 4, WIDTH // 2]), "the picture stays"
        red, green, blue = marked[[0, HEIGHT - 1, HEIGHT // 2, HEIGHT // 2], [WIDTH // 2, WIDTH // 2, 0, WIDTH - 1]].T
        assert np.all(red > 2 * np.maximum(green, blue)), "a red frame"


@pytest.mark.parametrize("changes, frame, status, strain", [
    ({"largest_strain": [0.0, 0.011, 0.0]}, 2, "strained more than permitted", "1.1 %"),
    ({"largest_strain": [0.0, 0.0099, 0.005]}, 0, "ok", "below 0.001 %"), ({"largest_strain": [0.0, 0.0099, 0.005]}, 2, "ok", "0.99 %"),
    ({"energy_gained": "energy 4"}, 2, "gains energy", "below 0.001 %"), ({"detail": "gave up at 1 s"}, 2, "gave up", "below 0.001 %")])
def test_captions_tell_step_status_strain_so_far_time_and_sag(changes: dict, frame: int, status: str, strain: str, tmp_path: Path) -> None:
    made = film.Film(pictured(tmp_path, [0, 1, 2]))
    made.takes[0].update(step=1 / 240, seconds=[0.01, 0.03], **changes)
    assert film.caption(made, 0, frame) == ["one", f"steps of 1/240 s: {status}", f"strain limit 1 %, largest so far {strain}",
                                            "6.67 ms for a frame of 1/30 s", f"sag: lower edge {11.0 * frame:.1f} mm"]


@pytest.mark.parametrize("make, name, env, message", [(pictured, "x.mp4", {"PATH": "/nowhere"}, "film.py: ffmpeg missing"),
                                                      (lambda folder, _: recorded(folder), "x.png", None, "film.py: ")])
def test_what_is_missing_is_said_in_a_line(make, name: str, env: dict | None, message: str, tmp_path: Path) -> None:
    done = run(make(tmp_path, [0]), tmp_path / name, env=env)
    assert done.returncode == 2 and done.stderr.startswith(message) and done.stderr.count("\n") == 1 and not (tmp_path / name).exists()
