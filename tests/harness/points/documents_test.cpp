// Corrupted suites and result files, by the thousand: what the fuzzer does, repeatably and in CI.
#include <gtest/gtest.h>

#include <random>

#include "harness/base/files.h"
#include "harness/points/context.h"
#include "harness/points/fuzz_documents.h"
#include "support/corrupt.h"
#include "support/effort.h"

namespace {

using harness::testing::corrupt;
using harness::testing::read_as_result;
using harness::testing::read_as_suite;

void corrupt_and_read(const std::string& text, std::string (*read)(const std::string&), int cases) {
  int refused = 0;
  for (int seed = 1; seed <= cases; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::string message;
    ASSERT_NO_THROW(message = read(corrupt(text, random)));
    EXPECT_EQ(message.find('\n'), std::string::npos) << "more than a line: " << message;
    refused += message.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, cases / 4) << "hardly anything was corrupted: this tests nothing";
}

TEST(Documents, CorruptedSuitesAreReadOrRefusedInALine) {
  for (const char* name : {"quick.json", "default.json", "paper.json", "large.json"}) {
    const std::string text =
        harness::read_file(std::string(SOURCE_DIR) + "/configs/" + name, "suite");
    ASSERT_EQ(read_as_suite(text), "") << name;
    corrupt_and_read(text, read_as_suite, inextensible::testing::trials(500));
  }
}

TEST(Documents, CorruptedResultsAreReadOrRefusedInALine) {
  std::vector<harness::PointResult> points;
  const auto suite = harness::read_suite(std::string(SOURCE_DIR) + "/configs/quick.json");
  for (const harness::Search& search : harness::plan(suite, {})) {
    points.emplace_back(search.base, harness::PointStatus::ok).samples = {0.5};
    points.back().best = true;
    if (points.size() == 2) break;
  }
  const std::string text = harness::result_document(harness::machine_context(), harness::Suite{},
                                                    {"bench"}, true, points)
                               .dump(1);
  ASSERT_EQ(read_as_result(text), "");
  corrupt_and_read(text, read_as_result, inextensible::testing::trials(2000));
}

}  // namespace
