"""Reads what film_test.sh has exported, each format by its published layout, and holds one against the other."""

import struct
from pathlib import Path

import numpy as np

FRAMES = 4  # a tenth of a second at 30 frames a second


def obj(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points; faces and lines, counted from 0."""
    lines = [line.split() for line in path.read_text().splitlines()]
    assert {words[0] for words in lines} <= {"v", "f", "l"}
    points, faces, segments = (np.array([words[1:] for words in lines if words[0] == kind], dtype=float) for kind in "vfl")
    return points, faces - 1, segments - 1


def pc2(path: Path) -> np.ndarray:
    """Frames x points x 3."""
    data = path.read_bytes()
    signature, version, points, start, rate, frames = struct.unpack("<12siiffi", data[:32])
    assert (signature, version, start, rate) == (b"POINTCACHE2\0", 1, 0, 1)
    return np.frombuffer(data[32:], dtype="<f4").reshape(frames, points, 3)


def check(folder: Path, name: str) -> np.ndarray:
    """Both formats hold the same points and cells in every frame. The points of a part that moves."""
    _, *cells = obj(folder / f"{name}.obj")
    cache = pc2(folder / f"{name}.pc2")
    for frame, cached in enumerate(cache, start=1):
        points, *same_cells = obj(folder / f"{name}-{frame:04d}.obj")
        assert points.shape == cached.shape and np.allclose(points, cached, atol=2e-7, rtol=2e-7)
        assert sum(map(len, cells)) > 0 and all(map(np.array_equal, cells, same_cells))
    assert len(cache) == FRAMES and not (folder / f"{name}-{FRAMES + 1:04d}.obj").exists()
    return cache


for scene in ("garment", "drape", "chain"):
    check(Path(scene), "it")
body = check(Path("garment"), "it-body")
apart = np.linalg.norm(body - body[:, 7:8], axis=2)
assert np.allclose(apart, apart[0], atol=1e-6), "it moves as a rigid body: distances stay"
assert np.abs(body[-1] - body[0]).max() > 1e-3
assert [path.name for path in Path("drape").glob("*body*")] == ["it-body.obj"], "one frame of a body that stays"
assert not list(Path("chain").glob("*body*"))
