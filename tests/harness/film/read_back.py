"""Reads what film_test.sh has exported, each format by its published layout, and holds one against the other."""

import struct
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np

FRAMES = 4  # a tenth of a second at 30 frames a second


def obj(path: Path) -> tuple[np.ndarray, list[list[int]], list[list[int]]]:
    """Points; faces and lines, counted from 0."""
    lines = [line.split() for line in path.read_text().splitlines()]
    points = np.array([[float(word) for word in words[1:]] for words in lines if words[0] == "v"])
    faces, segments = ([[int(word) - 1 for word in words[1:]] for words in lines if words[0] == kind] for kind in ("f", "l"))
    assert {words[0] for words in lines} <= {"v", "f", "l"}
    return points, faces, segments


def vtp(path: Path) -> tuple[np.ndarray, list[list[int]], list[list[int]], np.ndarray]:
    """Points, polygons, lines, and the strain of each cell."""
    piece = xml.parse(path).getroot().find("PolyData/Piece")
    assert piece is not None

    def numbers(where: str) -> np.ndarray:
        return np.array((piece.find(where).text or "").split(), dtype=float)

    def cells(kind: str) -> list[list[int]]:
        connectivity, offsets = (numbers(f"{kind}/DataArray[@Name='{name}']").astype(int) for name in ("connectivity", "offsets"))
        assert len(offsets) == int(piece.get(f"NumberOf{kind}"))
        return [part.tolist() for part in np.split(connectivity, offsets)[:-1]]

    points = numbers("Points/DataArray").reshape(-1, 3)
    assert len(points) == int(piece.get("NumberOfPoints"))
    return points, cells("Polys"), cells("Lines"), numbers("CellData/DataArray[@Name='strain']")


def pc2(path: Path) -> np.ndarray:
    """Frames x points x 3."""
    data = path.read_bytes()
    signature, version, points, start, rate, frames = struct.unpack("<12siiffi", data[:32])
    assert (signature, version, start, rate) == (b"POINTCACHE2\0", 1, 0, 1)
    return np.frombuffer(data[32:], dtype="<f4").reshape(frames, points, 3)


def close(a: np.ndarray, b: np.ndarray) -> bool:
    return a.shape == b.shape and bool(np.allclose(a, b, atol=2e-7, rtol=2e-7))


def shown(folder: Path) -> list[tuple[float, int, str]]:
    """Entries of the collection for ParaView: time, part and file."""
    return [(float(item.get("timestep")), int(item.get("part")), item.get("file"))
            for item in xml.parse(folder / "it.pvd").getroot().iter("DataSet")]


def check_cloth(folder: Path) -> None:
    cache = pc2(folder / "it.pc2")
    assert len(cache) == FRAMES
    _, faces, segments = obj(folder / "it.obj")
    assert faces or segments
    for frame in range(FRAMES):
        points, *cells = obj(folder / f"it-{frame + 1:04d}.obj")
        assert cells == [faces, segments]
        assert close(points, cache[frame])
        again, polygons, lines, strain = vtp(folder / f"it-{frame + 1:04d}.vtp")
        assert close(points, again)
        assert polygons == faces
        assert not segments or segments == lines
        assert len(strain) == len(polygons) + len(lines)
        assert strain.min() >= 0 and strain.max() <= 0.02 * (1 + 1e-9)
        assert (folder / f"it-{frame + 1:04d}.vtp").name in [file for time, part, file in shown(folder)
                                                            if part == 0 and abs(time - frame / 30) < 1e-4]


def check_body(folder: Path, moves: bool) -> None:
    first, faces, _ = obj(folder / ("it-body-0001.obj" if moves else "it-body.obj"))
    assert sum(part == 1 for _, part, _ in shown(folder)) == FRAMES
    if not moves:
        assert close(vtp(folder / "it-body.vtp")[0], first)
        return
    cache = pc2(folder / "it-body.pc2")
    for frame in range(FRAMES):
        points, again, _ = obj(folder / f"it-body-{frame + 1:04d}.obj")
        assert again == faces
        assert close(points, cache[frame]) and close(points, vtp(folder / f"it-body-{frame + 1:04d}.vtp")[0])
        # It moves as a rigid body: distances stay.
        assert np.allclose(np.linalg.norm(points - points[7], axis=1), np.linalg.norm(first - first[7], axis=1), atol=1e-6)
    assert np.abs(cache[-1] - cache[0]).max() > 1e-3


for name in ("garment", "drape", "chain"):
    check_cloth(Path(name))
check_body(Path("garment"), moves=True)
check_body(Path("drape"), moves=False)
assert not list(Path("chain").glob("*body*"))
