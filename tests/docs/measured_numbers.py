"""Numbers of documents that follow from result files, with their intervals; check_docs.py has the comments' grammar.

The interval of a ratio is that of `bench results` (harness/base/statistics.h), computed anew."""

from __future__ import annotations

import functools
import json
import math
import re
import statistics
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NUMBER = re.compile(
    r"<!-- (?P<file>\S+\.json) (?P<quantity>[a-z ]+) (?P<scene>\w+) (?P<place>[\d.]+): (?P<one>[\w@]+)(?: / (?P<other>[\w@]+))?"
    r" = (?P<number>[\d.]+) ?(?P<unit>ms|s|%|)(?: \((?P<low>[\d.]+)-(?P<high>[\d.]+)\))?(?P<within> within interval)?"
    r"(?: (?P<side>above|below) (?P<bound>[\d.]+))? -->")
COMMENTED = re.compile(r"<!--.*?-->", re.DOTALL)
UNITS = {"": 1, "s": 1, "ms": 1e-3, "%": 0.01}
SURE = 3  # gaps of a reference
LONGEST_STEP = 1 / 24  # s, a frame
HEADLINE = 0.02  # error, over the scene's size


@dataclass(frozen=True)
class Value:
    """Of a ratio with its 95 % interval, None where it is not known."""

    value: float
    interval: tuple[float, float] | None = None


@functools.cache
def document(file: str) -> dict:
    return json.loads((ROOT / file).read_text(encoding="utf-8"))


def points_of(file: str) -> list[dict]:
    return document(file)["points"]


def seconds(point: dict) -> float:
    timing = point["seconds_per_simulated_second"]
    return min(timing["samples"]) if "samples" in timing else timing["median"]


def delivered_strain(point: dict) -> float:
    for key in ("max_strain_after_collision", "max_strain"):
        if point.get(key) is not None:
            return point[key]
    return math.inf


def within_error(point: dict, level: float) -> bool:
    """Of the samples at which the reference is sure enough; older files have one error for all levels."""
    error = point["error"]
    if not error.get("error_series"):
        distance, gap = error["trajectory"], error["gap"]
        return distance is not None and distance <= level and not (gap is not None and SURE * gap > level)
    usable = [row[1] for row in error["error_series"] if None not in (row[1], row[3]) and SURE * row[3] <= level]
    return bool(usable) and math.sqrt(sum(distance**2 for distance in usable) / len(usable)) <= level


def at_any_settings(file: str, contestant: str) -> set[str]:
    """It and its hollow selves, but for the second of an A/A pair."""
    pair = (document(file).get("context", {}).get("noise") or {}).get("pair") or [None, None]
    return {contestant} | {c["name"] for c in document(file).get("legend", {}).get("solvers", [])
                           if c.get("hollow") and c.get("solver") == contestant and c["name"] != pair[1]}


def point_of(file: str, quantity: str, scene: str, place: float, contestant: str) -> dict:
    """The point that is meant, the fastest with tuned or untuned settings; raises LookupError where the file has none."""
    names = at_any_settings(file, contestant)
    points = [p for p in points_of(file) if p["scene"] == scene and p.get("contestant", p["solver"]) in names
              and p["status"] == "ok" and p["seconds_per_simulated_second"]]
    if quantity in ("error", "delivered", "right motion"):
        fits = {"right motion": lambda p: p["sweep"] == "strain" and p["strain_limit"] <= place * (1 + 1e-9)
                and within_error(p, HEADLINE),
                "error": lambda p: p["sweep"] == "step" and within_error(p, place),
                "delivered": lambda p: p["sweep"] == "strain" and delivered_strain(p) <= place}[quantity]
        found = [p for p in points if fits(p)]
        if not found:
            raise LookupError("no such point")
        return min(found, key=seconds)
    sweep = "resolution" if quantity == "resolution" else "strain"
    axis = "vertices" if sweep == "resolution" else "strain_limit"
    points = [p for p in points if p["sweep"] == sweep and math.isclose(p[axis], place) and p["step"] <= LONGEST_STEP * (1 + 1e-9)]
    if sweep == "strain":  # the largest size, as in figures
        points = [p for p in points if p["vertices"] == max(q["vertices"] for q in points)]
    if not points:
        raise LookupError("no such point")
    of = {name: [p for p in points if p.get("contestant", p["solver"]) == name] for name in names}
    # As analysis does: the point that the sweep marked, without a mark the fastest.
    return min((min([p for p in own if p["best"]] or own, key=seconds) for own in of.values() if own), key=seconds)


