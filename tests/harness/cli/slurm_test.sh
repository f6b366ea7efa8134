#!/usr/bin/env bash
# What bench emit slurm writes, under a Slurm of our own on this machine: one node, which shards have to themselves one after
# the other. Shards that run out of time, are killed or cancelled, or lose their node.
rm -rf -- ./*  # of the last time
set -u
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
PATH+=:/usr/sbin
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

skip() {
  echo "skipped: $*"
  exit 77
}

for program in munged slurmctld slurmd sbatch; do
  command -v $program >/dev/null || skip "$program is missing (Debian: slurm-wlm munge)"
done

# ---- A cluster of one node ----

# Not in the build folder: the name of a socket must be short. munged insists on a folder that others can pass.
cluster=$(mktemp -d) && chmod 755 "$cluster" || exit 1
export SLURM_CONF=$cluster/slurm.conf
daemons=()  # but slurmd, which dies in between
slurmd=

# Programs that were started by a job of ours, by their spool folder, with the slurmstepd above them.
job_processes() {
  local process
  for process in /proc/[0-9]*; do
    if tr '\0' ' ' <"$process/cmdline" | grep -qF "$cluster/spool/job"; then
      echo "${process#/proc/}"
      parent_step "${process#/proc/}"
    fi
  done 2>/dev/null
}

parent() { sed -n 's/^PPid:\s*//p' "/proc/$1/status"; }

parent_step() {
  local above
  above=$(parent "$1")
  [[ $(<"/proc/$above/comm") == slurmstepd ]] && echo "$above"
}

cleanup() {
  local left
  scancel --user="$(id -un)" 2>/dev/null
  for _ in {1..20}; do
    [[ -z $(job_processes) ]] && break
    sleep 0.1
  done
  left=$(job_processes)
  [[ -z $left ]] || kill -KILL $left 2>/dev/null
  kill $slurmd "${daemons[@]}" 2>/dev/null
  wait
  rm -rf "$cluster"
}
trap cleanup EXIT
trap 'exit 1' INT TERM

