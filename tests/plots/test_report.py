"""The report: what is computed for it, and the page in a browser (Debian: chromium-driver, python3-selenium; skipped without)."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, Iterator

import pytest

import report
from documents import ROOT, Json, analysed, resolution_sweep, stability, strain_sweep
from report import embedded, repeat_command, script_text
from test_figures import HOSTILE, renamed

FOUND = [{"scene": "chain", "sweep": "step", "vertices": 80, "subject": "chain of 80 vertices", "sentences": ["A is first."]},
         {"scene": "drape", "sweep": "strain", "vertices": 441, "subject": "drape of 441 vertices", "sentences": ["B is first."]},
         {"scene": "drape", "sweep": "strain", "vertices": 961, "subject": "drape of 961 vertices", "sentences": ["C is first.", "D."]}]


def test_findings_are_the_programs_and_the_largest_drape_comes_first() -> None:
    assert re.findall(r"[A-D] is first\.|D\.", report.findings(FOUND)) == ["C is first.", "D.", "B is first.", "A is first."]


def test_the_data_are_those_of_the_points() -> None:
    result = analysed(strain_sweep())
    data = embedded({Path("it.json"): result}, [{"files": [0]}])
    rows = [dict(zip(data["columns"], row)) for row in data["points"]]
    assert [(row["id"], row["solver"]) for row in rows] == [(made["id"], made["solver"]) for made in result.points]
    assert all(row["seconds"] is None or row["seconds"] <= row["high"] for row in rows)
    assert repeat_command(result) == "./bench --sweep strain --reps 9"


def test_data_end_no_script() -> None:
    text = script_text({"name": "</script><script>alert(1)</script>&<!--"})
    assert "<" not in text and ">" not in text
    assert json.loads(text)["name"].startswith("</script>")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    webdriver = pytest.importorskip("selenium.webdriver")
    from selenium.webdriver.chrome.service import Service
    driver = shutil.which("chromedriver")
    if not driver:
        pytest.skip("chromedriver is not installed")
    options = webdriver.ChromeOptions()
    for option in ("--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1200,900"):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    made = webdriver.Chrome(service=Service(driver), options=options)
    yield made
    made.quit()


def opened(browser: Any, folder: Path, documents: list[Json]) -> None:
    claims = [{"id": "C1", "statement": "<b>fast</b>", "verdict": "reproduced", "measured": "twice", "rule": "is above 1"}]
    results = [{"name": f"it{number}.json", "document": made} for number, made in enumerate(documents)]
    sweeps = [{"files": [number], "document": analysed(made).document} for number, made in enumerate(documents)]
    (folder / "report.json").write_text(json.dumps({"results": results, "sweeps": sweeps, "findings": FOUND, "claims": claims}))
    ran = subprocess.run([sys.executable, ROOT / "plots/report.py", folder / "report.json", "--out", folder / "report.html"],
                         capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    browser.get((folder / "report.html").as_uri())


@pytest.fixture
def page(browser: Any, tmp_path: Path) -> Any:
    """The page of one sweep. No test may cause complaints in the browser's log."""
    opened(browser, tmp_path, [strain_sweep()])
    yield browser
    assert complaints(browser) == []


def find(browser: Any, selector: str) -> list[Any]:
    return browser.find_elements("css selector", selector)


def complaints(browser: Any) -> list[str]:
    return [entry["message"] for entry in browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]


def test_every_part_is_there_and_nothing_complains(browser: Any, tmp_path: Path) -> None:
    opened(browser, tmp_path, [strain_sweep(), resolution_sweep(), stability()])
    assert complaints(browser) == []
    for name in ("findings", "points", "figures", "claims", "machine"):
        assert len(find(browser, f"section#{name}")) == 1, name
    assert find(browser, "p.answer")[0].text == "Drape of 961 vertices, over strain: C is first. D."
    pictures = find(browser, "figure img")
    assert len(pictures) >= 3
    browser.execute_script("for (const part of document.querySelectorAll('details')) part.open = true")
    for image in pictures:
        browser.execute_script("arguments[0].scrollIntoView()", image)
        browser.execute_async_script("arguments[0].decode().then(arguments[1], arguments[1])", image)
        assert image.get_property("naturalWidth") > 100
    for link in find(browser, "figcaption a"):
        assert link.get_attribute("href").startswith("blob:")


def test_ranks_follow_when_a_solver_is_hidden_and_tell_the_command_of_a_point(page: Any) -> None:
    def ranks() -> list[str]:
        return [row.text for row in find(page, "#points-table tbody td:first-child")]

    assert ranks()[:2] == ["fast projection", "SHAKE"]
    story = find(page, "#points-table tbody tr")[0].get_attribute("title")
    assert "chain/" in story and "9 runs" in story
    find(page, "#points-table tbody button")[0].click()
    page.execute_async_script("setTimeout(arguments[0], 200)")  # the clipboard answers later
    assert "./bench --sweep strain --reps 9 --filter '^chain/" in find(page, "#points-command")[0].text
    find(page, "#points-solvers input")[[label.text for label in find(page, "#points-solvers label")].index("fast projection")].click()
    assert ranks()[0] == "SHAKE" and "fast projection" not in ranks()


def test_the_table_filters_and_sorts(page: Any) -> None:
    find(page, "#points-filter")[0].send_keys("jacobi diverged")  # which no contest has
    assert find(page, "#points-table tbody tr") == []
    find(page, "#points-everywhere")[0].click()
    rows = find(page, "#points-table tbody tr")
    assert len(rows) == 1 and "diverged" in rows[0].text
    find(page, "#points-filter")[0].clear()
    find(page, "#points-filter")[0].send_keys("ok")
    for down in (True, False):  # it is sorted by time, upwards, from the start
        find(page, "#points-table th button")[7].click()
        times = page.execute_script("return [...document.querySelectorAll('#points-table tbody tr')].map(row => row.cells[7].textContent)")
        seconds = [float(text.split()[0]) * {"s": 1, "ms": 1e-3}[text.split()[1]] for text in times]
        assert len(seconds) > 5 and seconds == sorted(seconds, reverse=down)


def test_a_telephone_shows_it_without_scrolling_sideways(page: Any) -> None:
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 390, "height": 800, "deviceScaleFactor": 1, "mobile": True})
    try:
        assert page.execute_script("return document.documentElement.scrollWidth") <= 390
    finally:
        page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_names_run_nothing(browser: Any, tmp_path: Path, kind: str) -> None:
    opened(browser, tmp_path, [renamed(strain_sweep(), HOSTILE[kind])])
    assert complaints(browser) == []
    assert find(browser, "main script, main b") == []
    assert find(browser, "h2")[1].text == "Who is fastest"
