#include "harness/judge/ensemble_runs.h"

#include <algorithm>

#include "harness/base/text.h"
#include "harness/judge/energy.h"
#include "harness/judge/mechanics.h"
#include "harness/judge/reference_routes.h"
#include "solvers/registry.h"

namespace harness {

namespace {

// Empty where energy is made out of nothing, by the rule that runs of a sweep fail by.
ShapeSeries shapes_along(const Scene& scene, const inextensible::State& start, const Route& route,
                         double h, const std::vector<double>& times, const Tell& tell) {
  const auto velocities = inextensible::find_backend(route.solver)->velocities;
  ShapeRecord record(scene, times, velocities);
  EnergyRecord energy(*scene.problem, energy_scale(scene), velocities);
  energy.begin(scene.start);
  follow(scene, start, route, h, times, tell, [&](const inextensible::State& state, bool sampled) {
    if (sampled) record.sample(state.x);
    record.step(state, h);
    energy.after(state, h);
  });
  energy.finish();
  const double rise = energy_can_only_fall(*scene.problem) ? energy.rise() : 0;
  if (std::max(energy.gain(), rise) > scene.energy_bound) {
    tell(route.solver + " is left out: its energy rises " + number_text(energy.gain(), 2) +
         " of weight times size above the start's at t = " + number_text(energy.gain_time(), 3) +
         " s, and " + number_text(rise, 2) + " in all where it can only fall");
    return {};
  }
  return record.finish();
}

std::string too_few(int came, int started) {
  return "only " + std::to_string(came) + " of " + std::to_string(started) +
         " reference runs came to the end without fault, an ensemble needs " +
         std::to_string(fewest_runs);
}

}  // namespace

Ensemble compute_ensemble(const Scene& scene, const std::vector<double>& times,
                          const EnsemblePlan& plan, const Tell& tell, const KeepRun& keep) {
  const auto& lengths = scene.problem->rest_length();
  const double edge = *std::min_element(lengths.begin(), lengths.end());
  const int count = plan.runs_of_a_route;
  const auto starts = moved_starts(scene, plan.moved * edge, 2 * count);
  const auto [first, second] = contact_routes(scene, plan.step);
  std::vector<ShapeSeries> runs;
  std::vector<std::string> methods;
  int started = 0;
  for (const Route& route : {first, second}) {
    const std::string method = route.solver + ", strain limit " + number_text(route.limit) +
                               ", step " + number_text(plan.step) + " s";
    int came = 0;
    for (int k = 0; k < count; ++k, ++started) {
      const std::string start = "start " + std::to_string(started + 1) + " of the ensemble";
      const RouteRun& run =
          keep(method + ", " + start + ", moved by " + number_text(plan.moved) + " of an edge, " +
                   std::to_string(times.size()) + " samples",
               [&] {
                 tell(start);
                 RouteRun made;
                 made.shape = shapes_along(scene, starts[static_cast<std::size_t>(started)], route,
                                           plan.step, times, tell);
                 return made;
               });
      if (run.shape.size() < times.size()) continue;
      runs.push_back(run.shape);
      ++came;
    }
    methods.push_back(method + ", " + std::to_string(came) + " of " + std::to_string(count) +
                      " runs");
  }
  const int all = static_cast<int>(runs.size());
  Ensemble ensemble;
  if (all >= fewest_runs) {
    ensemble = ensemble_of(runs);
  } else {
    ensemble.runs = all;
    ensemble.unknown_because = too_few(all, started);
  }
  ensemble.methods = methods;
  ensemble.moved = plan.moved;
  return ensemble;
}

}  // namespace harness
