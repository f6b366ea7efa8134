#include "harness/run/job_script.h"

#include <algorithm>
#include <cctype>

#include "harness/base/errors.h"
#include "harness/base/pattern.h"

namespace harness {
namespace {

// The text with every name of `values` replaced, in one pass: what a value holds is left alone.
std::string fill(const std::string& text,
                 const std::vector<std::pair<std::string, std::string>>& values) {
  std::string filled;
  for (std::size_t at = 0; at < text.size();) {
    const auto found = std::find_if(values.begin(), values.end(), [&](const auto& value) {
      return text.compare(at, value.first.size(), value.first) == 0;
    });
    filled += found == values.end() ? text.substr(at, 1) : found->second;
    at += found == values.end() ? 1 : found->first.size();
  }
  return filled;
}

void check(const std::string& option, const std::string& value, const char* form,
           const std::string& meaning) {
  if (!value.empty() && !has_form(value, form))
    throw UsageError(option + " must be " + meaning);  // the value may have several lines
}

// What both scripts have in common: values first, so that a user finds them.
constexpr const char* common = R"bash(set -euo pipefail
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1  # what is measured has one thread

sweep=(@SWEEP@)
result=@RESULT@
shards=@SHARDS@

complain() {
  echo "$0: $*" >&2
  exit 2
}
[[ -x ./bench ]] || complain "there is no ./bench here: start this in the folder of bench"

run_shard() {  # becomes bench, so that signals reach it
  exec ./bench "${sweep[@]}" --no-plots --shard "$1/@N@" --resume --out "$shards/shard-$1-of-@N@.json"
}
# A shard that is missing is an error, so all are named.
merge() { ./bench merge "$shards"/shard-{1..@N@}-of-@N@.json --out "$result"; }
)bash";

constexpr const char* slurm = R"bash(#!/usr/bin/env bash
# A sweep in shards (here: @N@) under Slurm. In the folder of bench
#   bash THIS_FILE      submits the shards as one array, and the job that merges their results after the last of them;
#   sbatch THIS_FILE    submits the shards only.
# Submitted once more after a failure, finished shards end at once and interrupted ones go on where they were.
#
#SBATCH --job-name=bench-@AXIS@
#SBATCH --array=1-@N@
# A node to itself: neighbours would share memory bandwidth, cache and clock rate with what is measured. Where that is
# too dear, --hint=nomultithread instead of it reserves one whole core; times will scatter more.
#SBATCH --exclusive
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
# Times of unlike machines do not compare. If the partition has several kinds of nodes, choose one of them:
##SBATCH --constraint=KIND
# Back into the queue when pre-empted or when the node is lost; a word before the time is up (see the end).
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:USR1@60
@DEMANDS@@COMMON@
if [[ -z ${SLURM_ARRAY_TASK_ID:-} ]]; then
  [[ -f $0 ]] || complain "save this script to a file first"
  mkdir -p -- "$shards"
  array=$(sbatch --parsable --output="$shards/shard-%a.log" "$0")
  array=${array%%;*}  # a federation adds the cluster's name
  # The merge is number 0 of an array of its own: same file, same account and partition.
  merging=$(sbatch --parsable --array=0 --job-name=bench-merge --output="$shards/merge.log" \
    --dependency="afterok:$array" --kill-on-invalid-dep=yes "$0")
  echo "@N@ shards: job $array (logs in $shards); merge into $result: job ${merging%%;*}"
  exit
fi
if ((SLURM_ARRAY_TASK_ID == 0)); then
  merge
  exit
fi

# TERM (cancelled or pre-empted; in the latter case Slurm itself puts the shard back into the queue) and USR1 (the time
# is nearly up) both make bench write what it has and end.
run_shard "$SLURM_ARRAY_TASK_ID" &
bench=$!
out_of_time=false
trap 'again=true; kill -TERM "$bench" 2>/dev/null || true' TERM
trap 'again=true; out_of_time=true; kill -TERM "$bench" 2>/dev/null || true' USR1
again=true
while $again; do  # a signal ends `wait` before bench has ended
  again=false
  code=0
  wait "$bench" || code=$?
done
# A shard that is longer than the time limit goes on in its next turn; the number of turns is limited, because one that
# gets nowhere would go on for ever.
if $out_of_time && ((code != 0 && ${SLURM_RESTART_COUNT:-0} < 20)); then
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
  sleep 60  # until Slurm ends this turn
fi
exit "$code"
)bash";

