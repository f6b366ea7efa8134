"""Pictures of `bench film`: what is drawn is what was recorded."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import film
from documents import ROOT

WIDTH, HEIGHT = 260, 120  # pixels


def pictured(folder: Path, frames: list[int], ends: int = 3) -> Path:
    """Two takes of three frames with pictures, take 0 blue, take 1 orange, which ends after the given number of frames."""
    take = {"label": "one", "strain_limit": 0.01, "step": 1 / 240, "energy_gained": "", "detail": "", "frames": 3,
            "largest_strain": [0.0, 0.0099, 0.005], "seconds": [0.01, 0.03], "sag": {"lower_edge": [0.0, 0.011, 0.022]}}
    other = {**take, "label": "other", "frames": ends, "detail": "gave up at t = 0.06 s: iteration limit" if ends < 3 else ""}
    (folder / "film.json").write_text(json.dumps({"frames_per_second": 10, "takes": [take, other], "width": WIDTH, "height": HEIGHT,
                                                  "frames": frames, "legend_end": 4, "legend": [[200, 190, 180], [200, 30, 20]]}))
    for take, rgb in enumerate(((40, 80, 200), (240, 140, 30))):
        for frame in range(3 if take == 0 else ends):
            Image.new("RGB", (WIDTH, HEIGHT), rgb).save(folder / f"{take}-{frame}.png")
    return folder


def run(folder: Path, out: Path) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, ROOT / "plots/film.py", folder, "--out", out], capture_output=True, text=True, check=False)


def pixels(picture: Image.Image) -> np.ndarray:
    return np.asarray(picture.convert("RGB"), dtype=int)


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


def test_a_run_that_gave_up_has_pictures_to_the_end_of_the_film(tmp_path: Path) -> None:
    made = film.Film(pictured(tmp_path, [0, 1, 2], ends=1))
    assert not np.array_equal(pixels(film.panel(made, 1, 2)), pixels(film.panel(made, 1, 0)))
    assert "gave up" in film.caption(made, 1, 2)[1]
    assert film.caption(made, 0, 2)[2] == "strain limit 1 %, largest so far 0.99 %"


def test_what_is_missing_is_said_in_a_line(tmp_path: Path) -> None:
    pictured(tmp_path, [0])
    (tmp_path / "film.json").unlink()
    done = run(tmp_path, tmp_path / "x.png")
    assert done.returncode == 2 and done.stderr.startswith("film.py: ") and done.stderr.count("\n") == 1 and not (tmp_path / "x.png").exists()
