#!/usr/bin/env bash
# Every verb that writes, against a process killed and a disk that is full at the n-th change of a file, for every n (of long runs,
# every few): what was there before is there whole, or the new one is; the exit code says so; the same command, given once more,
# succeeds; and no process and no temporary file is left after it.
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/functions.sh"
((SANITIZED)) && { echo "sanitizers must be loaded first"; exit 77; }

bench --sweep strain --scene chain --n 5 --limit 0.1 --solver shake,jacobi --reps 1 --no-plots --out given.json >/dev/null 2>&1 ||
  fail "no result to begin with"

# whole FILE: it is complete according to its format.
whole() {
  case $1 in
    *.json) /usr/bin/python3 -c 'import json, sys; sys.exit(not json.load(open(sys.argv[1])).get("complete", True))' "$1" ;;
    *.png) tail -c 8 "$1" | grep -q IEND ;;
    *.html) tail -n 1 "$1" | grep -q '</html>' ;;
    *) cmp -s "$1" "undisturbed.${1##*.}" ;;
  esac
}

# a_process_is_left WORD: of this test; other tests may run the same program.
a_process_is_left() {
  local pid
  for pid in $(pgrep -f -- "$BENCH_BINARY $1"); do [[ ! /proc/$pid/cwd -ef . ]] || return 0; done
  return 1
}

# strike FAULT N: runs the verb's words with the fault at change N; false if there was none so late.
strike() {
  rm -f struck
  for output in "${outputs[@]}"; do echo old >"$output"; done
  LD_PRELOAD=$FILE_FAULTS FAULT=$1 FAULT_AT=$2 FAULT_MARK=$PWD/struck bench "${words[@]}" >out.txt 2>err.txt
  code=$?
  [[ -e struck ]]
}

# A short run of each verb, whose output is old.*
while read -ra words <&3; do
  verb=${words[*]::2}
  outputs=()
  for word in "${words[@]}"; do [[ $word == old.* ]] && outputs+=("$word"); done
  bench "${words[@]}" >out.txt 2>err.txt || { fail "$verb: $(tail -1 err.txt)"; continue; }
  for output in "${outputs[@]}"; do mv "$output" "undisturbed.${output##*.}"; done
  for fault in kill full; do
    for ((n = 1; ; n += 1 + n / 4)); do
      strike $fault $n || break
      case $fault:$code in kill:0 | kill:1 | kill:137 | full:0 | full:1) ;; *) fail "$verb, $fault at change $n: exit $code, $(tail -1 err.txt)" ;; esac
      for output in "${outputs[@]}"; do
        [[ $code != 0 && $(head -c 4 "$output") == old ]] || whole "$output" ||
          fail "$verb, $fault at change $n, exit $code: $output is neither the old nor the new one"
      done
      for ((i = 0; i < 20; ++i)); do a_process_is_left "${words[0]}" && sleep 0.1 || break; done
      ((i < 20)) || fail "$verb, $fault at change $n: a process is left"
    done
    ((n > 1)) || fail "$verb, $fault: nothing was struck"
  done
  bench "${words[@]}" >out.txt 2>err.txt || fail "$verb once more: exit $?, $(tail -1 err.txt)"
  [[ -z $(compgen -G 'old.*.new-*') ]] || fail "$verb: left $(echo old.*.new-*)"
  rm -f old.*
done 3<<'TABLE'
--sweep strain --scene chain --n 5 --limit 0.1 --solver shake --reps 1 --no-plots --untimed --force --out old.json
--sweep stability --case Q1$ --solver shake,icd --no-plots --force --out old.json
answers --answer catenary_place --solver shake --no-plots --force --out old.json
baseline given.json --out old.json
results given.json --out old.md
film --scene chain --set n=5 --set duration=0.1 --width 16 --out old.png
report given.json --out old.html
TABLE
finish
