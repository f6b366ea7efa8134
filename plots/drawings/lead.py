"""What the lead is due to: at each strain limit, within the headline's error, how many times as long the leader's method takes in its
published time stepper (the stepper's share), and the next method in the leader's stepper (the method's share)."""

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from parts.axes import set_ticks
from parts.result import Figures, Json, Result
from parts.sheet import RIGHT, make_sheet
from parts.style import BLACK, BLUE, GREY, ORANGE, SKY
from parts.words import percent, place_part, subject

NAMES, WIDTH, BAR = 3.1, 4.6, 0.15  # inches
TICKS = (1, 1.5, 2, 3, 5, 10, 20, 50, 100)
# What is compared with the leader: key of its name and of the ratio, words, colour and its name.
SHARES = (
    ("first_as_published", "lead_by_stepper", "the same method, as published", ORANGE, "orange"),
    ("rival_in_stepper", "lead_by_method", "the next method, in the same stepper", BLUE, "blue"),
    ("paper_best", "lead_over_paper_best", "the paper's best, as published", GREY, "grey"),
    ("paper_in_any_stepper", "lead_over_paper_in_any_stepper", "the paper's best, in any stepper", SKY, "light blue"),
)


def figures_of(result: Result) -> Figures:
    planes = [plane for plane in result.analysis.get("planes", []) if plane["sweep"] == "strain" and _cells(plane, result)]
    return [(f"lead-{place_part(plane, planes)}", draw, plane, result) for plane in planes]


def _cells(plane: Json, result: Result) -> list[Json]:
    """Those of the headline's error that have a leader and anything to compare it with."""
    return [cell for cell in plane["cells"] if cell["error_level"] == result.analysis["headline_error"] and cell["first"]
            and any(cell[ratio] for _, ratio, *_ in SHARES)]


def draw(plane: Json, result: Result) -> Figure:
    cells = _cells(plane, result)
    row = BAR * (len(SHARES) + 1.5)
    caption = (f"At each strain limit the leader among runs with an error of at most {percent(result.analysis['headline_error'])}, and how "
               "many times as long others take. From top to bottom, "
               f"{'; '.join(f'{color}: {words}' for *_, words, _, color in SHARES)}. Lines: 95 % intervals.")
    sheet = make_sheet(result, f"{subject(plane['scene'], plane['vertices'])}: how much of the lead is the time stepper's, and how much "
                       "the method's", [caption], NAMES + WIDTH + 1.1 + RIGHT, row * len(cells) + 0.2,
                       finding=" ".join(result.finding(plane["scene"], plane["sweep"], plane["vertices"])))
    axes = sheet.axes(NAMES, sheet.bottom, WIDTH, row * len(cells))
    for place, cell in enumerate(cells):
        for number, (name, ratio, words, color, _) in enumerate(SHARES):
            y, lead, right = place + (number + 0.75) / (len(SHARES) + 1.5), cell[ratio], 1
            text = " the leader itself" if cell[name] == cell["first"] else " none in these results"
            if lead:
                low, high = lead["low"] or lead["value"], lead["high"] or lead["value"]
                axes.barh(y, lead["value"] - 1, left=1, height=0.9 / (len(SHARES) + 1.5), color=color, label=words if place == 0 else None)
                axes.plot([low, high], [y, y], color=BLACK, linewidth=0.8)
                text, right = f" {lead['value']:.2g}  {result.label(cell[name])}", max(high, 1)
            axes.text(right, y, text, va="center", fontsize=6.5)
    most = max(cell[ratio]["value"] for cell in cells for _, ratio, *_ in SHARES if cell[ratio])
    axes.set(xscale="log", xlim=(1, 8 * most), ylim=(len(cells), 0), xlabel="times the leader's time")
    set_ticks(axes.xaxis, FixedLocator([tick for tick in TICKS if tick <= 4 * most]), NullLocator())
    axes.set_yticks([k + 0.5 for k in range(len(cells))],
                    [f"{percent(cell['strain_limit'])}: {result.label(cell['first'])}" for cell in cells])
    axes.tick_params(axis="y", length=0)
    return sheet.figure
