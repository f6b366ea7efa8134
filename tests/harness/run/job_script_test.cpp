// Job scripts as text; tests/emit_test.sh and tests/slurm_test.sh run them.
#include "harness/run/job_script.h"

#include <gtest/gtest.h>

#include "harness/base/errors.h"

namespace harness {
namespace {

JobScript example() {
  JobScript job;
  job.shards = 12;
  job.axis = "strain";
  job.sweep = {"--sweep=strain", "--filter=a|b $(x)"};
  job.result = "results/local/mine.json";
  return job;
}

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(ShellWord, QuotesOnlyWhatBashWouldTakeApart) {
  EXPECT_EQ(shell_word("--limit=0.01,a/b:c@d%e+f_g"), "--limit=0.01,a/b:c@d%e+f_g");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("a|b $(x)"), "'a|b $(x)'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("~/x"), "'~/x'");
  EXPECT_EQ(shell_word("{1..3}"), "'{1..3}'");
  EXPECT_EQ(shell_word("\xc3\xa9\n"), "'\xc3\xa9\n'");
}

TEST(JobScript, NamesShardsResultAndSweep) {
  for (const std::string& text : {slurm_script(example()), parallel_script(example())}) {
    EXPECT_TRUE(text.starts_with("#!/usr/bin/env bash\n"));
    EXPECT_TRUE(has_line(text, "sweep=(--sweep=strain '--filter=a|b $(x)')")) << text;
    EXPECT_TRUE(has_line(text, "result=results/local/mine.json"));
    EXPECT_TRUE(has_line(text, "shards=results/local/mine-shards"));
    EXPECT_NE(text.find("shard-{1..12}-of-12.json"), std::string::npos);
    EXPECT_EQ(text.find('@' + std::string("N@")), std::string::npos) << "a name was not filled in";
  }
}

TEST(JobScript, NamesOfTheTemplateInValuesAreLeftAlone) {
  JobScript job = example();
  job.sweep = {"--filter=@N@@RESULT@"};
  EXPECT_TRUE(has_line(parallel_script(job), "sweep=(--filter=@N@@RESULT@)"));
}

TEST(JobScript, DemandsOnlyWhatWasAsked) {
  JobScript job = example();
  EXPECT_EQ(slurm_script(job).find("#SBATCH --time"), std::string::npos);
  EXPECT_EQ(parallel_script(job).find("--memfree"), std::string::npos);
  EXPECT_NE(parallel_script(job).find("--jobs 1\n"), std::string::npos);
  job.time = "2-01:30:00";
  job.partition = "long,short";
  job.memory = "4G";
  job.jobs = 3;
  EXPECT_TRUE(has_line(slurm_script(job), "#SBATCH --time=2-01:30:00"));
  EXPECT_TRUE(has_line(slurm_script(job), "#SBATCH --partition=long,short"));
  EXPECT_TRUE(has_line(slurm_script(job), "#SBATCH --mem=4G"));
  EXPECT_NE(parallel_script(job).find("--jobs 3 --memfree 4G\n"), std::string::npos);
}

// sbatch reads its options up to the first line that is neither empty nor a comment.
TEST(JobScript, OptionsOfSlurmComeBeforeAnyCommand) {
  JobScript job = example();
  job.time = "01:00:00";
  const std::string text = slurm_script(job);
  EXPECT_LT(text.rfind("\n#SBATCH"), text.find("\nset -euo pipefail"));
}

TEST(JobScript, RefusesWhatABatchSystemWouldMisread) {
  const auto refused = [](auto spoil) {
    JobScript job = example();
    spoil(job);
    EXPECT_THROW(slurm_script(job), UsageError);
  };
  refused([](JobScript& job) { job.time = "1h"; });
  refused([](JobScript& job) { job.time = "01:99:00"; });
  refused([](JobScript& job) { job.partition = "a b"; });
  refused([](JobScript& job) { job.account = "x\n#SBATCH --exclusive=user"; });
  refused([](JobScript& job) { job.memory = "4"; });
  refused([](JobScript& job) { job.result = ""; });
  refused([](JobScript& job) { job.result = "folder/"; });
  refused([](JobScript& job) { job.result = "-x.json"; });
  refused([](JobScript& job) { job.result = "%a.json"; });
  refused([](JobScript& job) { job.result = "a\nb.json"; });
}

}  // namespace
}  // namespace harness