def measured(match: re.Match[str]) -> Value:
    """What the file says of a comment, in its unit."""
    def point(contestant: str) -> dict:
        return point_of(match["file"], match["quantity"], match["scene"], float(match["place"]), contestant)

    of = delivered_strain if match["quantity"] == "after collision" else seconds
    one = point(match["one"])
    if not match["other"]:
        return Value(of(one) / UNITS[match["unit"]])
    other = point(match["other"])
    if of is delivered_strain:
        return Value(of(one) / of(other))
    noise = document(match["file"])["context"].get("noise") or {}
    samples = (p["seconds_per_simulated_second"]["samples"] for p in (one, other))
    return Value(seconds(one) / seconds(other), interval_of_ratio(*samples, noise.get("q95")))


# ---- intervals ------------------------------------------------------------------------------------------------------

def interval_of_ratio(a: list[float], b: list[float], noise: float | None) -> tuple[float, float] | None:
    """All factors that the exact two-sided Mann-Whitney test does not reject at 5 %, at least as wide as `noise`."""
    value = min(a) / min(b)
    sides = []
    if (count := critical_count(len(a), len(b))) > 0:
        quotients = sorted(x / y for x in a for y in b)
        sides.append((quotients[count - 1], quotients[-count]))
    if noise is not None:
        sides.append((value * math.exp(-noise), value * math.exp(noise)))
    if not sides:
        return None
    return min(value, *(low for low, _ in sides)), max(value, *(high for _, high in sides))


EXACT_UP_TO = 60  # values in all; the normal approximation above


@functools.cache
def critical_count(n: int, m: int) -> int:
    """The largest count of pairs in favour of the first that 2.5 % of all orders of n and m values stay below."""
    if n + m > EXACT_UP_TO:
        spread = math.sqrt(n * m * (n + m + 1) / 12)
        return max(0, int(n * m / 2 - statistics.NormalDist().inv_cdf(0.975) * spread))
    below = 0.0
    for count in range(n * m + 1):
        below += orders(n, m, count) / math.comb(n + m, n)
        if below > 0.025:
            return count
    return 0


@functools.cache
def orders(n: int, m: int, count: int) -> int:
    """In how many orders of n and m values exactly `count` pairs have the first one above: the largest is of either kind."""
    if count < 0 or n < 0 or m < 0:
        return 0
    if n == 0 or m == 0:
        return int(count == 0)
    return orders(n - 1, m, count - m) + orders(n, m - 1, count)


# ---- texts ----------------------------------------------------------------------------------------------------------

def with_digits(value: float, like: str) -> str:
    """With as many significant digits as `like` has, two or more, and no fewer before the point than it needs."""
    digits = max(2, len(like.replace(".", "").lstrip("0")))
    return f"{value:.{max(0, digits - 1 - math.floor(math.log10(value)))}f}" if value > 0 else f"{value:.0f}"


def says(value: float, number: str) -> bool:
    decimals = len(number.partition(".")[2])
    return number in (with_digits(value, number), f"{value:.{decimals}f}")


def paragraph_text(number: str, unit: str, low: str | None, high: str | None) -> str:
    return number + (f" {unit}" if unit else "") + (f" ({low}-{high})" if low else "")


def text_of(match: re.Match[str]) -> str:
    """What the paragraph must say."""
    return paragraph_text(match["number"], match["unit"], match["low"], match["high"])


