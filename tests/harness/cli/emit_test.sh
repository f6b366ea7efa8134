#!/usr/bin/env bash
# bench emit: refusals before anything is printed, options that arrive as they were typed, and both outputs run.
rm -rf -- ./*  # of the last time
set -u
failures=0

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

sweep=(--sweep resolution --profile quick --scene chain)  # three sizes
refused "scheduler is required" --shards 2 "${sweep[@]}"
refused "did you mean 'slurm'" slrum --shards 2 "${sweep[@]}"
refused "--shards is required" slurm "${sweep[@]}"
refused "--shards" slurm --shards 0 "${sweep[@]}"
refused "3 scenes and sizes to share out" slurm --shards 4 "${sweep[@]}"
refused "no sweep" slurm --shards 2
refused "has no script" slurm --shards 2 --sweep stability
refused "did you mean 'fast_projection'" slurm --shards 2 "${sweep[@]}" --solver fast_projectoin
refused "no point is left" slurm --shards 2 "${sweep[@]}" --filter nothing
refused "cannot read the suite" slurm --shards 2 --sweep strain --config missing.json
refused "control characters" parallel --shards 2 "${sweep[@]}" --filter $'chain|\nrm x'

# Words as bench gets them, one a line; $PWD/bench stands in for it.
printf '%s\n' '#!/usr/bin/env bash' 'printf "%s\n" "$@"' >bench
chmod +x bench
hostile=$'a|b $(touch pwned) `touch pwned` a{1} [{}] \' " \\\\ ; # * ~'
given=("${sweep[@]}" --filter "$hostile" --exclude=-x --seed 7 --timeout 0.30 --out "it's \$HOME.json")
printf '%s\n' --sweep=resolution --scene=chain --profile=quick "--filter=$hostile" --exclude=-x --timeout=0.30 --seed=7 \
  --no-plots --resume --shard 2/3 --out "it's \$HOME-shard-2-of-3.json" >expected.txt
"$BENCH_BINARY" emit parallel --shards 3 "${given[@]}" >list.txt || fail "emit parallel"
sed -n 3p list.txt | bash | diff expected.txt - || fail "options changed in the list"
"$BENCH_BINARY" emit slurm --shards 3 "${given[@]}" >job.sh || fail "emit slurm"
SLURM_ARRAY_TASK_ID=2 bash job.sh | diff expected.txt - || fail "options changed in the script"
[[ ! -e pwned ]] || fail "a regular expression was run"
grep -qx '#SBATCH --array=1-3' job.sh || fail "no array: $(cat job.sh)"
! command -v shellcheck >/dev/null || shellcheck -e SC2016 job.sh || fail "shellcheck"

# The program itself: shards 1 and 2 from the list, 3 from the script; together they are the whole sweep, and are not run twice.
ln -sf "$BENCH_BINARY" bench
run=("${sweep[@]}" --solver fast_projection --reps 1 --out real.json)
"$BENCH_BINARY" emit slurm --shards 3 "${run[@]}" >job.sh
"$BENCH_BINARY" emit parallel --shards 3 "${run[@]}" >list.txt
for time in first again; do
  sed -n 2,3p list.txt | bash >output.txt 2>&1 || fail "the list, $time: $(cat output.txt)"
  SLURM_ARRAY_TASK_ID=3 bash job.sh >output.txt 2>&1 || fail "the script, $time: $(cat output.txt)"
  [[ $time == again ]] || sha256sum real-shard-*-of-3.json >sums.txt
done
sha256sum --quiet -c sums.txt || fail "finished shards were run again"
merge=$(sed -n 's/.*then: //p' list.txt)
bash -c "$merge" >output.txt || fail "$merge"
grep -qF -- "# $merge" job.sh || fail "the script says another merge"
/usr/bin/python3 - <<'PYTHON' || fail "the merged result"
import json
document = json.load(open("real.json"))
assert document["complete"]
assert {p["id"].split("/")[2] for p in document["points"]} == {"n:20", "n:40", "n:80"}, [p["id"] for p in document["points"]]
PYTHON

((failures == 0)) && echo "all well"
exit $((failures > 0))
