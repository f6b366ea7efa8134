// A point as JSON: in result files, in journals, and between a child process and its parent. The
// tables of its fields are here, and in measures.h and work_counters.h.
#pragma once

#include "harness/points/point.h"

template <>
struct nlohmann::adl_serializer<std::variant<double, std::string>> {  // a setting's value
  static void to_json(json& to, const std::variant<double, std::string>& value) {
    std::visit([&to](const auto& held) { to = held; }, value);
  }
  static void from_json(const json& from, std::variant<double, std::string>& value) {
    if (from.is_string())
      value = from.get<std::string>();
    else
      value = from.get<double>();
  }
};

namespace harness {

void to_json(json& to, PointStatus status);
void from_json(const json& from, PointStatus& status);

template <>
inline nlohmann::ordered_json FieldCodec<PointStatus>::schema(const FieldTraits&) {
  return {{"$ref", "#/definitions/status"}};
}

template <>
inline nlohmann::ordered_json FieldCodec<Settings>::schema(const FieldTraits&) {
  return {{"type", "object"}, {"additionalProperties", {{"type", {"number", "string"}}}}};
}

// Lists of numbers have positive ones.
template <>
inline nlohmann::ordered_json FieldCodec<std::vector<double>>::schema(const FieldTraits&) {
  return {{"type", "array"}, {"items", {{"type", "number"}, {"exclusiveMinimum", 0}}}};
}

template <>
inline nlohmann::ordered_json FieldCodec<std::vector<int>>::schema(const FieldTraits&) {
  return {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 1}}}};
}

// A list of rows, each a list of a struct's numbers.
template <class Row, double Row::*... members>
struct RowsCodec {
  static json write(const std::vector<Row>& rows, bool /*nullable*/) {
    json list = json::array();
    for (const Row& row : rows) list.push_back(json::array({number(row.*members)...}));
    return list;
  }
  static void read(const json& from, std::vector<Row>& rows, bool /*nullable*/) {
    rows.clear();
    for (const json& row : from) {
      std::size_t column = 0;
      rows.push_back({});
      ((rows.back().*members = number_of(row.at(column++))), ...);
    }
  }
  static nlohmann::ordered_json schema(const FieldTraits& /*traits*/) {
    constexpr int columns = sizeof...(members);
    return {{"type", "array"},
            {"items",
             {{"type", "array"},
              {"minItems", columns},
              {"maxItems", columns},
              {"items", {{"$ref", "#/definitions/figure"}}}}}};
  }
};

template <>
struct FieldCodec<std::vector<ResidualSample>>
    : RowsCodec<ResidualSample, &ResidualSample::time, &ResidualSample::first,
                &ResidualSample::last> {};
template <>
struct FieldCodec<std::vector<ErrorSample>>
    : RowsCodec<ErrorSample, &ErrorSample::time, &ErrorSample::error, &ErrorSample::worst,
                &ErrorSample::gap, &ErrorSample::worst_gap> {};
template <>
struct FieldCodec<std::vector<ErrorAtLevel>>
    : RowsCodec<ErrorAtLevel, &ErrorAtLevel::level, &ErrorAtLevel::distance, &ErrorAtLevel::mean,
                &ErrorAtLevel::largest, &ErrorAtLevel::gap, &ErrorAtLevel::samples,
                &ErrorAtLevel::until> {};
template <>
struct FieldCodec<std::vector<FrameTime>>
    : RowsCodec<FrameTime, &FrameTime::rate, &FrameTime::median, &FrameTime::slow,
                &FrameTime::worst> {};
template <>
struct FieldCodec<std::vector<OccasionTime>>
    : RowsCodec<OccasionTime, &OccasionTime::occasion, &OccasionTime::least,
                &OccasionTime::median> {};

// What is run: two runs that agree in these are interchangeable.
inline constexpr std::tuple spec_fields{
    field("sweep", &PointSpec::sweep, "", "kind of the sweep that it is a point of"),
    field("scene", &PointSpec::scene, "", "see `bench list scenes`"),
    field("scene_parameters", &PointSpec::scene_parameters, "", "all of the scene's"),
    field("contestant", &PointSpec::contestant, "",
          "the solver, or its name where it is in the run several times"),
    field("solver", &PointSpec::solver, "", "see `bench list solvers`"),
    field("settings", &PointSpec::settings, "", "the solver's settings as given"),
    field("strain_limit", &PointSpec::strain_limit, "", "permissible |strain|, 0.01 is 1 %",
          {.positive = true}),
    field("step", &PointSpec::step, "s", "", {.positive = true}),
    field("seed", &PointSpec::seed, "", "of random orders")};

