// Corrupted suites and result files, by the thousand, and points on their way through JSON.
#include <gtest/gtest.h>

#include <random>

#include "harness/claims/claims.h"
#include "harness/points/context.h"
#include "harness/points/point_json.h"
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

// ---- Points, filled at random by the tables of fields: a new field is tested with its row ----

struct Random {
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  void fill(double& value, bool nullable) {
    const bool none = nullable && generator_() % 4 == 0;
    value = none ? (generator_() % 2 == 0 ? unknown : HUGE_VAL)  // written as null
                 : std::ldexp(double(generator_() % 1000003 + 1), int(generator_() % 60) - 40);
  }
  template <class Whole>
  requires std::is_integral_v<Whole>
  void fill(Whole& value, bool) { value = static_cast<Whole>(generator_() % (1u << 30)); }
  void fill(bool& value, bool) { value = generator_() % 2 == 0; }
  void fill(std::string& value, bool nullable) {
    value =
        nullable && generator_() % 4 == 0 ? "" : "text \"" + std::to_string(generator_()) + "\"\n";
  }
  void fill(PointStatus& value, bool) {
    value = point_statuses[generator_() % point_statuses.size()].status;
  }
  void fill(SceneParameters& value, bool) {
    for (const char* name : {"duration", "n", "mass"}) fill(value[name], false);
  }
  void fill(Settings& value, bool) {
    value["a word"] = "value " + std::to_string(generator_());
    double number = 0;
    fill(number, false);
    value["a number"] = number;
  }
  void fill(FrameTime& at, bool) { fill_each(at.rate, at.median, at.slow, at.worst); }
  void fill(ErrorSample& at, bool) { fill_each(at.time, at.error, at.worst, at.gap, at.worst_gap); }
  void fill(OccasionTime& at, bool) { fill_each(at.occasion, at.least, at.median); }
  void fill(ErrorAtLevel& at, bool) {
    fill_each(at.level, at.distance, at.mean, at.largest, at.gap, at.samples, at.until);
  }
  void fill(ResidualSample& at, bool) { fill_each(at.time, at.first, at.last); }
  template <class... Values>
  void fill_each(Values&... values) {
    (fill(values, false), ...);
  }
  template <class Value>
  void fill(std::vector<Value>& list, bool) {
    list.resize(generator_() % 4);
    for (Value& value : list) fill(value, false);
  }

  template <class Table, class Object>
  void fill_all(const Table& table, Object& object) {
    for_each_field(table, [&](const auto& row) { fill(object.*row.member, row.traits.nullable); });
  }

  PointResult point() {
    PointResult p;
    for_each_table(p, [this](const auto& table, auto& part) { fill_all(table, part); });
    fill_all(sample_fields, p);
    for (const auto& counter : inextensible::work_counters)
      std::visit([&](const auto member) { fill(p.work.*member, false); }, counter.member);
    fill_each(p.samples, p.filter_samples);
    if (generator_() % 2 == 0) fill(p.stiffness.emplace(), false);
    fill(p.linear_solver, true);
    return p;
  }

 private:
  std::mt19937_64 generator_;
};

// The JSON of every field's own, which a reader that skips one would not give back.
json fields_of(const PointResult& point) {
  json fields;
  for_each_table(
      point, [&fields](const auto& table, const auto& part) { write_fields(fields, table, part); });
  return fields;
}

TEST(PointJson, LosesNothing) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const PointResult point = Random(seed).point();
    const json written = json::parse(to_json(point).dump());
    const PointResult read = point_of(written);
    EXPECT_EQ(to_json(read), written);
    EXPECT_EQ(fields_of(read), fields_of(point));
    EXPECT_EQ(to_json(samples_of(written)), to_json(static_cast<const Samples&>(point)));
    EXPECT_EQ(std::tie(point.work, point.samples, point.stiffness, point.linear_solver),
              std::tie(read.work, read.samples, read.stiffness, read.linear_solver));
  }
}

}  // namespace
}  // namespace harness
