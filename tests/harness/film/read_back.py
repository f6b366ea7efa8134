"""Reads what film_test.sh has exported, by the format's published layout."""

from pathlib import Path

import numpy as np

FRAMES = 4  # a tenth of a second at 30 frames a second


def obj(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points; faces and lines, counted from 0."""
    lines = [line.split() for line in path.read_text().splitlines()]
    assert {words[0] for words in lines} <= {"v", "f", "l"}
    points, faces, segments = (np.array([words[1:] for words in lines if words[0] == kind], dtype=float) for kind in "vfl")
    return points, (faces - 1).astype(int), (segments - 1).astype(int)


def motion(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Frames x points x 3, and the cells, which all frames share."""
    frames = [obj(path) for path in sorted(Path().glob(f"{name}-[0-9]*.obj"))]
    assert len(frames) == FRAMES
    points, faces, lines = zip(*frames)
    for cells in faces, lines:
        assert all(np.array_equal(cell, cells[0]) for cell in cells)
    return np.array(points), max(faces[0], lines[0], key=len)


for scene, corners in ("garment", 3), ("drape", 3), ("chain", 2):
    x, cells = motion(f"{scene}/it")
    assert cells.shape[1] == corners and set(cells.flat) == set(range(x.shape[1]))
    assert np.abs(x[-1] - x[0]).max() > 1e-3
lengths = np.linalg.norm(x[:, cells[:, 0]] - x[:, cells[:, 1]], axis=2)
assert np.allclose(lengths, lengths[0], rtol=0.021), "a chain keeps its strain limit"
body, _ = motion("garment/it-body")
apart = np.linalg.norm(body - body[:, 7:8], axis=2)
assert np.allclose(apart, apart[0], atol=1e-6), "it moves as a rigid body: distances stay"
assert np.abs(body[-1] - body[0]).max() > 1e-3
assert [path.name for path in Path("drape").glob("*body*")] == ["it-body.obj"], "one frame of a body that stays"
assert not list(Path("chain").glob("*body*"))
