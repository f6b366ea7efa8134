#!/usr/bin/python3
"""Renders what `bench film` has recorded: stills or a film, solvers side by side in step, strain as colour.

    plots/film.py FOLDER OUT.webp|.mp4|.png [--width PIXELS] [--stills 0.1,0.5]

FOLDER holds film.json and film.f32 as harness/film/recording.h describes them. POV-Ray traces the pictures, Pillow and ffmpeg put
them together (Debian: povray, python3-pil, ffmpeg for .mp4 alone).
"""

from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable

sys.dont_write_bytecode = True

import numpy as np
from PIL import Image, ImageDraw, ImageFont

# Of strain over its limit: cloth's own colour up to the limit, warm beyond it. Four times the limit is as red as it gets.
STOPS = ((0.0, (0.80, 0.78, 0.72)), (0.5, (0.58, 0.70, 0.80)), (1.0, (0.25, 0.50, 0.75)), (1.5, (0.95, 0.70, 0.25)),
         (4.0, (0.80, 0.12, 0.10)))
BACKGROUND, BODY, THREAD = "<0.97,0.97,0.98>", "<0.72,0.70,0.74>", 0.0022  # thread: radius over what is seen
BODY_GAP = 0.02  # the same
MARGIN, LINE = 8, 18  # pixels
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
LONGEST_THREADS = 60  # above so many vertices a side every other thread is drawn, and so on


class FilmError(Exception):
    """One line for the user."""


@dataclass
class Film:
    header: dict[str, Any]
    takes: list[np.ndarray]  # frames x vertices x 3

    def __post_init__(self) -> None:
        self.edges = np.array(self.header["edges"], dtype=int).reshape(-1, 2)
        self.rest = np.array(self.header["rest_length"], dtype=float)
        self.triangles = np.array(self.header["triangles"], dtype=int).reshape(-1, 3)

    def strain(self, x: np.ndarray) -> np.ndarray:
        """Of each vertex the largest of its edges, in strain limits of the take that is drawn."""
        ends = x[self.edges]
        strain = np.abs(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / self.rest - 1)
        most = np.zeros(len(x))
        for side in (0, 1):
            np.maximum.at(most, self.edges[:, side], strain)
        return most


def load(folder: Path) -> Film:
    header = json.loads((folder / "film.json").read_text(encoding="utf-8"))
    data = np.fromfile(folder / "film.f32", dtype="<f4").astype(float).reshape(-1, header["vertices"], 3)
    takes, begin = [], 0
    for take in header["takes"]:
        takes.append(data[begin:begin + take["frames"]])
        begin += take["frames"]
    return Film(header, takes)


# ---- POV-Ray ----------------------------------------------------------------------------------------------------------

def vector(v: Iterable[float]) -> str:
    return "<" + ",".join(f"{number:.6g}" for number in v) + ">"


