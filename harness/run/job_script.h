// Scripts that run a sweep in shards under a batch system and merge what they measured.
#pragma once

#include <string>
#include <vector>

namespace harness {

struct JobScript {
  int shards = 1;
  std::string axis;                // names the job
  std::vector<std::string> sweep;  // bench's options, as words, without --out
  std::string result;              // the merged file; shards go to a folder beside it

  std::string memory;                    // "4G", "" for no demand
  std::string time, partition, account;  // Slurm only, "" for the cluster's defaults
  int jobs = 1;                          // GNU parallel only: shards at once
};

// The word as Bash reads it back, in quotes only where it needs them.
std::string shell_word(const std::string& word);

// Bash scripts. Both throw UsageError for values that their batch system would misread.
std::string slurm_script(const JobScript& job);
std::string parallel_script(const JobScript& job);

}  // namespace harness