free_port() {
  local port
  until port=$((20000 + RANDOM)) && ! (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do :; done
  echo $port
}

start_slurmd() {
  slurmd -D >>"$cluster/slurmd.out" 2>&1 &
  slurmd=$!
}

node=${HOSTNAME%%.*}
hardware=$(slurmd -C | sed -n 's/^NodeName=[^ ]* //p')
mkdir "$cluster/state" "$cluster/spool"
# No cgroups and no services, so that this works in a container. cred_expire: a job that was put back into the queue waits
# that long (usually two minutes).
cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=$node(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
AuthType=auth/munge
AuthInfo=socket=$cluster/munge.socket,cred_expire=5
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
KillWait=5
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=1,sched_interval=1,bf_interval=1
SlurmdParameters=config_overrides
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.pid
NodeName=$node NodeAddr=127.0.0.1 $hardware State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
(umask 077 && head -c 1024 /dev/urandom >"$cluster/munge.key")
munged --foreground --force --socket="$cluster/munge.socket" --key-file="$cluster/munge.key" --pid-file="$cluster/munged.pid" \
  --seed-file="$cluster/munge.seed" --log-file="$cluster/munged.log" >"$cluster/munged.out" 2>&1 &
daemons+=($!)
for _ in {1..50}; do
  [[ -S $cluster/munge.socket ]] && break
  sleep 0.1
done
slurmctld -D >"$cluster/slurmctld.out" 2>&1 &
daemons+=($!)
start_slurmd
begin=$SECONDS
until [[ $(sinfo --noheader --format=%T 2>/dev/null) == idle ]]; do
  if ((SECONDS - begin >= 20)); then
    tail -n 3 "$cluster"/*.out
    skip "Slurm's daemons do not come up here (user $(id -un)), see above"
  fi
  sleep 0.2
done

# ---- What the tests do ----

rm -rf files && mkdir files && cd files || exit 1
ln -s "$here/stand_in_bench.sh" bench
export POINTS=20

# within SECONDS COMMAND...: until the command is true.
within() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < end)) || { fail "waited in vain: $*: $(squeue --format='%i %T %r')"; return 1; }
    sleep 0.1
  done
}

queue_empty() { [[ -z $(squeue --noheader) ]]; }

# half_way SHARD OF: some points are there, in a turn that is under way.
half_way() {
  local part=result-shards/shard-$1-of-$2.json.part
  [[ -e $part ]] && (($(wc -l <"$part") >= 4))
}

# emit SHARDS: job.sh
emit() {
  rm -rf calls* result*
  "$BENCH_BINARY" emit slurm --shards "$1" --sweep resolution --profile quick --scene chain --out result.json >job.sh ||
    fail "emit slurm"
}

submit() {
  bash job.sh >submitted.txt || fail "submission"
  array=$(sed -nE 's/.*shards: job ([0-9]+).*/\1/p' submitted.txt)
  merging=$(sed -nE 's/.*: job ([0-9]+)$/\1/p' submitted.txt)
}

# property JOB NAME
property() { scontrol --oneliner show job "$1" | grep -oP "\\b$2=\\K\\S+"; }

# merged SHARDS: the merge was the last of all, and every point is there once.
merged() {
  [[ $(tail -n 1 calls.txt) == merge ]] || fail "the merge was not last: $(cat calls.txt)"
  [[ $(sort result.json | uniq | wc -l) == $(($1 * POINTS)) && $(wc -l <result.json) == $(($1 * POINTS)) ]] ||
    fail "the merged result: $(cat result.json)"
}

# went_on SHARD: its second start found points there.
went_on() {
  [[ $(grep -c "^$1 at 0 threads 1 1$" calls.txt) == 1 ]] && grep -qE "^$1 at ([4-9]|1[0-9]) threads 1 1$" calls.txt ||
    fail "shard $1 did not go on where it was: $(cat calls.txt)"
}

# ---- All shards; the time of one is nearly up, which Slurm tells by USR1 to the script ----

emit 3
submit
within 20 half_way 1 3 && scancel --batch --signal=USR1 "${array}_1"
within 40 queue_empty
went_on 1
grep -q '^1 interrupted$' calls.txt || fail "bench was not told that the time is up"
[[ $(property "${array}_1" Restarts) == 1 ]] || fail "shard 1 was not put back into the queue"
merged 3
all_cpus=$(grep -oP 'CPUTot=\K[0-9]+' <(scontrol show node "$node"))
last_end=""
for i in 2 3 1; do  # in the order they ran: shard 1 had to wait
  [[ $(property "${array}_$i" OverSubscribe) == NO && $(property "${array}_$i" NumCPUs) == "$all_cpus" ]] ||
    fail "shard $i had no node to itself"
  [[ ! $(property "${array}_$i" StartTime) < $last_end ]] || fail "shard $i ran beside another"
  last_end=$(property "${array}_$i" EndTime)
done
[[ ! $(property "${merging}_0" StartTime) < $last_end ]] || fail "the merge ran before the last shard"
[[ -e result-shards/shard-2.log && -e result-shards/merge.log ]] || fail "no logs: $(ls result-shards)"

# ---- One shard killed, one cancelled: no merge; submitted again, both go on ----

emit 3
submit
within 20 half_way 1 3 && kill -KILL "$(<pid.1)"
within 20 half_way 2 3 && scancel "${array}_2"
within 20 queue_empty
[[ $(property "${array}_1" JobState) == FAILED && $(property "${array}_2" JobState) == CANCELLED ]] ||
  fail "states: $(property "${array}_1" JobState), $(property "${array}_2" JobState)"
[[ ! -e result.json ]] || fail "merged without all shards"
grep -q '^2 interrupted$' calls.txt || fail "a cancelled bench had no time to write what it has"
submit
within 30 queue_empty
went_on 1
went_on 2
grep -q '^3 complete$' calls.txt || fail "shard 3 was run again: $(cat calls.txt)"
merged 3

# ---- The node is lost ----

emit 1
submit
if within 20 half_way 1 1; then
  bench=$(<pid.1)
  script=$(parent "$bench")
  step=$(parent_step "$script")
  { kill -KILL "$slurmd" "$step" "$script" "$bench" && wait "$slurmd"; } 2>/dev/null
  scontrol update NodeName="$node" State=DOWN Reason=lost  # as slurmctld itself does after SlurmdTimeout
  start_slurmd
  scontrol update NodeName="$node" State=RESUME
fi
within 40 queue_empty
went_on 1
merged 1

# ---- The program itself ----

if "$BENCH_BINARY" --help | grep -qE -- '--shard( |$)'; then
  ln -sf "$BENCH_BINARY" bench
  "$BENCH_BINARY" emit slurm --shards 3 --sweep resolution --profile quick --scene chain --solver fast_projection --reps 1 \
    --out real.json >job.sh || fail "emit slurm"
  submit
  within 40 queue_empty
  /usr/bin/python3 - <<'PYTHON' || fail "the merged result: $(cat real-shards/*.log)"
import json
document = json.load(open("real.json"))
assert document["complete"]
assert {p["id"].split("/")[2] for p in document["points"]} == {"n:20", "n:40", "n:80"}
PYTHON
else
  echo "this bench has no --shard yet: only the stand-in was run"
fi

((failures == 0)) && echo "all well"
exit $((failures > 0))
