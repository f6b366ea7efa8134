"""Words that fit: texts from result files made harmless, measured, cut and wrapped to a width."""

import re
from bisect import bisect_left
from functools import lru_cache
from typing import Any, Callable

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

FONT = "DejaVu Sans"
ELLIPSIS = "\u2026"
LONGEST = 160  # characters of one value from a file
FILE_NAME = 60


def printable(text: Any) -> str:
    """One line without control characters, which no SVG may hold."""
    return " ".join("".join(c if c.isprintable() else " " for c in str(text)).split())


def clean(text: Any) -> str:
    """A value from a file: one line, and not endless."""
    line = printable(text)
    return line if len(line) <= LONGEST else line[:LONGEST - 1] + ELLIPSIS


def plain(value: Any) -> str:
    """A value as a reader wants it."""
    return clean(f"{value:g}" if isinstance(value, float) else value)


def spoken(label: str) -> str:
    """A solver's label as people say it: of "a, b in c", "b a in c"; so commas are between labels only."""
    return re.sub(r"^([^,(]+), (\w+),?( in .*)?$", r"\2 \1\3", label)


def short(label: str) -> str:
    """Without the words in parentheses."""
    return re.sub(r" \([^)]*\)", "", label)


def percent(fraction: float) -> str:
    return f"{100 * fraction:.4g} %"


def step_name(step: float) -> str:
    return f"1/{1 / step:.6g}" if step < 1 else f"{step:g}"


def scene_words(scene: str) -> str:
    """As people call it: of a mesh its file's name, and four digits of its content's hash."""
    found = re.match(r"(?:mesh|folder):(?:[^,]*/)?([^,]*)(?:.*,content=(.{4}))?", scene)
    return clean(scene if not found else f"{found[1]} ({found[2]})" if found[2] else found[1])


def subject(scene: str, vertices: int | None = None) -> str:
    """A scene in a title."""
    name = "drape over a sphere" if scene == "drape" else scene_words(scene).replace("_", " ")
    return name if vertices is None else f"{name}, {vertices:,} vertices"


def file_part(text: str) -> str:
    """A text as part of a file's name."""
    return "".join(c if c.isascii() and c.isalnum() or c in "-_" else "_" for c in text)[:FILE_NAME]


def place_part(place: dict[str, Any], places: list[dict[str, Any]]) -> str:
    """A scene and size as part of a file's name: the scene, and the size where other `places` are of the same scene."""
    alone = sum(other["scene"] == place["scene"] for other in places) == 1
    return file_part(scene_words(place["scene"])) + ("" if alone else f"-n{place['vertices']}")


@lru_cache(maxsize=4096)
def inches(text: str, size: float, weight: str = "normal") -> float:
    """Width of a line of text; `size` in points."""
    return text_to_path.get_text_width_height_descent(text, FontProperties(family=FONT, size=size, weight=weight), False)[0] / 72


def shorten(text: str, width: float, size: float, weight: str = "normal") -> str:
    """The text, or as much of its beginning as is `width` inches wide."""
    if inches(text, size, weight) <= width:
        return text
    kept = bisect_left(range(len(text)), True, key=lambda n: inches(text[:n + 1] + ELLIPSIS, size, weight) > width)
    return text[:kept].rstrip() + ELLIPSIS


def wrap(text: str, width: float, size: float, weight: str = "normal") -> list[str]:
    """Lines at most `width` inches wide."""
    return wrapped(text, lambda line: inches(line, size, weight) <= width)


def wrapped(text: str, fits: Callable[[str], bool]) -> list[str]:
    """Lines that fit, broken between words, and within those that do not fit alone."""
    lines: list[str] = []
    for word in text.split():
        if lines and fits(f"{lines[-1]} {word}"):
            lines[-1] += f" {word}"
            continue
        while len(word) > 1 and not fits(word):
            kept = max(1, bisect_left(range(len(word)), True, key=lambda n: not fits(word[:n + 1])))
            lines.append(word[:kept])
            word = word[kept:]
        lines.append(word)
    return lines
