// What comes from outside: JSON and expressions are bounded, without second meanings, and never
// make a long message.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/base/json.h"
#include "harness/base/pattern.h"
#include "support/refusal.h"

namespace harness {
namespace {

TEST(JsonReader, RefusesKeysThatStandTwiceAndWhatIsNestedDeep) {
  const struct {
    std::string text, complaint;
  } cases[] = {{R"({"a": 1, "b": {"a": 2}, "a": 3})", "'a' occurs twice"},
               {R"({"a": {"x": 1}, "b": {"x": 1}})", ""},
               {std::string(100000, '['), "nested"},
               {R"([{"a":)" + std::string(100000, '['), "nested"},
               {"[[[[[[[[[[1]]]]]]]]]]", ""}};
  for (const auto& [text, part] : cases) {
    const std::string found =
        refusal_of([&document = text] { parse_document(document, "a.json"); });
    EXPECT_TRUE(part.empty() ? found.empty() : found.find(part) != std::string::npos) << found;
    EXPECT_LT(found.size(), 400u);
  }
}

TEST(JsonText, ThatIsNotUtf8LosesNoDocument) {
  const nlohmann::json value = {{"path",
                                 "a\xff"
                                 "b"}};
  EXPECT_EQ(parse_document(document_text(value), "a.json").at("path"),
            "a\xEF\xBF\xBD"
            "b");
}

TEST(JsonText, SaysTheSameOnOneLineAndAsADocument) {
  const auto value = nlohmann::ordered_json::parse(
      R"({"b": {"x": [1, 2.5], "y": {}}, "a": [[], {"t": "q\"\n"}, 0.1], "c": null})");
  for (const std::string& text : {line_of(value), document_text(value)})
    EXPECT_EQ(nlohmann::ordered_json::parse(text), value) << text;
  EXPECT_EQ(line_of(value).find('\n'), std::string::npos);
}

TEST(Bounds, HoldFiniteNumbersOnly) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_FALSE(Bounds::positive().hold(bad)) << bad;
  EXPECT_TRUE(Bounds::positive().hold(1e-300));
  EXPECT_FALSE(Bounds::whole_number(1).hold(1e300)) << "does not fit into an int";
  EXPECT_FALSE(Bounds::whole_number(1).hold(1.5));
}

TEST(Pattern, MatchesWholesAndFindsParts) {
  const Pattern pattern("--solver", "shake|icd");
  EXPECT_TRUE(pattern.matches("ICD"));
  EXPECT_FALSE(pattern.matches("icd_loose"));
  EXPECT_TRUE(pattern.found_in("chain/icd/n:20"));
}

// With backtracking the first would not end within anybody's time.
TEST(Pattern, PathologicalOnesEndAndGiantsAreRefusedInALine) {
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