// What follows from the scene's parameters.
inline constexpr std::tuple size_fields{
    field("resolution", &PointSpec::resolution, "", "the scene's own parameter of size",
          {.positive = true}),
    field("vertices", &PointSpec::vertices, "vertices", "of the mesh", {.positive = true}),
    field("constraints", &PointSpec::constraints, "edges", "of constant length",
          {.positive = true})};

// What was measured beside the times of samples.
inline constexpr std::tuple sample_fields{
    field("cpu_seconds_per_simulated_second", &Samples::cpu_samples, "",
          "processor time of the thread in the runs of each sample of "
          "seconds_per_simulated_second"),
    field("runs_per_sample", &Samples::sample_runs, "runs",
          "that each of these samples is the mean of"),
    field("retaken", &Samples::retaken, "samples",
          "taken again because a fixed piece of work beside them took too long"),
    field("frame_times", &Samples::frame_times, "frames a second, then s",
          "of one run of the fastest sample, at each rate of pictures that steps are fine enough "
          "for: the rate, and the wall time of a frame, median, 99 % and worst")};

// What came of it, beside its measures and its work.
inline constexpr std::tuple result_fields{
    field("status", &PointResult::status, "", "how the run ended, see `bench list statuses`"),
    field("status_detail", &PointResult::detail, "", "of a failure: step, time, reason"),
    field("setup_seconds", &PointResult::setup_seconds, "s", "wall time before the first step"),
    field("calibration_runs", &PointResult::calibration_runs, "runs",
          "of the search for a stiffness", {.inside = "work"}),
    field("calibration_guess", &PointResult::calibration_guess, "N",
          "the stiffness that the search began with, from a neighbouring point; null: an estimate",
          {.nullable = true}),
    field("steps_planned", &PointResult::steps_planned, "steps",
          "that the duration takes at this step"),
    field("peak_rss_bytes", &PointResult::peak_rss_bytes, "bytes", "largest resident memory"),
    field("best", &PointResult::best, "",
          "the fastest step of its contestant at its place on the axis, whatever its motion"),
    field("best_at_errors", &PointResult::best_at_errors, "scene's size",
          "levels of error within which it is the fastest step of its contestant at its place"),
    field("at_ladder_end", &PointResult::at_ladder_end, "",
          "of a best point: 'coarsest' or 'finest' where its step is that end of the ladder"),
    field("occasions", &PointResult::occasions, "wall seconds per simulated second",
          "taken hours later or on another machine: the occasion's place in context.occasions, "
          "from 1, then the least and the median of its samples",
          {.nullable = true})};

inline constexpr FieldTraits in_phases{.inside = "phases"};
inline constexpr std::tuple phase_fields{
    field("unconstrained", &PhaseSeconds::unconstrained, "s",
          "wall time of one run in steps without constraints", in_phases),
    field("filter", &PhaseSeconds::filter, "s", "wall time of the same run in the velocity filter",
          in_phases),
    field("collision", &PhaseSeconds::collision, "s",
          "wall time of the same run in the collision filter", in_phases),
    field("contact", &PhaseSeconds::contact, "s",
          "what of these three goes to friction, to finding contacts and to planes", in_phases),
    field("copy", &PhaseSeconds::copy, "s",
          "wall time of the same run in copying the state into an engine and out of it",
          in_phases)};

// All tables of a point but that of its samples, each with what it is the table of.
template <class Point, class Visit>
void for_each_table(Point& point, const Visit& visit) {
  visit(spec_fields, point.spec);
  visit(size_fields, point.spec);
  visit(result_fields, point);
  visit(phase_fields, point.phases);
  visit(measure_fields, point.measures);
}

json to_json(const WorkCounters& work);
json to_json(const PointResult& point);
json to_json(const Samples& samples);

// The way back: to_json(point_of(j)) == j. All throw json::exception for anything that is not what
// they read.
WorkCounters work_of(const json& work);
PointResult point_of(const json& point);
Samples samples_of(const json& samples);
PointSpec spec_of(const json& point);

// Everything in a point that is not measured: runs of one key are interchangeable.
std::string key_of(const PointSpec& spec);

}  // namespace harness
