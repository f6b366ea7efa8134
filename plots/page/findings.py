"""What the report says in words. Every sentence is computed from the points; none says who is fastest where noise may have
decided it."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass

from parts.best_points import FigureData, delivered_strain, sweeps_in
from parts.legend import Legend
from parts.result_file import Json, contestant_of, is_number, noise_factor, object_in, positive

LIMITS = (0.1, 0.01, 0.001, 0.0001)


@dataclass(frozen=True)
class Finding:
    text: str
    parts: tuple[str, ...] = ()


def findings(documents: list[Json], legend: Legend) -> list[Finding]:
    found: list[Finding] = []
    for document in documents:
        if "points" in document:
            found += _contests(document, legend)
        if "matrix" in document:
            found.append(_hard_cases(document))
        if "rows" in document and "answers" in document:
            found.append(_answers(document))
    return found


def _contests(document: Json, legend: Legend) -> list[Finding]:
    factor = noise_factor(document) or 1
    found = []
    for data in sweeps_in(document, legend, "strain"):
        parts = tuple(text for limit in LIMITS if (text := _fastest(data, limit, factor, legend)))
        if parts:
            how = ", steps chosen by a controller" if data.adaptive else ""
            found.append(Finding(f"{_scene(data)} of {data.fixed:g} vertices{how}:", parts))
    for data in sweeps_in(document, legend, "resolution"):
        if text := _growth(data, legend):
            found.append(Finding(text))
    return found


def _scene(data: FigureData) -> str:
    return data.scene.replace("_", " ").capitalize()


def _fastest(data: FigureData, limit: float, factor: float, legend: Legend) -> str:
    """Who is first at a limit, and at what price in error; equals are named together, then the next."""
    runs = sorted(((best.seconds, name, best) for name, curve in data.curves.items() if legend.ranked(name)
                   for best in curve.best if math.isclose(best.x, limit)), key=lambda run: (run[0], run[1]))
    if len(runs) < 2:
        return ""
    first = runs[0][2]
    equal = [name for seconds, name, best in runs if best.low <= first.high or seconds < factor * first.seconds]
    rest = [(seconds, name) for seconds, name, _ in runs if name not in equal]
    who = " and ".join(legend.label(name) for name in equal[:3]) + (f" and {len(equal) - 3} more" if len(equal) > 3 else "")
    verb = "is the fastest" if len(equal) == 1 else "are the fastest, with no difference beyond the noise"
    text = f"at {100 * limit:g} % {who} {verb}: {_time(first.seconds)} a simulated second{_price(data, limit, runs[0][1])}"
    if rest:
        seconds, name = rest[0]
        text += f"; then {legend.label(name)}, {seconds / first.seconds:.2g} times that{_price(data, limit, name)}"
    return text


def _price(data: FigureData, limit: float, name: str) -> str:
    """The step and the errors of the best point: a coarse step is fast and far off."""
    point = next((p for p in data.points if p.get("best") is True and contestant_of(p) == name and math.isclose(p["strain_limit"], limit)), None)
    if point is None:
        return ""
    parts = [f"steps of 1/{1 / point['step']:.3g} s"] if positive(point.get("step")) and not data.adaptive else []
    error = object_in(point, "error").get("trajectory")
    if is_number(error):
        parts.append(f"error {error:.2g} of its size")
    delivered = delivered_strain(point)
    if delivered is not None and delivered > 1.01 * limit:
        parts.append(f"{100 * delivered:.2g} % of strain after collisions")
    return f" ({', '.join(parts)})" if parts else ""


def _growth(data: FigureData, legend: Legend) -> str:
    sizes = data.xs()
    if len(sizes) < 3:
        return ""
    exponents = []
    for name, curve in data.curves.items():
        at = {best.x: best.seconds for best in curve.best}
        if legend.ranked(name) and sizes[0] in at and sizes[-1] in at:
            exponents.append((math.log(at[sizes[-1]] / at[sizes[0]]) / math.log(sizes[-1] / sizes[0]), name))
    if len(exponents) < 2:
        return ""
    slow, fast = max(exponents), min(exponents)
    return (f"{_scene(data)} at {100 * data.fixed:g} %, from {sizes[0]:g} to {sizes[-1]:g} vertices: the time of "
            f"{legend.label(fast[1])} grows least, with the power {fast[0]:.2f} of the vertices, that of {legend.label(slow[1])} most, "
            f"with {slow[0]:.2f}.")


def _hard_cases(document: Json) -> Finding:
    cells = document["matrix"]
    outcomes = Counter(cell["outcome"].replace("_", " ") for cell in cells)
    unexpected = sum(cell.get("as_expected") is False for cell in cells)
    cases = len({cell["row"] for cell in cells})
    return Finding(f"Hard cases: {len(cells)} runs of {cases} cases, {unexpected} not as theory expects; "
                   + ", ".join(f"{count} {name}" for name, count in outcomes.most_common()) + ".")


def _answers(document: Json) -> Finding:
    rows = document["rows"]
    finished = sum(isinstance(row.get("deviation"), (int, float)) for row in rows)
    return Finding(f"Known answers: {len(document['answers'])} figures that theory or measurement knows, {len(rows)} runs, of which "
                   f"{finished} gave a figure.")


def _time(seconds: float) -> str:
    for unit, scale in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds:.3g} s"
