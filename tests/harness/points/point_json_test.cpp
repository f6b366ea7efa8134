// No field of a point is lost on its way through JSON. Points are filled at random by the tables of
// fields, so a new field is tested as soon as it has its row.
#include "harness/points/point_json.h"

#include <gtest/gtest.h>

#include <random>

namespace harness {
namespace {

class Random {
 public:
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
