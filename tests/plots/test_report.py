"""The report: what is computed for it, and the page in a browser (Debian: chromium-driver, python3-selenium; skipped without)."""

from __future__ import annotations

import base64
import csv
import io
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, Iterator

import pytest

from documents import ROOT, Json, resolution_sweep, stability, strain_sweep, written
from page.data import COLUMNS, document_data, embedded, repeat_command
from page.findings import findings
from page.motion import recorded
from page.pictures import picture
from parts.legend import legend_of
from test_bad_files import HOSTILE, renamed
from test_film import recorded as recorded_film

import figures

SCRIPT = ROOT / "plots" / "report.py"


def interval(seconds: float) -> Json:
    return {"min": seconds, "median": 1.02 * seconds,
            "samples": [seconds * factor for factor in (1, 1.01, 1.02, 1.02, 1.02, 1.02, 1.03, 1.04, 1.04)]}


def sampled(made: Json) -> Json:
    for entry in made["points"]:
        if entry["seconds_per_simulated_second"]:
            entry["seconds_per_simulated_second"] |= interval(entry["seconds_per_simulated_second"]["min"])
        entry["id"] = f"{entry['scene']}/{entry['solver']}/n:{entry['vertices']}/strain:{entry['strain_limit']:g}/h:{entry['step']:g}"
    made["context"]["command"] = ["bench", "--sweep", "strain", "--force", "--out", "results/it.json", "--reps", "9"]
    return made


def report(folder: Path, documents: list[Json], *more: object) -> subprocess.CompletedProcess:
    files = [written(made, folder, f"it{number}.json") for number, made in enumerate(documents)]
    return subprocess.run([sys.executable, str(SCRIPT), *map(str, files), "--out", str(folder / "report.html"), *map(str, more)],
                          capture_output=True, text=True, check=False)


TOLD = [{"scene": "chain", "sweep": "step", "vertices": 80, "subject": "chain of 80 vertices", "sentences": ["A is first."]},
        {"scene": "drape", "sweep": "strain", "vertices": 441, "subject": "drape of 441 vertices", "sentences": ["B is first."]},
        {"scene": "drape", "sweep": "strain", "vertices": 961, "subject": "drape of 961 vertices", "sentences": ["C is first.", "D."]}]


def test_findings_are_the_programs_and_the_largest_drape_comes_first() -> None:
    found = findings(TOLD, [stability()])
    assert [one.text for one in found[:3]] == ["Drape of 961 vertices, over strain:", "Drape of 441 vertices, over strain:",
                                               "Chain of 80 vertices, over step:"]
    assert found[0].parts == ("C is first.", "D.")
    assert found[3].text.startswith("Hard cases: ")


def test_the_data_are_those_of_the_points() -> None:
    made = sampled(strain_sweep())
    data = document_data({Path("it.json"): made}, legend_of(made))
    rows = [dict(zip(COLUMNS, row)) for row in data["points"]]
    assert len(rows) == len(made["points"])
    for row, entry in zip(rows, made["points"]):
        assert (row["id"], data["solvers"][row["solver"]]["name"]) == (entry["id"], entry["solver"])
        if entry["seconds_per_simulated_second"]:
            assert row["low"] <= row["seconds"] <= row["high"]
    assert repeat_command(made) == "./bench --sweep strain --reps 9"


def test_data_end_no_script() -> None:
    text = embedded({"name": "</script><script>alert(1)</script>&<!--"})
    assert "<" not in text and ">" not in text
    assert json.loads(text)["name"].startswith("</script>")


def test_a_figures_numbers_are_what_it_draws() -> None:
    made = sampled(strain_sweep())
    name, draw = next(iter(figures.all_figures(made).items()))
    made_picture = picture(name, draw)
    rows = list(csv.DictReader(io.StringIO(base64.b64decode(made_picture.csv.split(",")[1]).decode())))
    drawn = {(round(float(row["x"]), 9), round(float(row["y"]), 9)) for row in rows}
    for entry in made["points"]:
        if entry["best"]:
            assert (round(100 * entry["strain_limit"], 9), round(entry["seconds_per_simulated_second"]["min"], 9)) in drawn


