#!/usr/bin/env bash
# bench emit: scripts that Bash takes, options that arrive as they were typed, refusals before anything is written; and the
# script for GNU parallel, run.
rm -rf -- ./*  # of the last time
set -u
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
failures=0
codes=

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# refused PART ARGUMENTS...: exit 2, one line on stderr that contains PART, nothing on stdout.
refused() {
  local part=$1 code lines
  shift
  "$BENCH_BINARY" emit "$@" >stdout.txt 2>stderr.txt </dev/null
  code=$?
  lines=$(wc -l <stderr.txt)
  [[ $code == 2 && $lines == 1 && ! -s stdout.txt ]] && grep -qF -- "$part" stderr.txt ||
    fail "emit $* -> exit $code, $lines lines: $(cat stderr.txt)"
}

rm -rf files && mkdir files && cd files || exit 1
# Three sizes.
sweep=(--sweep resolution --profile quick --scene chain)
refused "scheduler is required" --shards 2 "${sweep[@]}"
refused "did you mean 'slurm'" slrum --shards 2 "${sweep[@]}"
refused "--shards is required" slurm "${sweep[@]}"
refused "--shards" slurm --shards 0 "${sweep[@]}"
refused "3 scenes and sizes to share out" slurm --shards 4 "${sweep[@]}"
refused "did you mean 'strain'" slurm --shards 2 --sweep strian
refused "no sweep" slurm --shards 2
refused "has no job script" slurm --shards 2 --sweep stability
refused "did you mean 'fast_projection'" slurm --shards 2 "${sweep[@]}" --solver fast_projectoin
refused "did you mean 'quick'" parallel --shards 2 --sweep strain --profile quik
refused "did you mean 'adaptive'" slurm --shards 2 "${sweep[@]}" --steps adaptiv
refused "no point is left" slurm --shards 2 "${sweep[@]}" --filter nothing
refused "not a regular expression" slurm --shards 2 "${sweep[@]}" --filter '('
refused "cannot read the suite" slurm --shards 2 --sweep strain --config missing.json
refused "--reps" slurm --shards 2 "${sweep[@]}" --reps 0
echo '{"sweeps": [{"sweep": "strain", "scene": "chain", "limits": [0.1], "scene_parameters": {"n": 7}}]}' >suite.json
refused "--finest-error needs references" slurm --shards 1 --sweep strain --finest-error 0.02 --config suite.json
refused "will not be there" slurm --shards 1 --sweep strain --config <(cat suite.json)
refused "--jobs goes with emit parallel" slurm --shards 2 "${sweep[@]}" --jobs 2
refused "go with emit slurm" parallel --shards 2 "${sweep[@]}" --time 01:00:00
refused "must be HH:MM:SS" slurm --shards 2 "${sweep[@]}" --time 'soon
#SBATCH --uid=0'
refused "must be a partition's name" slurm --shards 2 "${sweep[@]}" --partition 'a b'
refused "must be an account's name" slurm --shards 2 "${sweep[@]}" --account '"'
refused "must be a size such as 4G" parallel --shards 2 "${sweep[@]}" --memory 4
refused "without %" slurm --shards 2 "${sweep[@]}" --out 'results/%a.json'
refused "is a folder" slurm --shards 2 "${sweep[@]}" --out .
[[ $(find . -type f | sort | tr '\n' ' ') == './stderr.txt ./stdout.txt ./suite.json ' ]] || fail "a refusal left files: $(find .)"

# What only one of the two knows, and what stays out unless it was asked for.
"$BENCH_BINARY" emit slurm --shards 3 "${sweep[@]}" --time 01:30:00 --partition long --account cloth --memory 4G >job.sh ||
  fail "emit slurm"
for line in --array=1-3 --exclusive --requeue --time=01:30:00 --partition=long --account=cloth --mem=4G; do
  grep -qx -- "#SBATCH $line" job.sh || fail "no line #SBATCH $line"
done
grep -q '^sweep=(.* --memory=4G)$' job.sh || fail "points of a shard may have more memory than it reserves"
grep -q '^result=results/local/quick-resolution.json$' job.sh || fail "the default result is not relative"
"$BENCH_BINARY" emit slurm --shards 3 "${sweep[@]}" >job.sh
grep -E '^#SBATCH --(time|partition|account|mem)' job.sh && fail "demands that nobody made"
for scheduler in slurm parallel; do
  "$BENCH_BINARY" emit $scheduler --shards 3 "${sweep[@]}" --out 'a folder/result.json' >job.sh || fail "emit $scheduler"
  bash -n job.sh || fail "$scheduler: not Bash"
  ! command -v shellcheck >/dev/null || shellcheck job.sh || fail "$scheduler: shellcheck"
  grep -n "$PWD\|$here" job.sh && fail "$scheduler: a path of this machine"
done
# Away from the program a script says so instead of starting anything.
bash job.sh >stdout.txt 2>stderr.txt
[[ $? == 2 ]] && grep -q 'there is no ./bench here' stderr.txt || fail "started without ./bench: $(cat stderr.txt)"

# A shard of the Slurm script, with Slurm's part played: when the time is nearly up it asks for another turn, but not for ever.
ln -sf "$here/stand_in_bench.sh" bench
mkdir fake
printf '%s\n' '#!/usr/bin/env bash' 'echo "$*" >>scontrol.txt' 'kill -KILL $PPID' >fake/scontrol
chmod +x fake/scontrol
"$BENCH_BINARY" emit slurm --shards 3 "${sweep[@]}" --out turns/result.json >job.sh
for turn in 19 20; do
  rm -f calls*
  PATH=$PWD/fake:$PATH POINTS=100 SLURM_ARRAY_JOB_ID=5 SLURM_ARRAY_TASK_ID=2 SLURM_RESTART_COUNT=$turn bash job.sh 2>/dev/null &
  script=$!
  for _ in {1..100}; do
    [[ -s calls.txt ]] && break
    sleep 0.1
  done
  sleep 0.3
  kill -USR1 $script
  wait $script 2>/dev/null
  codes+=" $?"
  [[ $(tail -n 1 calls.txt) == '2 interrupted' ]] || fail "turn $turn: $(cat calls.txt)"
done
[[ $codes == ' 137 130' && $(<scontrol.txt) == 'requeue 5_2' ]] || fail "turns end with $codes: $(cat scontrol.txt)"

# Every option reaches bench as it was typed: here by way of a single shard, which needs no batch system.
rm -f calls*
export POINTS=1
hostile=$'a|b $(touch pwned) `touch pwned` a{1} [{}] \' " \\\\ ; @N@ # * ~'
"$BENCH_BINARY" emit parallel --shards 3 "${sweep[@]}" --filter "$hostile" --exclude=-x --seed 7 --timeout 0.30 --reps 2 \
  --out "it's \$HOME; @SWEEP@.json" >job.sh || fail "hostile options"
bash job.sh 2 || fail "one shard"
printf '%s\n' --sweep=resolution --scene=chain --profile=quick "--filter=$hostile" --exclude=-x --reps=2 --timeout=0.30 --seed=7 \
  --no-plots --shard 2/3 --resume --out "it's \$HOME; @SWEEP@-shards/shard-2-of-3.json" | diff - calls.2 || fail "options changed"
[[ ! -e pwned ]] || fail "a regular expression was run"

if ! [[ $(parallel --version 2>&1) == GNU* ]]; then
  ((failures == 0)) || exit 1
  echo "skipped: GNU parallel is missing (Debian: parallel); all before it went well"
  exit 77
fi

# All shards and the merge; then again, with nothing left to do.
rm -f calls*
bash job.sh >parallel.txt 2>&1 || fail "the script for GNU parallel: $(cat parallel.txt)"
[[ $(sort calls.txt | tr '\n' ';') == '1 at 0 threads 1 1;2 complete;3 at 0 threads 1 1;merge;' ]] || fail "calls: $(cat calls.txt)"
[[ $(tail -1 calls.txt) == merge ]] || fail "the merge was not last"
[[ $(wc -l <"it's \$HOME; @SWEEP@.json") == 3 ]] || fail "the merged file"
diff <(printf '%s\n' "--filter=$hostile") <(grep -e --filter calls.3) || fail "options changed by GNU parallel"

# A shard that fails: the others are run, nothing is merged, the exit code tells; the next run does only what is missing.
"$BENCH_BINARY" emit parallel --shards 3 "${sweep[@]}" --jobs 2 --memory 1M --out two/result.json >job.sh
rm -f calls*
touch fail.2
bash job.sh >parallel.txt 2>&1 && fail "a failed shard goes unnoticed"
[[ $(sort calls.txt | cut -c1 | tr -d '\n') == 123 && ! -e two/result.json ]] || fail "after a failure: $(cat calls.txt)"
rm -f calls* fail.2
bash job.sh >parallel.txt 2>&1 || fail "the second run: $(cat parallel.txt)"
[[ $(sort calls.txt | tr '\n' ';') == '1 complete;2 at 0 threads 1 1;3 complete;merge;' && -s two/result.json ]] ||
  fail "the second run: $(cat calls.txt)"

# Ctrl-C: bench gets to write what it has, and goes on there.
"$BENCH_BINARY" emit parallel --shards 2 "${sweep[@]}" --out three/result.json >job.sh
rm -f calls*
export POINTS=30
# Background jobs of a script ignore SIGINT for good; Python gives it back, and a group of its own as a terminal has.
/usr/bin/python3 - <<'PYTHON' || fail "Ctrl-C: $(cat calls.txt)"
import os, signal, subprocess, time
signal.signal(signal.SIGINT, signal.default_int_handler)
run = subprocess.Popen(["bash", "job.sh"], start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
part = "three/result-shards/shard-1-of-2.json.part"
deadline = time.time() + 20
while not (os.path.exists(part) and open(part).read().count("\n") >= 3):
    assert time.time() < deadline
    time.sleep(0.05)
os.killpg(run.pid, signal.SIGINT)
assert run.wait(20) != 0
while "interrupted" not in open("calls.txt").read():
    assert time.time() < deadline
    time.sleep(0.05)
PYTHON
export POINTS=31
bash job.sh >parallel.txt 2>&1 || fail "after Ctrl-C: $(cat parallel.txt)"
grep -qE '^1 at ([3-9]|[12][0-9]) ' calls.txt && [[ -s three/result.json ]] || fail "after Ctrl-C: $(cat calls.txt)"

# The program itself: the shards' points together are those of the whole sweep.
if "$BENCH_BINARY" --help | grep -qE -- '--shard( |$)'; then
  ln -sf "$BENCH_BINARY" bench
  "$BENCH_BINARY" emit parallel --shards 3 "${sweep[@]}" --solver fast_projection --reps 1 --out real/result.json >job.sh
  for i in first again; do
    bash job.sh >parallel.txt 2>&1 || fail "a real sweep, $i: $(cat parallel.txt)"
  done
  /usr/bin/python3 - <<'PYTHON' || fail "the merged result"
import json
document = json.load(open("real/result.json"))
assert document["complete"]
points = document["points"]
assert {p["id"].split("/")[2] for p in points} == {"n:20", "n:40", "n:80"}, [p["id"] for p in points]
assert len(points) == len({p["id"] for p in points})
PYTHON
else
  echo "this bench has no --shard yet: only the stand-in was run"
fi

((failures == 0)) && echo "all well"
exit $((failures > 0))