constexpr const char* parallel = R"bash(#!/usr/bin/env bash
# A sweep in shards (here: @N@) under GNU parallel, then their merge. In the folder of bench
#   bash THIS_FILE           runs all of it; once more after a failure or Ctrl-C, it goes on where it was;
#   bash THIS_FILE NUMBER    runs one shard, on this machine or any other that shares the folder.
# Other machines of the same kind: PARALLEL="--sshlogin a,b --workdir ." bash THIS_FILE
#
@COMMON@
if (($#)); then
  run_shard "$1"
fi
[[ -f $0 ]] || complain "save this script to a file first"
[[ $(parallel --version 2>&1) == GNU* ]] || complain "needs GNU parallel (Debian: parallel)"
mkdir -p -- "$shards"
options=(
  # Shards at once on a machine. Neighbours share memory bandwidth, cache and clock rate: with more than one, times are
  # longer than alone and scatter. To measure, leave it at 1.
  --jobs @JOBS@@DEMANDS@
  # When interrupted, bench has a minute to write what it has.
  --termseq 'TERM,60000,KILL,25'
  # Times and exit codes. Which shards are done is bench's business (--resume), not this file's: a log knows nothing of
  # options that have changed since or of results that were removed.
  --joblog "$shards/jobs.log"
  --line-buffer --tagstring 'shard {}')
parallel "${options[@]}" --quote bash "$0" '{}' ::: {1..@N@}
merge
)bash";

std::string words_text(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

void check_common(const JobScript& job) {
  check("--memory", job.memory, "[1-9][0-9]*[KMGT]", "a size such as 4G");
  const auto unfit = [](unsigned char c) { return std::iscntrl(c) != 0 || c == '%' || c == '\\'; };
  // In the name of a log Slurm gives % and backslash a meaning of their own.
  if (job.result.empty() || job.result.back() == '/' || job.result.front() == '-' ||
      std::any_of(job.result.begin(), job.result.end(), unfit))
    throw UsageError("--out must be a file's name without %, backslash or control characters");
}

std::string script(const char* text, const JobScript& job, const std::string& demands) {
  const bool named = job.result.ends_with(".json");
  const std::string stem = named ? job.result.substr(0, job.result.size() - 5) : job.result;
  const std::string whole = fill(text, {{"@COMMON@", common}, {"@DEMANDS@", demands}});
  return fill(whole, {{"@N@", std::to_string(job.shards)},
                      {"@AXIS@", job.axis},
                      {"@JOBS@", std::to_string(job.jobs)},
                      {"@SWEEP@", words_text(job.sweep)},
                      {"@RESULT@", shell_word(job.result)},
                      {"@SHARDS@", shell_word(stem + "-shards")}});
}

}  // namespace

std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_./:=,@%+-").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string slurm_script(const JobScript& job) {
  check_common(job);
  check("--time", job.time, "([0-9]+-)?[0-9]{1,3}:[0-5][0-9]:[0-5][0-9]", "HH:MM:SS");
  const char* name = "[A-Za-z0-9_][A-Za-z0-9_.,+-]*";
  check("--partition", job.partition, name, "a partition's name");
  check("--account", job.account, name, "an account's name");
  std::string demands;
  const auto demand = [&](const char* option, const std::string& value) {
    if (!value.empty()) demands += std::string("#SBATCH --") + option + "=" + value + "\n";
  };
  demand("time", job.time);
  demand("partition", job.partition);
  demand("account", job.account);
  demand("mem", job.memory);
  return script(slurm, job, demands);
}

std::string parallel_script(const JobScript& job) {
  check_common(job);
  return script(parallel, job, job.memory.empty() ? "" : " --memfree " + job.memory);
}

}  // namespace harness
