// Corrupted suites and result files, by the thousand: what the fuzzer does, repeatably and in CI.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "harness/points/context.h"
#include "harness/points/fuzz_documents.h"
#include "support/corrupt.h"
#include "support/effort.h"

namespace {

using harness::testing::corrupt;
using harness::testing::read_as_result;
using harness::testing::read_as_suite;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

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
    const std::string text = text_of(std::filesystem::path(SOURCE_DIR) / "configs" / name);
    ASSERT_EQ(read_as_suite(text), "") << name;
    corrupt_and_read(text, read_as_suite, inextensible::testing::trials(500));
  }
}

TEST(Documents, CorruptedResultsAreReadOrRefusedInALine) {
  harness::PointResult point;
  point.spec.scene = "chain";
  point.spec.solver = "fast_projection";
  point.spec.sweep = "strain";
  point.spec.scene_parameters["duration"] = 1;
  point.spec.resolution = point.spec.vertices = 80;
  point.spec.constraints = 79;
  point.status = harness::PointStatus::ok;
  point.samples = {0.5};
  point.best = true;
  std::vector<harness::PointResult> points{point, point};
  points[1].spec.solver = "implicit_springs";
  const std::string text = harness::result_document(harness::machine_context(), harness::Suite{},
                                                    {"bench"}, true, points)
                               .dump(1);
  ASSERT_EQ(read_as_result(text), "");
  corrupt_and_read(text, read_as_result, inextensible::testing::trials(2000));
}

}  // namespace