def test_motion_is_kept_to_a_part_in_65535(tmp_path: Path) -> None:
    import numpy as np
    made = recorded(recorded_film(tmp_path))
    whole = np.frombuffer(base64.b64decode(made["positions"]), dtype="<u2").reshape(-1, 3)
    x = np.fromfile(tmp_path / "film.f32", dtype="<f4").reshape(-1, 3)
    assert np.abs(np.array(made["low"]) + whole / 65535 * np.array(made["span"]) - x).max() <= max(made["span"]) / 65535


def test_what_is_no_result_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "it.json").write_text("{}")
    ran = subprocess.run([sys.executable, str(SCRIPT), str(tmp_path / "it.json"), "--out", str(tmp_path / "report.html")],
                         capture_output=True, text=True, check=False)
    assert ran.returncode == 2 and len(ran.stderr.splitlines()) == 1 and not (tmp_path / "report.html").exists()


# ---- in a browser ----

@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    webdriver = pytest.importorskip("selenium.webdriver")
    from selenium.webdriver.chrome.service import Service
    driver = shutil.which("chromedriver")
    if not driver:
        pytest.skip("chromedriver is not installed")
    options = webdriver.ChromeOptions()
    for option in ("--headless=new", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader",
                   "--enable-unsafe-swiftshader", "--window-size=1200,900"):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    made = webdriver.Chrome(service=Service(driver), options=options)
    yield made
    made.quit()


def opened(browser: Any, folder: Path, documents: list[Json]) -> None:
    claims = [{"id": "C1", "statement": "<b>fast</b>", "verdict": "reproduced", "measured": "twice", "rule": "is above 1"}]
    (folder / "claims.json").write_text(json.dumps(claims))
    motion = folder / "motion"
    motion.mkdir()
    (folder / "analyses.json").write_text(json.dumps({"findings": TOLD, "of": {}}))
    ran = report(folder, documents, "--claims", folder / "claims.json", "--analyses", folder / "analyses.json", "--motion", recorded_film(motion, body=True))
    assert ran.returncode == 0, ran.stderr
    browser.get((folder / "report.html").as_uri())


def find(browser: Any, selector: str) -> list[Any]:
    return browser.find_elements("css selector", selector)


def complaints(browser: Any) -> list[str]:
    return [entry["message"] for entry in browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")
            and "GPU stall" not in entry["message"]]


def test_every_part_is_there_and_nothing_complains(browser: Any, tmp_path: Path) -> None:
    opened(browser, tmp_path, [sampled(strain_sweep()), sampled(resolution_sweep()), stability()])
    assert complaints(browser) == []
    for name in ("findings", "contest", "points", "motion", "figures", "claims", "machine"):
        assert len(find(browser, f"section#{name}")) == 1, name
    assert find(browser, "p.answer")[0].text == "Drape of 961 vertices, over strain: C is first. D."
    pictures = find(browser, "figure img")
    assert len(pictures) >= 3
    for image in pictures:
        browser.execute_script("arguments[0].scrollIntoView()", image)
        browser.execute_async_script("arguments[0].decode().then(arguments[1], arguments[1])", image)
        assert image.get_property("naturalWidth") > 100
    for link in find(browser, "figcaption a"):
        assert link.get_attribute("href").startswith("data:")
    assert (tmp_path / "report.html").stat().st_size < 10_000_000


