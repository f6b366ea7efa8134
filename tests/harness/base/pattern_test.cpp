// Regular expressions of users: an answer in time, whatever is asked.
#include "harness/base/pattern.h"

#include <gtest/gtest.h>

#include <chrono>

#include "harness/base/errors.h"

namespace harness {
namespace {

TEST(Pattern, MatchesWholesAndFindsParts) {
  const Pattern pattern("--solver", "shake|icd");
  EXPECT_TRUE(pattern.matches("icd"));
  EXPECT_TRUE(pattern.matches("ICD"));
  EXPECT_FALSE(pattern.matches("icd_loose"));
  EXPECT_TRUE(pattern.found_in("chain/icd/n:20"));
}

// With backtracking they would not, within anybody's time.
TEST(Pattern, PathologicalOnesEnd) {
  const Pattern pattern("--filter", "(a*)*(a*)*(a*)*b|(a|aa)+$");
  EXPECT_FALSE(pattern.found_in(std::string(5000, 'a') + "c"));
}

TEST(Pattern, NonsenseAndGiantsAreRefusedInALine) {
  for (const std::string& bad :
       {std::string("("), std::string("[z-a]"), std::string(100000, '(')}) {
    try {
      const Pattern pattern("--filter", bad);
      ADD_FAILURE() << "taken";
    } catch (const UsageError& error) {
      EXPECT_LT(std::string(error.what()).size(), 400u);
    }
  }
}

}  // namespace
}  // namespace harness
