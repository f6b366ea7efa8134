#include "harness/points/point_json.h"

#include <cmath>

#include "harness/points/suite.h"

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

json error_json(const Measures& v) {
  json residuals = json::array();
  for (const auto& r : v.residuals) residuals.push_back({r.time, r.first, r.last});
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

inextensible::Settings settings_of(const json& object) {
  inextensible::Settings settings;
  for (const auto& [name, value] : object.items()) {
    if (value.is_string()) {
      settings[name] = value.get<std::string>();
    } else {
      settings[name] = value.get<double>();
    }
  }
  return settings;
}

PointStatus status_of(const std::string& text) {
  for (int i = 0; i <= static_cast<int>(PointStatus::skipped); ++i) {
    if (text == to_string(static_cast<PointStatus>(i))) return static_cast<PointStatus>(i);
  }
  throw json::other_error::create(501, "'" + text + "' is no status of a point", nullptr);
}

Measures measures_of(const json& p) {
  const json& e = p.at("error");
  Measures v;
  v.max_strain = number_of(p.at("max_strain"));
  v.max_stretch = number_of(p.at("max_stretch"));
  v.p99_strain = number_of(p.at("p99_strain"));
  v.rms_strain = number_of(p.at("rms_strain"));
  v.max_strain_after_collision = number_of(p.at("max_strain_after_collision"));
  v.kinetic_energy_mean = number_of(p.at("kinetic_energy_mean"));
  v.energy_drift = number_of(e.at("energy_drift"));
  v.symmetry_defect = number_of(e.at("symmetry_defect"));
  if (e.at("reference").is_string()) v.reference = e.at("reference");
  v.trajectory = number_of(e.at("trajectory"));
  v.trajectory_max = number_of(e.at("trajectory_max"));
  v.gap = number_of(e.at("gap"));
  v.valid_until = number_of(e.at("valid_until"));
  v.shape_potential_energy = number_of(e.at("shape_potential_energy"));
  v.shape_corner_height = number_of(e.at("shape_corner_height"));
  v.shape_shadow = number_of(e.at("shape_shadow"));
  v.residual_first = number_of(e.at("residual_first"));
  v.residual_last = number_of(e.at("residual_last"));
  for (const json& r : e.at("residuals"))
    v.residuals.push_back({number_of(r.at(0)), number_of(r.at(1)), number_of(r.at(2))});
  return v;
}

}  // namespace

double number_of(const json& value) { return value.is_null() ? unknown : value.get<double>(); }

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json to_json(const inextensible::WorkCounters& w) {
  return {{"steps", w.steps},
          {"rejected_steps", w.rejected_steps},
          {"iterations", w.iterations},
          {"assemblies", w.assemblies},
          {"factorizations", w.factorizations},
          {"back_solves", w.back_solves},
          {"linear_iterations", w.linear_iterations},
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
  const Measures& v = point.measures;
  const json settings = to_json(spec.settings);  // of the suite
  json options = settings;
  if (point.stiffness) options["stiffness"] = *point.stiffness;
  json work = to_json(point.work);
  work["calibration_runs"] = point.calibration_runs;
  if (!point.linear_solver.empty()) options["linear_solver"] = point.linear_solver;
  return {{"id", spec.id()},
          {"sweep", spec.sweep},
          {"scene", spec.scene},
          {"solver", spec.solver},
          {"options", options},
          {"settings", settings},
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
          {"error", error_json(v)},
          {"work", work},
          {"peak_rss_bytes", point.peak_rss_bytes},
          {"best", point.best},
          {"best_at_error", point.best_at_error}};
}

inextensible::WorkCounters work_of(const json& w) {
  inextensible::WorkCounters work;
  w.at("steps").get_to(work.steps);
  w.at("rejected_steps").get_to(work.rejected_steps);
  w.at("iterations").get_to(work.iterations);
  w.at("assemblies").get_to(work.assemblies);
  w.at("factorizations").get_to(work.factorizations);
  w.at("back_solves").get_to(work.back_solves);
  work.linear_iterations = w.value("linear_iterations", std::int64_t{0});
  w.at("edge_projections").get_to(work.edge_projections);
  w.at("line_search_steps").get_to(work.line_search_steps);
  w.at("spring_evaluations").get_to(work.spring_evaluations);
  w.at("triangle_tests").get_to(work.triangle_tests);
  w.at("contacts").get_to(work.contacts);
  w.at("factor_nonzeros").get_to(work.factor_nonzeros);
  w.at("factor_flops").get_to(work.factor_flops);
  return work;
}

PointSpec spec_of(const json& p) {
  PointSpec spec;
  p.at("sweep").get_to(spec.sweep);
  p.at("scene").get_to(spec.scene);
  p.at("scene_parameters").get_to(spec.scene_parameters);
  p.at("resolution").get_to(spec.resolution);
  p.at("vertices").get_to(spec.vertices);
  p.at("constraints").get_to(spec.constraints);
  p.at("solver").get_to(spec.solver);
  spec.settings = settings_of(p.value("settings", json::object()));
  p.at("strain_limit").get_to(spec.strain_limit);
  p.at("step").get_to(spec.step);
  spec.adaptive = p.value("adaptive", false);
  p.at("seed").get_to(spec.seed);
  return spec;
}

PointResult point_of(const json& p) {
  PointResult point;
  point.spec = spec_of(p);
  point.status = status_of(p.at("status"));
  p.at("status_detail").get_to(point.detail);
  if (const json& seconds = p.at("seconds_per_simulated_second"); !seconds.is_null())
    seconds.at("samples").get_to(point.samples);
  p.at("setup_seconds").get_to(point.setup_seconds);
  p.at("calibration_seconds").get_to(point.calibration_seconds);
  const json& options = p.at("options");
  if (options.contains("stiffness") && !point.spec.settings.contains("stiffness"))
    point.stiffness = options.at("stiffness").get<double>();
  point.linear_solver = options.value("linear_solver", "");
  const json& phases = p.at("phases");
  phases.at("unconstrained").get_to(point.phases.unconstrained);
  phases.at("filter").get_to(point.phases.filter);
  phases.at("collision").get_to(point.phases.collision);
  point.work = work_of(p.at("work"));
  point.calibration_runs = p.at("work").value("calibration_runs", 0);
  point.measures = measures_of(p);
  point.smallest_step = number_of(p.value("smallest_step", json(nullptr)));
  point.steps_planned =
      static_cast<int>(std::lround(p.at("duration").get<double>() / point.spec.step));
  p.at("peak_rss_bytes").get_to(point.peak_rss_bytes);
  p.at("best").get_to(point.best);
  point.best_at_error = p.value("best_at_error", false);
  return point;
}

}  // namespace harness
