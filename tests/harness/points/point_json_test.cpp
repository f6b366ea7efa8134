// No field of a point is lost on its way through JSON. Points are filled at random by the tables of
// fields, so a new field is tested as soon as it has its row.
#include "harness/points/point_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "harness/points/point_fields.h"

namespace harness {
namespace {

using nlohmann::json;

class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  void fill(double& value, bool nullable) {
    const bool none = nullable && generator_() % 4 == 0;
    value = none ? unknown
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
  void fill(inextensible::Settings& value, bool) {
    value["a word"] = "value " + std::to_string(generator_());
    double number = 0;
    fill(number, false);
    value["a number"] = number;
  }
  void fill(std::vector<double>& numbers, bool) {
    numbers.resize(generator_() % 4);
    for (double& value : numbers) fill(value, false);
  }
  void fill(std::vector<int>& counts, bool) {
    counts.resize(generator_() % 4);
    for (int& value : counts) fill(value, false);
  }
  void fill(std::vector<FrameTime>& rates, bool) {
    rates.resize(1 + generator_() % 3);
    for (FrameTime& at : rates)
      for (double* value : {&at.rate, &at.median, &at.slow, &at.worst}) fill(*value, false);
  }
  void fill(std::vector<ErrorSample>& series, bool) {
    series.resize(generator_() % 4);
    for (ErrorSample& at : series)
      for (double* value : {&at.time, &at.error, &at.worst, &at.gap, &at.worst_gap})
        fill(*value, false);
  }
  void fill(std::vector<ResidualSample>& value, bool) {
    value.resize(generator_() % 4);
    for (auto& r : value) {
      fill(r.time, false);
      fill(r.first, false);
      fill(r.last, false);
    }
  }

  template <class Table, class Object>
  void fill_all(const Table& table, Object& object) {
    for_each_field(table, [&](const auto& row) { fill(object.*row.member, row.traits.nullable); });
  }

  PointResult point() {
    PointResult p;
    fill_all(spec_fields, p.spec);
    fill_all(size_fields, p.spec);
    fill_all(result_fields, p);
    fill_all(phase_fields, p.phases);
    fill_all(measure_fields, p.measures);
    for (const auto& counter : inextensible::work_counters)
      std::visit([&](const auto member) { fill(p.work.*member, false); }, counter.member);
    for (auto* samples : {&p.samples, &p.filter_samples}) {
      samples->resize(generator_() % 4);
      for (double& sample : *samples) fill(sample, false);
    }
    if (generator_() % 2 == 0) fill(p.stiffness.emplace(), false);
    fill(p.linear_solver, true);
    return p;
  }

 private:
  std::mt19937_64 generator_;
};

template <class Value>
bool same(const Value& a, const Value& b) {
  if constexpr (std::is_same_v<Value, double>) return a == b || (std::isnan(a) && std::isnan(b));
  return a == b;
}

template <class Table, class Object>
void expect_same(const Table& table, const Object& a, const Object& b) {
  for_each_field(
      table, [&](const auto& row) { EXPECT_TRUE(same(a.*row.member, b.*row.member)) << row.name; });
}

TEST(PointJson, LosesNothing) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const PointResult point = Random(seed).point();
    const json written = json::parse(to_json(point).dump());
    const PointResult read = point_of(written);
    EXPECT_EQ(to_json(read), written);
    expect_same(spec_fields, point.spec, read.spec);
    expect_same(size_fields, point.spec, read.spec);
    expect_same(result_fields, point, read);
    expect_same(phase_fields, point.phases, read.phases);
    expect_same(measure_fields, point.measures, read.measures);
    EXPECT_EQ(point.work, read.work);
    EXPECT_EQ(point.samples, read.samples);
    EXPECT_EQ(point.stiffness, read.stiffness);
    EXPECT_EQ(point.linear_solver, read.linear_solver);
    EXPECT_EQ(key_of(point.spec), key_of(read.spec));
  }
}

TEST(PointJson, RepetitionsComeBack) {
  PointResult point = Random(1).point();
  const Repetition before = samples_of(point),
                   more{{1, 2}, {0.5, 0.75}, {0.1}, {7, 8}, 3, {{60, 0.001, 0.002, 0.003}}};
  append(repetition_of(to_json(more)), point);
  EXPECT_EQ(to_json(added_since(before, point)), to_json(more));
  EXPECT_EQ(point.frame_times, more.frame_times);
}

// Every key but those made for readers has been read: one that is changed is seen.
TEST(PointJson, ReadsWhatItWrites) {
  const json written = to_json(Random(1).point());
  for (const char* name : {"status", "step", "best", "work", "phases", "error"}) {
    json without = written;
    without.erase(name);
    EXPECT_THROW(point_of(without), json::exception) << name;
  }
}

}  // namespace
}  // namespace harness
