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
WIDTH, HEIGHT = 260, 120  # pixels


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
    np.repeat([0, min(255, round(60 * abs(stretched - 1) / 0.01))], 3 * count).astype("u1").tofile(folder / "film.u8")
    tetrahedron = [[0, -1, 0], [1, -1.2, 0], [0, -1.2, 1], [0, -2, 0]]
    header = {"schema": "inextensible-film/1", "scene": "falling", "scene_parameters": {}, "frames_per_second": 10,
              "vertices": count, "triangles": triangles, "edges": edges, "strain_unit": 1 / 60,
              "body": tetrahedron if body else [], "body_triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] if body else [],
              "body_poses": [[0, 0, 1, frame, 0, 1, 0, 0, -1, 0, 0, 0] for frame in range(3)] if moves else [],
              "takes": [{"solver": name, "label": name, "strain_limit": 0.01, "step": 0.01, "energy_gained": "", "detail": "", "frames": 3,
                         "largest_strain": [0.0] * 3, "seconds": [0.01] * 2} for name in ("one", "other")]}
    (folder / "film.json").write_text(json.dumps(header))
    return folder


def pictured(folder: Path, frames: list[int], ends: int = 3) -> Path:
    """The same with pictures: of take 0 blue, of take 1 orange, which ends after so many frames."""
    recorded(folder)
    header = json.loads((folder / "film.json").read_text())
    header["takes"][1].update(frames=ends, detail="gave up at t = 0.06 s: iteration limit" if ends < 3 else "")
    for take in header["takes"]:
        take["sag"] = {"lower_edge": [0.0, 0.011, 0.022]}
    (folder / "film.json").write_text(json.dumps(header))
    (folder / "pictures.json").write_text(json.dumps({"width": WIDTH, "height": HEIGHT, "frames": frames, "legend_end": 4,
                                                      "legend": [[200, 190, 180], [200, 30, 20]]}))
    for take, rgb in enumerate(((40, 80, 200), (240, 140, 30))):
        for frame in range(3 if take == 0 else ends):
            Image.new("RGB", (WIDTH, HEIGHT), rgb).save(folder / f"{take}-{frame}.ppm")
    return folder


def run(folder: Path, out: Path) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, str(SCRIPT), str(folder), "--out", str(out)], capture_output=True, text=True, check=False)


def pixels(picture: Image.Image) -> np.ndarray:
    return np.asarray(picture.convert("RGB"), dtype=int)


def colourful(part: np.ndarray) -> float:
    """The part of pixels that are not grey."""
    return float(np.mean(part.max(axis=2) - part.min(axis=2) > 60))