def renewed_comment(match: re.Match[str]) -> str:
    """The comment as its file has it now. Raises as measured() does."""
    found = measured(match)
    if match["within"] and found.interval and found.interval[0] <= float(match["number"]) <= found.interval[1]:
        return match[0]
    number = match["number"] if says(found.value, match["number"]) else with_digits(found.value, match["number"])
    parts = {"number": number}
    if match["low"] and found.interval:
        decimals = len(number.partition(".")[2])
        parts |= {side: f"{bound:.{decimals}f}" for side, bound in zip(("low", "high"), found.interval)}
    text = match[0]
    for name in sorted(parts, key=match.start, reverse=True):
        start, end = (place - match.start() for place in match.span(name))
        text = text[:start] + parts[name] + text[end:]
    return text


def paragraphs(text: str) -> list[str]:
    """They add up to the text."""
    return re.split(r"(?<=\n)(?=\* |\n)", text)


def whole(text: str) -> str:
    """A pattern for a number that is no part of a longer one."""
    return rf"(?<![\d.]){re.escape(text)}(?!\d|\.\d)"


def renewed_paragraph(paragraph: str) -> str:
    """Comments and the numbers they stand for brought up to date, where that changes digits alone. A paragraph in which one text
    would become two is left to its author."""
    new_texts: dict[str, set[str]] = {}
    comments: dict[str, str] = {}
    for comment in COMMENTED.findall(paragraph):
        if match := NUMBER.fullmatch(comment):
            try:
                comments[comment] = renewed_comment(match)
            except (OSError, LookupError, ValueError, TypeError):
                return paragraph  # the check names it
            new_texts.setdefault(text_of(match), set()).add(text_of(NUMBER.fullmatch(comments[comment])))
    if any(len(texts) > 1 for texts in new_texts.values()):
        return paragraph
    words = COMMENTED.sub("", paragraph)
    if any(not re.search(whole(old), words) for old in new_texts):
        return paragraph
    if not new_texts:
        return paragraph
    longest_first = sorted(new_texts, key=len, reverse=True)
    numbers = re.compile("|".join(whole(old) for old in longest_first))
    parts = re.split(r"(<!--.*?-->)", paragraph, flags=re.DOTALL)
    return "".join(comments.get(part, part) if part.startswith("<!--") else
                   numbers.sub(lambda found: next(iter(new_texts[found[0]])), part) for part in parts)


def errors_in(text: str) -> list[str]:
    """Of a document without its blocks of code."""
    errors = []
    for paragraph in paragraphs(text):
        words = COMMENTED.sub("", paragraph)
        for comment in COMMENTED.findall(paragraph):
            match = NUMBER.fullmatch(comment)
            if not match:
                if ".json" in comment and not comment.startswith("<!-- bench "):
                    errors.append(f"cannot read {comment}")
                continue
            try:
                errors += [f"{comment}: {problem}" for problem in problems_of(match, words)]
            except (OSError, LookupError, ValueError, TypeError) as error:
                errors.append(f"{comment}: {error}")
    return errors


def problems_of(match: re.Match[str], words: str) -> list[str]:
    found, problems = measured(match), []
    inside = found.interval and found.interval[0] <= float(match["number"]) <= found.interval[1]
    if not (says(found.value, match["number"]) or match["within"] and inside):
        problems.append(f"it is {found.value:.4g}")
    if (match["low"] or match["within"] or match["side"]) and not found.interval:
        problems.append("no interval is known: too few runs, and no A/A pair")
    elif match["low"] and not all(says(bound, match[side]) for side, bound in zip(("low", "high"), found.interval)):
        problems.append("its interval is {:.3g} to {:.3g}".format(*found.interval))
    if match["side"] and found.interval:
        bound = float(match["bound"])
        if not (found.interval[0] > bound if match["side"] == "above" else found.interval[1] < bound):
            problems.append("its interval, {:.3g} to {:.3g}, does not lie {} {}".format(*found.interval, match["side"], match["bound"]))
    if not re.search(whole(text_of(match)), words):
        problems.append(f"the paragraph does not say {text_of(match)}")
    return problems
