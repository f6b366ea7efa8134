#!/usr/bin/python3
"""Puts the pictures of `bench film` together: stills on a sheet, or a film with solvers side by side.

    plots/film.py FOLDER OUT.webp|.png

FOLDER holds film.json and the pictures of each take (harness/film/film.h). Pillow draws captions and writes the files.
"""

import argparse
import json
import statistics
import sys
from pathlib import Path
from typing import Any

sys.dont_write_bytecode = True

from PIL import Image, ImageDraw, ImageFont

from parts.style import ALARM
from parts.words import wrapped

MARGIN = 8  # pixels
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
BACKGROUND, INK = (255, 255, 255), (20, 20, 20)
FRAME_RATE = 30  # Hz, of the frames whose time captions tell, as the paper does
GREY = 0.4       # how far the picture of a run that gave up goes towards the background


class Film:
    """The contents of a folder, and a font that suits the size of its pictures."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.header = json.loads((folder / "film.json").read_text(encoding="utf-8"))
        self.width, self.height, self.frames = (self.header[key] for key in ("width", "height", "frames"))
        self.takes, self.rate = self.header["takes"], self.header["frames_per_second"]
        size = max(9, min(15, self.width // 26))
        self.font = ImageFont.truetype(FONT, size) if Path(FONT).exists() else ImageFont.load_default()
        self.line = round(1.35 * size)


def percent(strain: float) -> str:
    return f"{100 * strain:.3g} %" if strain >= 1e-5 else "below 0.001 %"


def caption(film: Film, take: int, frame: int) -> list[str]:
    """The lines under a panel."""
    of = film.takes[take]
    frame = min(frame, of["frames"] - 1)
    strained = max(of["largest_strain"]) > of["strain_limit"] * (1 + 1e-6)
    status = "gains energy" if of["energy_gained"] else "gave up" if of["detail"] else "strained more than permitted" if strained else "ok"
    lines = [of["label"], f"steps of 1/{1 / of['step']:.6g} s: {status}",
             f"strain limit {percent(of['strain_limit'])}, largest so far {percent(max(of['largest_strain'][:frame + 1]))}"]
    if of["seconds"]:
        lines.append(f"{1000 * statistics.median(of['seconds']) * film.rate / FRAME_RATE:.3g} ms for a frame of 1/{FRAME_RATE} s")
    if sags := {name.replace("_", " "): at[frame] for name, at in of["sag"].items()}:
        lines.append("sag: " + ", ".join(f"{name} {1000 * sag:.1f} mm" if abs(sag) < 1 else f"{name} {sag:.2f} m" for name, sag in sags.items()))
    return lines


def write(picture: Image.Image, film: Film, lines: list[str], top: float, left: float | None = MARGIN, fill: Any = INK) -> None:
    """Line by line; left None: centred."""
    for number, line in enumerate(lines):
        start = (film.width - film.font.getlength(line)) / 2 if left is None else left
        ImageDraw.Draw(picture).text((start, top + number * film.line), line, fill=fill, font=film.font)


def alarmed(picture: Image.Image, text: str, film: Film) -> Image.Image:
    """Framed, with a message on it."""
    draw = ImageDraw.Draw(picture)
    draw.rectangle((0, 0, film.width - 1, film.height - 1), outline=ALARM, width=2)
    lines = wrapped(text, lambda line: film.font.getlength(line) <= film.width - 4 * MARGIN)
    top = film.height - len(lines) * film.line - 3 * MARGIN
    draw.rectangle((MARGIN, top - MARGIN, film.width - MARGIN, top + len(lines) * film.line + MARGIN), fill=BACKGROUND, outline=ALARM)
    write(picture, film, lines, top, left=None, fill=ALARM)
    return picture


def panel(film: Film, take: int, frame: int) -> Image.Image:
    """A picture and its caption."""
    of = film.takes[take]
    with Image.open(film.folder / f"{take}-{min(frame, of['frames'] - 1)}.png") as opened:
        picture = opened.convert("RGB")
    if frame >= of["frames"]:
        pale = Image.blend(picture.convert("L").convert("RGB"), Image.new("RGB", picture.size, (235, 235, 235)), GREY)
        picture = alarmed(pale, of["detail"] or "ended", film)  # this run does not go on
    elif of["energy_gained"]:
        picture = alarmed(picture, "this run gains energy: its motion is wrong", film)
    lines = caption(film, take, frame)
    whole = Image.new("RGB", (film.width, film.height + (len(lines) + 1) * film.line), BACKGROUND)
    whole.paste(picture, (0, 0))
    write(whole, film, [f"t = {frame / film.rate:.2f} s"], MARGIN // 2)
    write(whole, film, lines, film.height + MARGIN // 2)
    return whole


def legend(film: Film, width: int) -> Image.Image:
    """What the colours mean: strain over its limit."""
    shades, end = film.header["legend"], film.header["legend_end"]
    strip = Image.new("RGB", (width, 2 * film.line + MARGIN), BACKGROUND)
    bar = min(width - 2 * MARGIN, 360)
    row = Image.new("RGB", (len(shades), 1))
    row.putdata([tuple(shade) for shade in shades])
    strip.paste(row.resize((bar, film.line - 6), Image.BILINEAR), (MARGIN, 3))
    for stop in range(end + 1):
        label = "0" if stop == 0 else "limit" if stop == 1 else f"{stop} x"
        write(strip, film, [label], film.line - 2, min(MARGIN + bar * stop / end, MARGIN + bar - film.font.getlength(label)))
    if MARGIN + bar + 12 + film.font.getlength("strain") < width:
        write(strip, film, ["strain"], 0, MARGIN + bar + 12)
    return strip


def sheet(film: Film, cells: list[list[tuple[int, int]]]) -> Image.Image:
    """Rows of (take, frame)."""
    rows = [[panel(film, take, frame) for take, frame in row] for row in cells]
    width, height = max(len(row) for row in rows) * film.width, max(cell.height for row in rows for cell in row)
    key = legend(film, width)
    whole = Image.new("RGB", (width, len(rows) * height + key.height), BACKGROUND)
    for i, row in enumerate(rows):
        for j, cell in enumerate(row):
            whole.paste(cell, (j * film.width, i * height))
    whole.paste(key, (0, len(rows) * height))
    return whole


def stills(film: Film) -> Image.Image:
    """One time: takes side by side. Several: a row for each take."""
    takes = range(len(film.takes))
    cells = [[(take, frame) for frame in film.frames] for take in takes]
    return sheet(film, cells if len(film.frames) > 1 else [[cell for row in cells for cell in row]])


def save(film: Film, out: Path) -> None:
    if out.suffix == ".png":
        stills(film).save(out, optimize=True)
    else:
        images = (sheet(film, [[(take, frame) for take in range(len(film.takes))]]) for frame in film.frames)
        next(images).save(out, save_all=True, append_images=images, duration=round(1000 / film.rate), loop=0, quality=86, method=2)


def main() -> int:
    parser = argparse.ArgumentParser(prog="film.py", description="Puts the pictures of bench film together.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    try:
        save(Film(given.folder), given.out)
    except (OSError, ValueError) as error:
        print(f"film.py: {error}", file=sys.stderr)
        return 2
    print(given.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
