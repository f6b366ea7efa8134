#include "harness/base/shard.h"

#include <cstdio>

#include "harness/base/errors.h"
#include "harness/base/pattern.h"
#include "harness/base/text.h"

namespace harness {

Shard parse_shard(const std::string& text) {
  Shard shard;
  if (!has_form(text, R"(\d{1,6}/\d{1,6})") ||
      std::sscanf(text.c_str(), "%zu/%zu", &shard.index, &shard.count) != 2)
    throw UsageError("--shard is '" + shortened(text) + "', must be i/N, such as 2/5");
  if (shard.index < 1 || shard.index > shard.count)
    throw UsageError("--shard is '" + text + "', but i must be from 1 to N");
  return shard;
}

}  // namespace harness
