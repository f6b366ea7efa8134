"""Whose the lead is: at each strain limit, within the headline's error, how many times as long the leader's method takes in its
published time stepper (the stepper's share), and how many times as long the next method takes in the leader's stepper (the method's
share). Drawn from the program's analysis alone."""

from __future__ import annotations

from functools import partial
from typing import Callable

from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from parts.caption import SUBJECTS, origin_sentence, percent, warnings_of
from parts.colors import BLACK, BLUE, GREY, ORANGE, SKY
from parts.legend import Legend
from parts.result_file import Json, finding_in
from parts.sheet import RIGHT, make_sheet
from parts.words import clean, place_part, scene_words

NAMES, WIDTH, BAR = 3.1, 4.6, 0.15  # inches
TICKS = (1, 1.5, 2, 3, 5, 10, 20, 50, 100)
# What is compared with the leader: key of its name and of the ratio, words, colour.
SHARES = (
    ("first_as_published", "lead_by_stepper", "the same method, as published", ORANGE),
    ("rival_in_stepper", "lead_by_method", "the next method, in the same stepper", BLUE),
    ("paper_best", "lead_over_paper_best", "the paper's best, as published", GREY),
    ("paper_in_any_stepper", "lead_over_paper_in_any_stepper", "the paper's best, in any stepper", SKY),
)


def figures_of(document: Json, legend: Legend) -> list[tuple[str, Callable[[], Figure]]]:
    analysis = document.get("analysis")
    if not isinstance(analysis, dict):
        return []
    planes = [plane for plane in analysis["planes"] if plane["sweep"] == "strain" and cells_of(plane, analysis)]
    return [(f"lead-{place_part(plane, planes)}", partial(draw, plane, document, legend)) for plane in planes]


def cells_of(plane: Json, analysis: Json) -> list[Json]:
    """Those of the headline's error that have a leader and anything to compare it with."""
    return [cell for cell in plane["cells"] if cell["error_level"] == analysis.get("headline_error") and cell.get("first")
            and any(cell.get(ratio) for _, ratio, _, _ in SHARES)]


def draw(plane: Json, document: Json, legend: Legend) -> Figure:
    analysis = document["analysis"]
    cells = cells_of(plane, analysis)
    scene = SUBJECTS.get(plane["scene"], scene_words(plane["scene"]))
    title = f"{scene}, {plane['vertices']:,} vertices: how much of the lead is the time stepper's, and how much the method's"
    row = BAR * (len(SHARES) + 1.5)
    sheet = make_sheet(title, warnings_of(document), _caption(document, analysis), NAMES + WIDTH + 1.1 + RIGHT, row * len(cells) + 0.2,
                       finding=" ".join(finding_in(document, plane["scene"], plane["sweep"], plane["vertices"])))
    axes = sheet.axes(NAMES, sheet.bottom, WIDTH, row * len(cells))
    for place, cell in enumerate(cells):
        for number, (name, ratio, words, color) in enumerate(SHARES):
            y = place + (number + 0.75) / (len(SHARES) + 1.5)
            lead = cell.get(ratio)
            itself = cell.get(name) == cell["first"]
            if lead:
                low, high = lead["low"] or lead["value"], lead["high"] or lead["value"]
                axes.barh(y, lead["value"] - 1, left=1, height=0.9 / (len(SHARES) + 1.5), color=color, label=words if place == 0 else None)
                axes.plot([low, high], [y, y], color=BLACK, linewidth=0.8)
            text = f" {lead['value']:.2g}  {clean(legend.label(cell[name]))}" if lead else " the leader itself" if itself else " none in these results"
            axes.text(max(lead["high"] or lead["value"], 1) if lead else 1, y, text, va="center", fontsize=6.5)
    axes.set_xscale("log")
    leads = [cell[ratio]["value"] for cell in cells for _, ratio, _, _ in SHARES if cell.get(ratio)]
    axes.set(xlim=(1, 8 * max(leads)), ylim=(len(cells), 0), xlabel="times the leader's time")
    axes.set_xticks([tick for tick in TICKS if tick <= 4 * max(leads)], minor=False)
    axes.xaxis.set_major_formatter(lambda tick, _: f"{tick:g}")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_yticks([k + 0.5 for k in range(len(cells))],
                    [f"{percent(cell['strain_limit'])}: {clean(legend.label(cell['first']))}" for cell in cells])
    axes.tick_params(axis="y", length=0)
    return sheet.figure


def _caption(document: Json, analysis: Json) -> list[str]:
    colors = {ORANGE: "orange", BLUE: "blue", GREY: "grey", SKY: "light blue"}
    shares = "; ".join(f"{colors[color]}: {words}" for _, _, words, color in SHARES)
    return [f"At each strain limit the leader among runs with an error of at most {percent(analysis['headline_error'])}, and how many "
            f"times as long others take. From top to bottom, {shares}. Lines: 95 % intervals.", origin_sentence(document)]
