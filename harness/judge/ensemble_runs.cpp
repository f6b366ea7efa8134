#include <algorithm>

#include "harness/base/text.h"
#include "harness/judge/energy.h"
#include "harness/judge/mechanics.h"
#include "harness/judge/reference_routes.h"
#include "solvers/registry.h"

namespace harness {

using inextensible::State;

namespace {

// Empty where energy is made out of nothing, by the rule that runs of a sweep fail by.
ShapeSeries shapes_along(const Scene& scene, const State& start, const Route& route, double h,
                         const std::vector<double>& times, const RouteRuns& runs) {
  const auto velocities = inextensible::find_backend(route.solver)->velocities;
  ShapeRecord record(scene, times, velocities);
  EnergyRecord energy(*scene.problem, energy_scale(scene), velocities);
  energy.begin(scene.start);
  follow(scene, start, route, h, times, runs, [&](const State& state, bool sampled) {
    if (sampled) record.sample(state.x);
    record.step(state, h);
    energy.after(state, h);
  });
  energy.finish();
  const double rise = energy_can_only_fall(*scene.problem) ? energy.rise() : 0;
  if (std::max(energy.gain(), rise) <= scene.energy_bound) return record.finish();
  runs.tell(route.solver + " is left out: its energy rises " + number_text(energy.gain(), 2) +
            " of weight times size above the start's at t = " + number_text(energy.gain_time(), 3) +
            " s, and " + number_text(rise, 2) + " in all where it can only fall");
  return {};
}

}  // namespace

Ensemble compute_ensemble(const Scene& scene, const std::vector<double>& times,
                          const EnsemblePlan& plan, RouteRuns& runs) {
  const double edge = scene.problem->shortest_rest_length();
  const int count = plan.runs_of_a_route;
  const auto starts = moved_starts(scene, plan.moved * edge, 2 * count);
  const auto [first, second] = contact_routes(scene, plan.step);
  std::vector<ShapeSeries> shapes;
  std::vector<std::string> methods;
  std::size_t started = 0;
  for (const Route& route : {first, second}) {
    const std::string method = route.name() + ", step " + number_text(plan.step) + " s";
    const std::size_t before = shapes.size();
    for (int k = 0; k < count; ++k) {
      const State& from = starts[started++];
      const std::string start = "start " + std::to_string(started) + " of the ensemble";
      const RouteRun& run =
          runs.run(method + ", " + start + ", moved by " + number_text(plan.moved) +
                       " of an edge, " + std::to_string(times.size()) + " samples",
                   [&] {
                     runs.tell(start);
                     RouteRun made;
                     made.shape = shapes_along(scene, from, route, plan.step, times, runs);
                     return made;
                   });
      if (run.shape.size() == times.size()) shapes.push_back(run.shape);
    }
    methods.push_back(method + ", " + std::to_string(shapes.size() - before) + " of " +
                      std::to_string(count) + " runs");
  }
  Ensemble ensemble;
  if (shapes.size() >= fewest_runs) {
    ensemble = ensemble_of(shapes);
  } else {
    ensemble.runs = static_cast<int>(shapes.size());
    ensemble.unknown_because = "only " + std::to_string(shapes.size()) + " of " +
                               std::to_string(started) +
                               " reference runs came to the end without fault, an ensemble needs " +
                               std::to_string(fewest_runs);
  }
  ensemble.methods = std::move(methods);
  ensemble.moved = plan.moved;
  return ensemble;
}

}  // namespace harness
