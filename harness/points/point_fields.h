// The tables of a point's fields; measures.h and work_counters.h hold the others.
#pragma once

#include "harness/base/fields_json.h"
#include "harness/points/point.h"

namespace harness {

template <>
struct FieldCodec<inextensible::Settings> {
  static nlohmann::json write(const inextensible::Settings& settings, bool nullable);
  static void read(const nlohmann::json& from, inextensible::Settings& settings, bool nullable);
  static nlohmann::ordered_json schema(const FieldTraits& traits);
};

template <>
struct FieldCodec<PointStatus> {
  static nlohmann::json write(PointStatus status, bool nullable);
  static void read(const nlohmann::json& from, PointStatus& status, bool nullable);
  static nlohmann::ordered_json schema(const FieldTraits& traits);
};

template <>
struct FieldCodec<std::vector<ResidualSample>> {
  static nlohmann::json write(const std::vector<ResidualSample>& series, bool nullable);
  static void read(const nlohmann::json& from, std::vector<ResidualSample>& series, bool nullable);
  static nlohmann::ordered_json schema(const FieldTraits& traits);
};

template <>
struct FieldCodec<std::vector<ErrorSample>> {
  static nlohmann::json write(const std::vector<ErrorSample>& series, bool nullable);
  static void read(const nlohmann::json& from, std::vector<ErrorSample>& series, bool nullable);
  static nlohmann::ordered_json schema(const FieldTraits& traits);
};

template <>
struct FieldCodec<std::vector<double>> {
  static nlohmann::json write(const std::vector<double>& numbers, bool nullable);
  static void read(const nlohmann::json& from, std::vector<double>& numbers, bool nullable);
  static nlohmann::ordered_json schema(const FieldTraits& traits);
};

template <>
struct FieldCodec<std::vector<int>> {
  static nlohmann::json write(const std::vector<int>& counts, bool nullable);
  static void read(const nlohmann::json& from, std::vector<int>& counts, bool nullable);
  static nlohmann::ordered_json schema(const FieldTraits& traits);
};

template <>
struct FieldCodec<std::vector<FrameTime>> {
  static nlohmann::json write(const std::vector<FrameTime>& rates, bool nullable);
  static void read(const nlohmann::json& from, std::vector<FrameTime>& rates, bool nullable);
  static nlohmann::ordered_json schema(const FieldTraits& traits);
};

// What is run: two runs that agree in these may stand for each other.
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
    field("step", &PointSpec::step, "s", "adaptive: the largest one", {.positive = true}),
    field("adaptive", &PointSpec::adaptive, "",
          "a step controller halves the step where the solver refuses it"),
    field("seed", &PointSpec::seed, "", "of random orders")};

// What follows from the scene's parameters.
inline constexpr std::tuple size_fields{
    field("resolution", &PointSpec::resolution, "", "the scene's own parameter of size",
          {.positive = true}),
    field("vertices", &PointSpec::vertices, "vertices", "of the mesh", {.positive = true}),
    field("constraints", &PointSpec::constraints, "edges", "of constant length",
          {.positive = true})};

// What came of it, beside its measures and its work.
inline constexpr std::tuple result_fields{
    field("status", &PointResult::status, "", "how the run ended, see `bench list statuses`"),
    field("status_detail", &PointResult::detail, "", "of a failure: step, time, reason"),
    field("cpu_seconds_per_simulated_second", &PointResult::cpu_samples, "",
          "processor time of the thread in the runs of each sample of "
          "seconds_per_simulated_second"),
    field("runs_per_sample", &PointResult::sample_runs, "runs",
          "that each of these samples is the mean of"),
    field("retaken", &PointResult::retaken, "samples",
          "taken again because a fixed piece of work beside them took too long"),
    field("setup_seconds", &PointResult::setup_seconds, "s", "wall time before the first step"),
    field("calibration_seconds", &PointResult::calibration_seconds, "s",
          "wall time of the search for a stiffness"),
    field("calibration_runs", &PointResult::calibration_runs, "runs",
          "of the search for a stiffness", {.inside = "work"}),
    field("calibration_guess", &PointResult::calibration_guess, "N",
          "the stiffness that the search began with, from a neighbouring point; null: an estimate",
          {.nullable = true}),
    field("smallest_step", &PointResult::smallest_step, "s", "of the accepted ones; adaptive only",
          {.nullable = true}),
    field("frame_times", &PointResult::frame_times, "frames a second, then s",
          "of one run of the fastest sample, at each rate of pictures that steps are fine enough "
          "for: the rate, and the wall time of a frame, median, 99 % and worst"),
    field("steps_planned", &PointResult::steps_planned, "steps",
          "that the duration takes at this step"),
    field("peak_rss_bytes", &PointResult::peak_rss_bytes, "bytes", "largest resident memory"),
    field("best", &PointResult::best, "",
          "the fastest step of its contestant at its place on the axis, whatever its motion"),
    field("best_at_errors", &PointResult::best_at_errors, "scene's size",
          "levels of error within which it is the fastest step of its contestant at its place"),
    field("at_ladder_end", &PointResult::at_ladder_end, "",
          "of a best point: 'coarsest' or 'finest' where its step is that end of the ladder")};

inline constexpr FieldTraits in_phases{.inside = "phases"};
inline constexpr std::tuple phase_fields{
    field("unconstrained", &inextensible::PhaseSeconds::unconstrained, "s",
          "wall time of one run in steps without constraints", in_phases),
    field("filter", &inextensible::PhaseSeconds::filter, "s",
          "wall time of the same run in the velocity filter", in_phases),
    field("collision", &inextensible::PhaseSeconds::collision, "s",
          "wall time of the same run in the collision filter", in_phases),
    field("contact", &inextensible::PhaseSeconds::contact, "s",
          "what of these three goes to friction, to finding contacts and to planes", in_phases),
    field("copy", &inextensible::PhaseSeconds::copy, "s",
          "wall time of the same run in copying the state into an engine and out of it",
          in_phases)};

}  // namespace harness
