#!/usr/bin/env bash
# Terminal, page of results, report and figures agree, in the same words, on a committed result.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"

result=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../../results/paper-strain-chain.json
bench show "$result" >terminal.txt || fail "show"
bench show "$result" --json >analysis.json || fail "show --json"
bench results "$result" >page.md || fail "results"
bench report "$result" --out report.html >/dev/null || fail "report"
bench plot "$result" --out figures >/dev/null || fail "plot"

holds '
import html, re
from pathlib import Path
sentence = read("analysis.json")["findings"][0]["sentences"][0]
assert "is the fastest" in sentence, sentence
# The words of a picture stand in its comments, a line each.
told = {str(path): " ".join(re.findall(r"<!-- (.*?) -->", path.read_text())) for path in Path("figures").glob("*.svg")}
assert any("figure4a" in name for name in told) and any("plane" in name for name in told), sorted(told)
told.update((name, html.unescape(Path(name).read_text())) for name in ("terminal.txt", "page.md", "report.html"))
silent = [name for name, text in told.items() if sentence not in " ".join(text.split())]
assert not silent, f"{silent} do not say: {sentence}"'

finish
