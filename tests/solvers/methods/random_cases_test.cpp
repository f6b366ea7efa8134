// Every backend against thousands of random problems: graphs from trees to locked ones, masses over
// six decades, velocities over three, starts on and off the manifold, steps that are often absurd.
// Whatever happens: an honest step or a clean refusal. RANDOM_CASES=n runs n cases a backend.
#include <gtest/gtest.h>

#include <cstdlib>

#include "support/effort.h"
#include "support/param_name.h"
#include "support/random_trial.h"

namespace inextensible {
namespace {

int cases() {
  const char* wanted = std::getenv("RANDOM_CASES");
  return wanted ? std::atoi(wanted) : testing::trials(1000);
}

class RandomCases : public ::testing::TestWithParam<const char*> {};

TEST_P(RandomCases, GiveAnHonestStepOrACleanRefusal) {
  const std::string backend = GetParam();
  int steps = 0;
  for (int seed = 1; seed <= cases(); ++seed) {
    testing::Random random(static_cast<std::uint64_t>(seed));
    const auto attempt =
        testing::attempt(testing::random_trial(random), backend, testing::impatient(backend));
    EXPECT_EQ(attempt.defect, "") << "seed " << seed;
    steps += attempt.steps;
  }
  EXPECT_GT(steps, cases() / 2) << "hardly any step was taken: this tests nothing";
}

std::vector<const char*> contestants() {
  std::vector<const char*> names;
  for (const Backend& backend : backends()) {
    if (backend.contestant) names.push_back(backend.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, RandomCases, ::testing::ValuesIn(contestants()),
                         names::contestant_name);

}  // namespace
}  // namespace inextensible
