#!/usr/bin/env bash
# Terminal, page of results, report and figures agree, in the same words, on a committed result.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"

result=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../../results/paper-strain-chain.json
bench show "$result" >terminal.txt || fail "show"
bench show "$result" --json >analysis.json || fail "show --json"
bench results "$result" >page.md || fail "results"
bench report "$result" --out report.html >/dev/null || fail "report"
bench plot "$result" --out figures >/dev/null || fail "plot"

/usr/bin/python3 - <<'PYTHON' || fail "the printers differ"
import html, json, re
from pathlib import Path
finding, = json.load(open("analysis.json"))["findings"]
sentence = finding["sentences"][0]
assert "is the fastest" in sentence, sentence

def flat(text):
    return " ".join(text.split())

# The words of a picture stand in its comments, a line each.
drawn = {path.name: flat(" ".join(re.findall(r"<!-- (.*?) -->", path.read_text()))) for path in Path("figures").glob("*.svg")}
told = {"terminal": flat(Path("terminal.txt").read_text()), "page": flat(Path("page.md").read_text()),
        "report": flat(html.unescape(Path("report.html").read_text())), **drawn}
assert any("figure4a" in name for name in drawn) and any("plane" in name for name in drawn), sorted(drawn)
silent = [name for name, text in told.items() if sentence not in text]
assert not silent, f"{silent} do not say: {sentence}"
PYTHON

finish