def test_ranks_follow_when_a_solver_is_hidden(browser: Any, tmp_path: Path) -> None:
    opened(browser, tmp_path, [sampled(strain_sweep())])

    def ranks() -> list[str]:
        return [row.text for row in find(browser, "#contest-ranks tbody tr td:nth-child(2)")]

    assert ranks()[:2] == ["fast projection", "SHAKE"]
    marks = len(find(browser, "#contest-chart .mark"))
    find(browser, "#contest-solvers input")[[label.text for label in find(browser, "#contest-solvers label")].index("fast projection")].click()
    assert ranks()[0] == "SHAKE"
    assert len(find(browser, "#contest-chart .mark")) == marks - 3
    assert not any("fast projection" == row.text for row in find(browser, "#points-table tbody td:first-child"))


def test_a_mark_shows_what_is_behind_it_by_keyboard_alone(browser: Any, tmp_path: Path) -> None:
    opened(browser, tmp_path, [sampled(strain_sweep())])
    browser.execute_script("document.querySelector('#contest-chart .mark').focus()")
    detail = find(browser, "#contest-detail")[0].text
    assert "chain/" in detail and "9 runs" in detail
    browser.switch_to.active_element.send_keys("\ue007")
    assert "./bench --sweep strain --reps 9 --filter '^chain/" in find(browser, "#contest-detail")[0].text


def test_the_table_filters_and_sorts(browser: Any, tmp_path: Path) -> None:
    opened(browser, tmp_path, [sampled(strain_sweep())])
    find(browser, "#points-best")[0].click()
    find(browser, "#points-filter")[0].send_keys("jacobi diverged")
    rows = find(browser, "#points-table tbody tr")
    assert len(rows) == 1 and "diverged" in rows[0].text
    find(browser, "#points-filter")[0].clear()
    find(browser, "#points-filter")[0].send_keys("ok")
    for down in (True, False):  # it is sorted by time, upwards, from the start
        find(browser, "#points-table th button")[7].click()
        times = browser.execute_script("return [...document.querySelectorAll('#points-table tbody tr')].map(row => row.cells[7].textContent)")
        seconds = [float(text.split()[0]) * {"s": 1, "ms": 1e-3}[text.split()[1]] for text in times]
        assert len(seconds) > 5 and seconds == sorted(seconds, reverse=down)


def test_the_view_draws_turns_and_plays(browser: Any, tmp_path: Path) -> None:
    opened(browser, tmp_path, [sampled(strain_sweep())])
    if find(browser, "#motion-labels")[0].text.startswith("This browser draws no"):
        pytest.skip("no WebGL here")
    view = find(browser, "#motion-view")[0]
    browser.execute_script("arguments[0].scrollIntoView()", view)
    first = view.screenshot_as_base64
    browser.execute_script("arguments[0].focus()", view)
    view.send_keys("\ue012" * 5)  # left
    turned = view.screenshot_as_base64
    assert turned != first
    browser.execute_script("const s = document.getElementById('motion-time'); s.value = 2; s.dispatchEvent(new Event('input'))")
    assert find(browser, "#motion-clock")[0].text == "0.20 s"
    assert complaints(browser) == []


@pytest.mark.parametrize("width", [360, 1200])
def test_no_part_is_wider_than_the_page(browser: Any, tmp_path: Path, width: int) -> None:
    browser.set_window_size(max(width, 500), 900)
    opened(browser, tmp_path, [sampled(strain_sweep()), stability()])
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 800, "deviceScaleFactor": 1, "mobile": width < 500})
    wide = browser.execute_script("""return [...document.querySelectorAll('main *')].filter(e => !e.closest('.wide') && !e.closest('svg')
        && e.getBoundingClientRect().right > document.documentElement.clientWidth + 1).map(e => e.outerHTML.slice(0, 80))""")
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert wide == []


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_names_run_nothing(browser: Any, tmp_path: Path, kind: str) -> None:
    made = renamed(sampled(strain_sweep()), HOSTILE[kind])
    opened(browser, tmp_path, [made])
    assert complaints(browser) == []
    assert find(browser, "main script, main b") == []
    assert re.search("Who is fastest", find(browser, "h2")[1].text)