def test_stills_have_a_row_for_each_take(tmp_path: Path) -> None:
    out = tmp_path / "stills.png"
    done = run(pictured(tmp_path, [0, 2]), out)
    assert done.returncode == 0, done.stderr
    with Image.open(out) as picture:
        shown = pixels(picture)
    assert shown.shape[1] == 2 * WIDTH
    assert np.array_equal(shown[HEIGHT // 2, [WIDTH // 2, WIDTH * 3 // 2]], [[40, 80, 200]] * 2)
    assert any(np.array_equal(row[WIDTH // 2], [240, 140, 30]) for row in shown[HEIGHT:])


def test_takes_lie_side_by_side_at_one_time(tmp_path: Path) -> None:
    out = tmp_path / "stills.png"
    assert run(pictured(tmp_path, [2]), out).returncode == 0
    with Image.open(out) as picture:
        assert np.array_equal(pixels(picture)[HEIGHT // 2, [WIDTH // 2, WIDTH * 3 // 2]], [[40, 80, 200], [240, 140, 30]])


def test_a_film_has_all_frames(tmp_path: Path) -> None:
    out = tmp_path / "film.webp"
    done = run(pictured(tmp_path, [0, 1, 2]), out)
    assert done.returncode == 0, done.stderr
    with Image.open(out) as picture:
        assert picture.n_frames == 3
        assert picture.size[0] == 2 * WIDTH


@pytest.mark.skipif(not shutil.which("ffmpeg"), reason="ffmpeg is not installed")
def test_a_film_for_players(tmp_path: Path) -> None:
    out = tmp_path / "film.mp4"
    done = run(pictured(tmp_path, [0, 1, 2]), out)
    assert done.returncode == 0 and out.stat().st_size > 0, done.stderr


def test_a_run_that_gave_up_is_grey_and_says_so(tmp_path: Path) -> None:
    made = film.load(pictured(tmp_path, [0, 1, 2], ends=1))
    runs, ended = (pixels(film.panel(made, take, 2))[:HEIGHT] for take in (0, 1))
    assert colourful(runs) > 0.9 and colourful(ended) < 0.1
    before = pixels(film.panel(made, 1, 0))[:HEIGHT]
    assert colourful(before) > 0.9, "it is not grey before"
    word = ended[HEIGHT // 2:]
    assert np.any((word[:, :, 0] > 100) & (word[:, :, 1] < 80)), "the word is on the picture"


def test_captions_name_the_step_and_how_the_run_went(tmp_path: Path) -> None:
    made = film.load(pictured(tmp_path, [0, 1, 2], ends=1))
    made.takes[0]["step"] = 1 / 240
    assert film.caption(made, 0, 2)[1] == "steps of 1/240 s: ok"
    assert film.caption(made, 1, 2)[1] == "steps of 1/100 s: gave up"
    made.takes[0]["largest_strain"] = [0.0, 0.011, 0.0]
    assert film.caption(made, 0, 2)[1] == "steps of 1/240 s: strained more than permitted"
    made.takes[0]["energy_gained"] = "energy 4 of weight times size"
    assert film.caption(made, 0, 2)[1] == "steps of 1/240 s: gains energy"


def test_a_run_that_gains_energy_is_marked_in_every_picture(tmp_path: Path) -> None:
    made = film.load(pictured(tmp_path, [0, 1, 2]))
    plain = pixels(film.panel(made, 0, 0))
    made.takes[0]["energy_gained"] = "energy 4 of weight times size"
    for frame in range(3):
        marked = pixels(film.panel(made, 0, frame))
        assert np.array_equal(marked[HEIGHT // 4, WIDTH // 2], plain[HEIGHT // 4, WIDTH // 2]), "the picture stays"
        for row, column in ((0, WIDTH // 2), (HEIGHT - 1, WIDTH // 2), (HEIGHT // 2, 0), (HEIGHT // 2, WIDTH - 1)):
            red, green, blue = marked[row, column]
            assert red > 2 * green and red > 2 * blue, "a red frame"


def test_captions_tell_strain_so_far_time_and_sag(tmp_path: Path) -> None:
    made = film.load(pictured(tmp_path, [0, 1, 2]))
    made.takes[0]["largest_strain"] = [0.0, 0.0099, 0.005]
    made.takes[0]["seconds"] = [0.01, 0.03]
    assert film.caption(made, 0, 0)[2] == "strain limit 1 %, largest so far below 0.001 %"
    lines = film.caption(made, 0, 2)
    assert lines[0] == "one"
    assert lines[2] == "strain limit 1 %, largest so far 0.99 %"
    assert lines[3] == "6.67 ms for a frame of 1/30 s"  # 20 ms for a tenth of a second
    assert lines[4] == "sag: lower edge 22.0 mm"


def test_lengths_are_in_units_that_fit() -> None:
    assert [film.length(metres) for metres in (0.0123, -0.0447, 0.25, 12.9)] == ["12.3 mm", "-44.7 mm", "250.0 mm", "12.90 m"]


def test_words_are_wrapped_and_none_is_lost() -> None:
    font = film.ImageFont.load_default()
    text = "gave up at t = 0.06 s: iteration limit"
    lines = film.wrapped(text, font, 80)
    assert " ".join(lines) == text and len(lines) > 1 and all(font.getlength(line) <= 80 for line in lines)


def test_what_is_missing_is_said_in_a_line(tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, str(SCRIPT), str(pictured(tmp_path, [0])), "--out", str(tmp_path / "x.mp4")], capture_output=True,
                          text=True, check=False, env={"PATH": "/nowhere"})
    assert done.returncode == 2
    assert done.stderr.startswith("film.py: ffmpeg missing") and done.stderr.count("\n") == 1


def test_a_folder_without_pictures_is_one_line(tmp_path: Path) -> None:
    done = run(recorded(tmp_path), tmp_path / "x.png")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and not (tmp_path / "x.png").exists()
