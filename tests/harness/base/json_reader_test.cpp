// JSON from outside: bounded, without second meanings, and never a long message.
#include "harness/base/json_reader.h"

#include <gtest/gtest.h>

#include "harness/base/errors.h"
#include "harness/base/json_text.h"

namespace harness {
namespace {

std::string complaint(const std::string& text) {
  try {
    parse_document(text, "a.json");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(JsonReader, RefusesAKeyThatStandsTwice) {
  EXPECT_NE(complaint(R"({"a": 1, "b": {"a": 2}, "a": 3})").find("'a' occurs twice"),
            std::string::npos);
  EXPECT_EQ(complaint(R"({"a": {"x": 1}, "b": {"x": 1}})"), "") << "two objects";
}

TEST(JsonReader, RefusesWhatIsNestedDeep) {
  for (const char* one : {"[", "{\"a\":"}) {
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += one;
    EXPECT_NE(complaint(deep).find("nested"), std::string::npos);
  }
  EXPECT_EQ(complaint("[[[[[[[[[[1]]]]]]]]]]"), "");
}

TEST(JsonReader, ATextThatIsNotUtf8LosesNoDocument) {
  const nlohmann::json value = {{"path",
                                 "a\xff"
                                 "b"}};
  const std::string text = document_text(value);
  EXPECT_EQ(parse_document(text, "a.json").at("path"),
            "a\xEF\xBF\xBD"
            "b");
}

TEST(Bounds, HoldFiniteNumbersOnly) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_FALSE(Bounds::positive().hold(bad)) << bad;
  EXPECT_TRUE(Bounds::positive().hold(1e-300));
  EXPECT_FALSE(Bounds::whole_number(1).hold(1e300)) << "does not fit into an int";
  EXPECT_FALSE(Bounds::whole_number(1).hold(1.5));
  EXPECT_EQ(Bounds::positive().text(), "a number above 0");
}

}  // namespace
}  // namespace harness
