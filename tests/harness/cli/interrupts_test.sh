#!/usr/bin/env bash
# Every verb that computes answers Ctrl-C, SIGTERM and SIGHUP within a second, even inside a step that never ends: exit code 130, a file
# that was there stays as it was, and no process and no temporary file is left.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"

plugin=$BUILD_FOLDER/tests/libplugin_hangs.so
export TMPDIR=$PWD/tmp

mkdir tmp
bench --sweep strain --scene chain --n 5 --limit 0.1 --solver shake --reps 1 --no-plots --out small.json >/dev/null 2>&1
/usr/bin/python3 -c '
import json
print(json.dumps({**json.load(open("small.json"))["points"][0], "solver": "misfit", "contestant": "misfit", "settings": {}}))' >point.txt

# Each verb with the words that make it compute with the solver that hangs; its output is old.*
while read -ra words <&3; do
  verb=${words[*]::2}
  for signal in INT TERM HUP; do
    echo old >old.json
    echo old >old.png
    "$BENCH_BINARY" --plugin "$plugin" "${words[@]}" <point.txt >out.txt 2>err.txt &
    pid=$!
    sleep 1
    kill -0 $pid 2>/dev/null || { fail "$verb ended by itself: $(tail -1 err.txt)"; continue; }
    begin=$(date +%s%N)
    kill -s $signal $pid
    wait $pid
    code=$?
    took=$((($(date +%s%N) - begin) / 1000000))
    ((code == 130)) || fail "$verb, SIG$signal: exit $code, $(tail -1 err.txt)"
    ((took < 1000)) || ((SANITIZED)) || fail "$verb, SIG$signal: took $took ms"
    [[ $verb != choose* || ! -s out.txt ]] || fail "$verb, SIG$signal: an answer, $(cat out.txt)"
    [[ $(cat old.png) == old ]] || fail "$verb, SIG$signal: the old picture is gone"
    pgrep -f -- "$plugin" >/dev/null && fail "$verb, SIG$signal: a process is left" && pkill -9 -f -- "$plugin"
    [[ -z $(find tmp . -maxdepth 1 -name 'bench-*' -o -maxdepth 1 -name 'old.*.new-*') ]] || fail "$verb, SIG$signal: $(ls tmp .)"
  done
done 3<<'TABLE'
film --scene chain --set n=5 --solver misfit --out old.png
point
choose --scene chain --n 5 --solver misfit --no-wait
check --solver misfit
--sweep strain --scene chain --n 5 --limit 0.1 --solver misfit --no-plots --no-wait --force --out old.json
--sweep stability --solver misfit --no-plots --force --out old.json
answers --solver misfit --no-plots --force --out old.json
TABLE
finish
