// Input from outside: no text makes a document unreadable, and no expression runs for ever.

#include "harness/base/json.h"
#include "harness/base/pattern.h"
#include "support/refusal.h"

namespace harness {
namespace {

TEST(JsonText, InvalidUtf8LosesNoDocument) {
  const json value = {{"path", "a\xffz"}};
  EXPECT_EQ(parse_document(document_text(value), "a.json").at("path"), "a\uFFFDz");
}

TEST(Pattern, MatchesWholeNamesAndFindsParts) {
  const Pattern pattern("--solver", "shake|icd");
  EXPECT_TRUE(pattern.matches("ICD"));
  EXPECT_FALSE(pattern.matches("icd_loose"));
  EXPECT_TRUE(pattern.found_in("chain/icd/n:20"));
}

// With backtracking the first would not end within anybody's time.
TEST(Pattern, PathologicalOnesEndAndHugeOnesAreRefusedInALine) {
  const Pattern pattern("--filter", "(a*)*(a*)*(a*)*b|(a|aa)+$");
  EXPECT_FALSE(pattern.found_in(std::string(5000, 'a') + "c"));
  for (const std::string& bad : {std::string("[z-a]"), std::string(100000, '(')}) {
    const std::string said = refusal_of([&bad] { const Pattern giant("--filter", bad); });
    EXPECT_NE(said, "");
    EXPECT_LT(said.size(), 400u);
  }
}

}  // namespace
}  // namespace harness
