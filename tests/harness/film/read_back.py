"""Reads what film_test.sh has exported, each format by its published layout, and holds one against the other."""

import struct
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np

FRAMES = 4  # a tenth of a second at 30 frames a second


def obj(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points; faces and lines, counted from 0."""
    lines = [line.split() for line in path.read_text().splitlines()]
    assert {words[0] for words in lines} <= {"v", "f", "l"}
    points, faces, segments = (np.array([words[1:] for words in lines if words[0] == kind], dtype=float) for kind in "vfl")
    return points, faces - 1, segments - 1


def vtp(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points, triangles, lines, and the strain of each cell."""
    piece = xml.parse(path).getroot().find("PolyData/Piece")
    assert piece is not None

    def numbers(where: str, columns: int = 1) -> np.ndarray:
        return np.array((piece.find(where).text or "").split(), dtype=float).reshape(-1, columns)

    def cells(kind: str, corners: int) -> np.ndarray:
        offsets = numbers(f"{kind}/DataArray[@Name='offsets']")[:, 0]
        assert np.array_equal(offsets, corners * np.arange(1, int(piece.get(f"NumberOf{kind}")) + 1))
        return numbers(f"{kind}/DataArray[@Name='connectivity']", corners)

    points = numbers("Points/DataArray", 3)
    assert len(points) == int(piece.get("NumberOfPoints"))
    return points, cells("Polys", 3), cells("Lines", 2), numbers("CellData/DataArray[@Name='strain']")


def pc2(path: Path) -> np.ndarray:
    """Frames x points x 3."""
    data = path.read_bytes()
    signature, version, points, start, rate, frames = struct.unpack("<12siiffi", data[:32])
    assert (signature, version, start, rate) == (b"POINTCACHE2\0", 1, 0, 1)
    return np.frombuffer(data[32:], dtype="<f4").reshape(frames, points, 3)


def close(a: np.ndarray, b: np.ndarray) -> bool:
    return a.shape == b.shape and bool(np.allclose(a, b, atol=2e-7, rtol=2e-7))


def check(folder: Path, part: int, name: str, moves: bool = True) -> np.ndarray:
    """All formats hold the same points and cells in every frame; of a part that stays there is one. The points of a part that moves."""
    shown = [(item.get("file"), float(item.get("timestep"))) for item in xml.parse(folder / "it.pvd").getroot().iter("DataSet")
             if int(item.get("part")) == part]
    numbers = [f"-{frame + 1:04d}" if moves else "" for frame in range(FRAMES)]
    assert [file for file, _ in shown] == [f"{name}{number}.vtp" for number in numbers]
    assert np.allclose([time for _, time in shown], np.arange(FRAMES) / 30, atol=1e-4)
    _, faces, segments = obj(folder / f"{name}.obj")
    cache = pc2(folder / f"{name}.pc2") if moves else [obj(folder / f"{name}.obj")[0]] * FRAMES
    for number, cached in zip(numbers, cache, strict=True):
        points, *cells = obj(folder / f"{name}{number}.obj")
        again, polygons, lines, strain = vtp(folder / f"{name}{number}.vtp")
        assert close(points, cached) and close(points, again)
        assert len(faces) + len(segments) > 0 and all(map(np.array_equal, cells, (faces, segments)))
        assert np.array_equal(polygons, faces.reshape(-1, 3)) and (not len(segments) or np.array_equal(lines, segments))
        assert len(strain) == len(polygons) + len(lines) and 0 <= strain.min() and strain.max() <= 0.02 * (1 + 1e-9)
    return cache


for scene in ("garment", "drape", "chain"):
    check(Path(scene), 0, "it")
body = check(Path("garment"), 1, "it-body")
apart = np.linalg.norm(body - body[:, 7:8], axis=2)
assert np.allclose(apart, apart[0], atol=1e-6), "it moves as a rigid body: distances stay"
assert np.abs(body[-1] - body[0]).max() > 1e-3
check(Path("drape"), 1, "it-body", moves=False)
assert not list(Path("chain").glob("*body*"))