def normals(x: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    face = np.cross(x[triangles[:, 1]] - x[triangles[:, 0]], x[triangles[:, 2]] - x[triangles[:, 0]])
    sums = np.zeros_like(x)
    for corner in range(3):
        np.add.at(sums, triangles[:, corner], face)
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.where(length > 0, sums / np.where(length > 0, length, 1), [0.0, 1.0, 0.0])


def colour(over_limit: np.ndarray) -> np.ndarray:
    at = [stop for stop, _ in STOPS]
    return np.stack([np.interp(over_limit, at, [rgb[channel] for _, rgb in STOPS]) for channel in range(3)], axis=1)


def mesh(x: np.ndarray, triangles: np.ndarray, textures: str, indices: np.ndarray | None) -> str:
    """mesh2 with smooth normals; indices: each vertex's texture, none if all have the object's."""
    def rows(kind: str, values: list[str]) -> str:
        return f"{kind} {{ {len(values)}, {', '.join(values)} }}\n"
    text = "mesh2 {\n" + rows("vertex_vectors", [vector(v) for v in x]) + rows("normal_vectors", [vector(v) for v in normals(x, triangles)])
    faces = [vector(t) for t in triangles]
    if indices is None:
        return text + rows("face_indices", faces) + textures + "}\n"
    faces = [f"{face},{','.join(str(indices[v]) for v in t)}" for face, t in zip(faces, triangles)]
    return text + textures + rows("face_indices", faces) + "}\n"


def cloth(film: Film, x: np.ndarray, limit: float, size: float) -> str:
    strain = film.strain(x) / limit
    shades = 64
    indices = np.clip((strain / STOPS[-1][0] * (shades - 1)).round().astype(int), 0, shades - 1)
    finish = "finish { ambient 0.28 diffuse 0.72 specular 0.08 roughness 0.1 }"
    palette = colour(np.linspace(0, STOPS[-1][0], shades))
    textures = [f"texture {{ pigment {{ rgb {vector(rgb)} }} {finish} }}" for rgb in palette]
    text = ""
    if len(film.triangles):
        text += mesh(x, film.triangles, f"texture_list {{ {shades}, {' '.join(textures)} }}\n", indices)
        radius, dark = THREAD * size, 0.55
    else:
        radius, dark = 4 * THREAD * size, 1.0
    for a, b in shown_threads(film):
        if np.linalg.norm(x[a] - x[b]) > 0:
            rgb = palette[max(indices[a], indices[b])] * dark
            text += f"cylinder {{ {vector(x[a])}, {vector(x[b])}, {radius:.6g} pigment {{ rgb {vector(rgb)} }} {finish} }}\n"
    if not len(film.triangles):
        for v, index in zip(x, indices):
            text += f"sphere {{ {vector(v)}, {2 * radius:.6g} pigment {{ rgb {vector(palette[index])} }} {finish} }}\n"
    return text


def shown_threads(film: Film) -> np.ndarray:
    """All edges; of a fine square every other thread or fewer, so that they stay lines."""
    side = math.isqrt(film.header["vertices"])
    if not len(film.triangles) or side * side != film.header["vertices"] or side <= LONGEST_THREADS // 2:
        return film.edges
    every = -(-side // LONGEST_THREADS) * 2
    a, b = film.edges[:, 0], film.edges[:, 1]
    row = (a // side == b // side) & (a // side % every == 0)
    column = (a % side == b % side) & (a % side % every == 0)
    return film.edges[row | column]


ANGLE = 24  # of the camera, degrees
TOWARDS = {True: (0.0, 0.12, 1.0), False: (0.55, 0.45, 1.0)}  # the camera: of what moves in a plane alone, and of all else


@dataclass
class View:
    """A camera that stands still and sees every point of every frame."""

    centre: np.ndarray
    eye: np.ndarray
    size: float  # of what it sees, m
    aspect: float  # height of a picture over its width

    @staticmethod
    def of(points: np.ndarray, flat: bool) -> "View":
        towards = np.array(TOWARDS[flat]) / np.linalg.norm(TOWARDS[flat])
        right = np.cross([0.0, 1.0, 0.0], towards)
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(towards, right), towards])
        seen = points @ axes.T
        middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
        x, y, z = np.abs(seen[:, 0] - middle[0]), np.abs(seen[:, 1] - middle[1]), seen[:, 2] - middle[2]
        aspect = float(np.clip(y.max() / max(x.max(), 1e-6), 0.5, 1.3))
        distance = float((np.maximum(x, y / aspect) * 1.06 / math.tan(math.radians(ANGLE / 2)) + z).max())
        centre = middle @ axes
        size = max(float(np.maximum(x, y).max()), 1e-6)
        return View(centre, centre + max(distance, 1e-6) * towards, size, aspect)

    def scene(self) -> str:
        light = self.centre + np.array([1.6, 4.4, 2.8]) * self.size
        spread = 0.9 * self.size
        return (f"#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\nbackground {{ rgb {BACKGROUND} }}\n"
                f"camera {{ location {vector(self.eye)} right x*image_width/image_height*-1 look_at {vector(self.centre)} angle {ANGLE} }}\n"
                f"light_source {{ {vector(light)} rgb 0.85 area_light <{spread:.4g},0,0>, <0,0,{spread:.4g}>, 4, 4 adaptive 1 jitter }}\n"
                f"light_source {{ {vector(self.eye)} rgb 0.25 shadowless }}\n")


def thinner(body: np.ndarray, size: float) -> np.ndarray:
    """A hair smaller: cloth that lies on the body's faces would be in it and out of it by turns."""
    middle = (body.min(axis=0) + body.max(axis=0)) / 2
    reach = float(np.linalg.norm(body - middle, axis=1).max())
    return middle + (body - middle) * max(0.9, 1 - BODY_GAP * size / reach)


def body_at(header: dict[str, Any], frame: int) -> np.ndarray:
    """Where the body's corners are."""
    points = np.array(header["body"], dtype=float)
    if not header["body_poses"]:
        return points
    pose = np.array(header["body_poses"][frame], dtype=float).reshape(3, 4)
    return points @ pose[:, :3].T + pose[:, 3]


def picture(film: Film, take: int, frame: int, view: View, width: int, folder: Path) -> Image.Image:
    header = film.header
    x = film.takes[take][min(frame, len(film.takes[take]) - 1)]
    text = view.scene() + cloth(film, x, header["takes"][take]["strain_limit"], view.size)
    if header["body"]:
        text += mesh(thinner(body_at(header, frame), view.size), np.array(header["body_triangles"], dtype=int),
                     f"texture {{ pigment {{ rgb {BODY} }} finish {{ ambient 0.25 diffuse 0.7 specular 0.15 roughness 0.05 }} }}\n", None)
    source, image = folder / "frame.pov", folder / "frame.png"
    source.write_text(text, encoding="utf-8")
    done = subprocess.run(["povray", f"+I{source}", f"+O{image}", f"+W{width}", f"+H{round(width * view.aspect)}", "+A0.2", "-D", "-GA", "+FN8"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0 or not image.exists():
        raise FilmError("povray failed: " + (done.stderr.strip().splitlines() or ["no message"])[-1][:200])
    with Image.open(image) as opened:
        return opened.convert("RGB")


# ---- Sheets -----------------------------------------------------------------------------------------------------------

def words(film: Film, take: int, frame: int) -> list[str]:
    of = film.header["takes"][take]
    strains = of["largest_strain"]
    largest = 100 * strains[min(frame, len(strains) - 1)]
    lines = [f"{of['label']}, {100 * of['strain_limit']:g} %", f"largest strain {largest:.3g} %" if largest >= 1e-3 else "largest strain below 0.001 %"]
    return lines + ([of["detail"]] if of["detail"] and frame >= of["frames"] else [])


def legend(width: int, font: ImageFont.FreeTypeFont) -> Image.Image:
    """What the colours mean, over the permitted strain."""
    strip = Image.new("RGB", (width, 2 * LINE + MARGIN), "white")
    draw = ImageDraw.Draw(strip)
    bar = min(width - 2 * MARGIN, 360)
    shades = (255 * colour(np.linspace(0, STOPS[-1][0], bar))).astype(int)
    for column, rgb in enumerate(shades):
        draw.line([(MARGIN + column, 2), (MARGIN + column, LINE - 4)], fill=tuple(int(c) for c in rgb))
    for stop in (0, 1, 2, 3, 4):
        label = "0" if stop == 0 else "limit" if stop == 1 else f"{stop}"
        at = MARGIN + bar * stop / STOPS[-1][0]
        draw.text((min(at, MARGIN + bar - draw.textlength(label, font=font)), LINE - 2), label, fill="black", font=font)
    draw.text((MARGIN + bar + 12, 0), "strain over its limit", fill="black", font=font)
    return strip


def sheet(film: Film, cells: list[list[tuple[int, int]]], view: View, width: int, folder: Path, times: bool) -> Image.Image:
    """Rows of (take, frame)."""
    font = ImageFont.truetype(FONT, 13) if Path(FONT).exists() else ImageFont.load_default()
    rows, columns = len(cells), max(len(row) for row in cells)
    head, height = 3 * LINE, round(width * view.aspect)
    key = legend(columns * width, font)
    whole = Image.new("RGB", (columns * width, rows * (height + head) + key.height + LINE), "white")
    draw = ImageDraw.Draw(whole)
    for i, row in enumerate(cells):
        for j, (take, frame) in enumerate(row):
            left, top = j * width, i * (height + head)
            lines = words(film, take, frame)
            if times:
                lines.append(f"t = {frame / film.header['frames_per_second']:.2f} s")
            for number, line in enumerate(lines[:3]):
                draw.text((left + MARGIN, top + 2 + number * LINE), line, fill="black", font=font)
            whole.paste(picture(film, take, frame, view, width, folder), (left, top + head))
    bottom = rows * (height + head)
    if not times:
        draw.text((MARGIN, bottom), f"{film.header['scene']}, t = {cells[0][0][1] / film.header['frames_per_second']:.2f} s", fill="black",
                  font=font)
    whole.paste(key, (0, bottom + LINE))
    return whole


def render(film: Film, out: Path, width: int, stills: list[float] | None) -> None:
    points = [take.reshape(-1, 3) for take in film.takes]
    if film.header["body"]:
        points += [body_at(film.header, frame) for frame in range(max(1, len(film.header["body_poses"])))]
    seen = np.concatenate(points)
    view = View.of(seen, float(np.ptp(seen[:, 2])) < 1e-3 * float(np.ptp(seen, axis=0).max()))
    frames = max(take["frames"] for take in film.header["takes"])
    fps = film.header["frames_per_second"]
    takes = range(len(film.takes))
    with tempfile.TemporaryDirectory(prefix="bench-film-") as name:
        folder = Path(name)
        if out.suffix == ".png":
            times = stills if stills is not None else [fraction * (frames - 1) / fps for fraction in (0, 1 / 3, 2 / 3, 1)]
            chosen = [max(0, min(frames - 1, round(time * fps))) for time in times]
            # Of one picture a solver: side by side.
            cells = [[(take, chosen[0]) for take in takes]] if len(chosen) == 1 else [[(take, frame) for frame in chosen] for take in takes]
            sheet(film, cells, view, width, folder, True).save(out, optimize=True)
            return
        images = []
        for frame in range(frames):
            images.append(sheet(film, [[(take, frame) for take in takes]], view, width, folder, False))
            print(f"\r{frame + 1} of {frames} pictures", end="" if frame + 1 < frames else "\n", file=sys.stderr, flush=True)
        if out.suffix == ".webp":
            images[0].save(out, save_all=True, append_images=images[1:], duration=round(1000 / fps), loop=0, quality=80, method=4)
            return
        for number, image in enumerate(images):
            image.crop((0, 0, image.width // 2 * 2, image.height // 2 * 2)).save(folder / f"{number:05d}.png")
        subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-framerate", str(fps), "-i", str(folder / "%05d.png"), "-c:v", "libx264",
                        "-pix_fmt", "yuv420p", "-crf", "20", str(out)], check=True)


def main() -> int:
    parser = argparse.ArgumentParser(prog="film.py", description="Renders what bench film has recorded.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--width", type=int, default=480)
    parser.add_argument("--stills", default="")
    given = parser.parse_args()
    try:
        missing = [tool for tool in ["povray"] + (["ffmpeg"] if given.out.suffix == ".mp4" else []) if not shutil.which(tool)]
        if missing:
            raise FilmError(f"{' and '.join(missing)} missing (Debian: apt-get install {' '.join(missing)})")
        stills = [float(time) for time in given.stills.split(",")] if given.stills else None
        render(load(given.folder), given.out, given.width, stills)
    except (FilmError, OSError, ValueError, subprocess.CalledProcessError) as error:
        print(f"film.py: {error}", file=sys.stderr)
        return 2
    print(given.out)
    return 0


if __name__ == "__main__":
    os.environ["OMP_NUM_THREADS"] = "1"
    sys.exit(main())
