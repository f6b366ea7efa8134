#include "result_file.h"

#include <cmath>

#include "files.h"
#include "usage_error.h"

namespace harness {
namespace {

using nlohmann::json;

json seconds_json(const std::vector<double>& samples) {
  if (samples.empty()) return nullptr;
  return {{"median", quantile(samples, 0.5)},
          {"min", quantile(samples, 0)},
          {"q1", quantile(samples, 0.25)},
          {"q3", quantile(samples, 0.75)},
          {"samples", samples}};
}

// series: with the residual over time; one sweep that holds it is enough.
json error_json(const Verdict& v, bool series) {
  json residuals = json::array();
  if (series) {
    for (const auto& r : v.residuals) residuals.push_back({r.time, r.first, r.last});
  }
  return {{"energy_drift", number(v.energy_drift)},
          {"symmetry_defect", number(v.symmetry_defect)},
          {"reference", v.reference.empty() ? json(nullptr) : json(v.reference)},
          {"trajectory", number(v.trajectory)},
          {"trajectory_max", number(v.trajectory_max)},
          {"gap", number(v.gap)},
          {"valid_until", number(v.valid_until)},
          {"shape_potential_energy", number(v.shape_potential_energy)},
          {"shape_corner_height", number(v.shape_corner_height)},
          {"shape_shadow", number(v.shape_shadow)},
          {"residual_first", number(v.residual_first)},
          {"residual_last", number(v.residual_last)},
          {"residuals", residuals}};
}

// One entry a repetition, in Google Benchmark's own format; compare.py reads them.
void add_benchmarks(json& list, const PointResult& point, int family) {
  for (std::size_t i = 0; i < point.samples.size(); ++i) {
    const double microseconds = point.samples[i] * 1e6;
    list.push_back({{"name", point.spec.id()},
                    {"run_name", point.spec.id()},
                    {"run_type", "iteration"},
                    {"family_index", family},
                    {"per_family_instance_index", 0},
                    {"repetitions", point.samples.size()},
                    {"repetition_index", i},
                    {"threads", 1},
                    {"iterations", 1},
                    {"real_time", microseconds},
                    {"cpu_time", microseconds},
                    {"time_unit", "us"}});
  }
}

}  // namespace

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json to_json(const inextensible::WorkCounters& w) {
  return {{"steps", w.steps},
          {"rejected_steps", w.rejected_steps},
          {"iterations", w.iterations},
          {"assemblies", w.assemblies},
          {"factorizations", w.factorizations},
          {"back_solves", w.back_solves},
          {"edge_projections", w.edge_projections},
          {"line_search_steps", w.line_search_steps},
          {"spring_evaluations", w.spring_evaluations},
          {"triangle_tests", w.triangle_tests},
          {"contacts", w.contacts},
          {"factor_nonzeros", w.factor_nonzeros},
          {"factor_flops", w.factor_flops}};
}

json to_json(const PointResult& point) {
  const PointSpec& spec = point.spec;
  const Verdict& v = point.verdict;
  json options = to_json(spec.settings);
  if (point.stiffness) options["stiffness"] = *point.stiffness;
  json work = to_json(point.work);
  work["calibration_runs"] = point.calibration_runs;
  if (!point.linear_solver.empty()) options["linear_solver"] = point.linear_solver;
  return {{"id", spec.id()},
          {"sweep", spec.sweep},
          {"scene", spec.scene},
          {"solver", spec.solver},
          {"options", options},
          {"scene_parameters", spec.scene_parameters},
          {"resolution", spec.resolution},
          {"vertices", spec.vertices},
          {"constraints", spec.constraints},
          {"strain_limit", spec.strain_limit},
          {"step", spec.step},
          {"adaptive", spec.adaptive},
          {"smallest_step", number(point.smallest_step)},
          {"duration", spec.scene_parameters.at("duration")},
          {"seed", spec.seed},
          {"status", to_string(point.status)},
          {"status_detail", point.detail},
          {"seconds_per_simulated_second", seconds_json(point.samples)},
          {"setup_seconds", point.setup_seconds},
          {"calibration_seconds", point.calibration_seconds},
          {"phases",
           {{"unconstrained", point.phases.unconstrained},
            {"filter", point.phases.filter},
            {"collision", point.phases.collision}}},
          {"max_strain", number(v.max_strain)},
          {"max_stretch", number(v.max_stretch)},
          {"p99_strain", number(v.p99_strain)},
          {"rms_strain", number(v.rms_strain)},
          {"max_strain_after_collision", number(v.max_strain_after_collision)},
          {"kinetic_energy_mean", number(v.kinetic_energy_mean)},
          {"error", error_json(v, spec.sweep == "step")},
          {"work", work},
          {"peak_rss_bytes", point.peak_rss_bytes},
          {"best", point.best},
          {"best_at_error", point.best_at_error}};
}

json result_document(json context, const Suite& suite, const std::vector<std::string>& command,
                     bool complete, const std::vector<PointResult>& points, json references) {
  context["command"] = command;
  context["suite"] = to_json(suite);
  context["seed"] = suite.seed;
  json list = json::array(), benchmarks = json::array();
  int family = 0;
  for (const PointResult& point : points) {
    list.push_back(to_json(point));
    if (point.ok()) add_benchmarks(benchmarks, point, family++);
  }
  return {{"schema", "inextensible-bench/1"},
          {"complete", complete},
          {"context", context},
          {"points", list},
          {"references", std::move(references)},
          {"benchmarks", benchmarks}};
}

json read_result(const std::string& path) {
  return parse_result(read_file(path, "result file"), path);
}

json parse_result(const std::string& text, const std::string& path) {
  try {
    json document = json::parse(text);
    const std::string schema = document.is_object() ? document.value("schema", "") : "";
    if (schema != "inextensible-bench/1" && schema != "inextensible-stability/1")
      throw UsageError("'" + path +
                       "' is not a result file: its schema is neither \"inextensible-bench/1\" nor "
                       "\"inextensible-stability/1\"");
    return document;
  } catch (const json::exception& error) {
    throw UsageError("'" + path + "' is not a result file: " + error.what());
  }
}

}  // namespace harness
