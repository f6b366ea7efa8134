// Corrupted suites and result files, by the thousand, repeatably.

#include <random>

#include "harness/claims/claims.h"
#include "harness/points/context.h"
#include "harness/run/sweep.h"
#include "harness/tables/tables.h"
#include "support/effort.h"
#include "support/refusal.h"

namespace harness {
namespace {

// Whatever a user's file holds: a suite, a result, or UsageError with one line; nothing else gets
// out.
std::string read_as_suite(const std::string& text) {
  return refusal_of([&text] {
    const Suite suite = parse_suite(text, "fuzz");
    (void)to_json(suite).dump();
    std::size_t points = 0;  // planning is cheap, unless the suite asks for billions of points
    for (const SweepSpec& s : suite.sweeps)
      points += s.limits.size() * s.resolutions.size() * s.contestants.size();
    if (points < 10000) (void)plan(suite, {});
  });
}

std::string read_as_result(const std::string& text) {
  return refusal_of([&text] {
    const json result = parse_result(text, "fuzz");
    (void)judge_claims({result});
    std::ostringstream page;
    print_results_page(page, {{"fuzz", result}});
  });
}

// One to four corrupted places: bytes changed, cut out or doubled, or a value that trips readers.
std::string corrupt_text(std::string text, std::mt19937_64& random) {
  static const std::vector<std::string> nuisances{
      "1e999", "NaN", "[[[[", "\"\\u0000\"", "\"\xff\"", "/*", "18446744073709551616"};
  for (std::size_t i = 1 + random() % 4; i > 0 && !text.empty(); --i) {
    const std::size_t at = random() % text.size();
    const auto kind = random() % 4;
    if (kind == 0) text[at] = static_cast<char>(random());
    if (kind == 1) text.erase(at, 1 + random() % 20);
    if (kind == 2) text.insert(at, text.substr(random() % text.size(), 1 + random() % 40));
    if (kind < 3) continue;
    const std::size_t colon = text.find(':', at), end = text.find_first_of(",}\n", colon);
    if (end != std::string::npos)
      text.replace(colon + 1, end - colon - 1, nuisances[random() % nuisances.size()]);
  }
  return text;
}

json::iterator some_item(json& parent, std::mt19937_64& random) {
  return std::next(parent.begin(), static_cast<std::ptrdiff_t>(random() % parent.size()));
}

// A value somewhere in the tree.
json& some_value(json& document, std::mt19937_64& random) {
  json* place = &document;
  while (place->is_structured() && !place->empty() && random() % 8 != 0)
    place = &*some_item(*place, random);
  return *place;
}

// One to three values that are another's, gone, or of another kind or size.
std::string corrupt_values(json document, std::mt19937_64& random) {
  static const std::vector<json> nuisances = json::parse(
      R"([null, true, -1, 0, 1, 2, 1e-320, 1e308, -1e308, 1e-9, 2147483648.0, 1.5, "", "x", "../x",
          "a\nb", [], {}, [1, 2, 3], {"a": 1}, 18446744073709551615, -9223372036854775807, ")" +
      std::string(5000, 'y') + "\"]");
  for (std::size_t i = 1 + random() % 3; i > 0; --i) {
    json& value = some_value(document, random);
    const auto kind = random() % 5;
    if (kind == 0) {
      const json copy = some_value(document, random);
      value = copy;
    } else if (kind == 1) {
      if (value.is_structured() && !value.empty()) value.erase(some_item(value, random));
    } else if (kind == 2) {
      if (value.is_object()) value["no_such_key"] = 1;
      if (value.is_array() && !value.empty()) value.push_back(value.front());
      if (value.is_number()) value = -value.get<double>();
      if (value.is_string()) value = value.get<std::string>() + "x";
    } else {
      value = nuisances[random() % nuisances.size()];
    }
  }
  return document.dump();
}

// As text, or value by value, so that it stays JSON.
std::string corrupt(const std::string& text, std::mt19937_64& random) {
  return random() % 2 == 0 ? corrupt_text(text, random)
                           : corrupt_values(json::parse(text, nullptr, true, true), random);
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
  for (auto name : {"quick.json", "default.json", "pairs.json", "paper.json", "large.json"}) {
    const std::string text = read_file(source_path(std::string("configs/") + name), "suite");
    ASSERT_EQ(read_as_suite(text), "") << name;
    corrupt_and_read(text, read_as_suite, inextensible::testing::trials(200));
  }
}

TEST(Documents, CorruptedResultsAreReadOrRefusedInALine) {
  std::vector<PointResult> points;
  const auto suite = read_suite(source_path("configs/pairs.json"));
  for (const Search& search : plan(suite, {})) {
    points.emplace_back(search.base, PointStatus::ok).samples = {0.5};
    points.back().best = true;
    if (points.size() == 2) break;
  }
  const std::string text =
      result_document(machine_context(), Suite{}, {"bench"}, true, points).dump(1);
  ASSERT_EQ(read_as_result(text), "");
  corrupt_and_read(text, read_as_result, inextensible::testing::trials(2000));
}

}  // namespace
}  // namespace harness
