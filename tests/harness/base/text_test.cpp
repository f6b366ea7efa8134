#include "harness/base/text.h"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/base/json_text.h"

namespace harness {
namespace {

TEST(ToldApart, HasEnoughDigitsToDifferAndNoMore) {
  EXPECT_EQ(told_apart(0.2, 0.1), "0.2");
  EXPECT_EQ(told_apart(0.0001, 0.0001), "0.0001");
  EXPECT_EQ(told_apart(0.00010003, 0.0001), "0.00010003");
  EXPECT_EQ(told_apart(0.000100000002, 0.0001), "0.000100000002");
  const double next = std::nextafter(0.1, 1);
  EXPECT_NE(told_apart(next, 0.1), number_text(0.1));
  EXPECT_EQ(std::stod(told_apart(next, 0.1)), next);
}

TEST(JsonText, SaysTheSameOnOneLineFoldedAndAsADocument) {
  const auto value = nlohmann::ordered_json::parse(
      R"({"b": {"x": [1, 2.5], "y": {}}, "a": [[], {"t": "q\"\n"}, 0.1], "c": null})");
  EXPECT_EQ(line_of(value),
            R"({"b": {"x": [1, 2.5], "y": {}}, "a": [[], {"t": "q\"\n"}, 0.1], "c": null})");
  EXPECT_EQ(folded_text(value, 80), line_of(value) + "\n");
  EXPECT_EQ(
      folded_text(value, 40),
      "{\n  \"b\": {\"x\": [1, 2.5], \"y\": {}},\n  \"a\": [[], {\"t\": \"q\\\"\\n\"}, 0.1],\n"
      "  \"c\": null\n}\n");
  EXPECT_EQ(
      document_text(value),
      "{\n\"b\": {\n\"x\": [1, 2.5],\n\"y\": {}\n},\n\"a\": [\n[],\n{\"t\": \"q\\\"\\n\"},\n0.1\n"
      "],\n\"c\": null\n}\n");
}

}  // namespace
}  // namespace harness
