#include "harness/judge/reference_routes.h"

#include <algorithm>
#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/judge/mechanics.h"
#include "harness/judge/route_runs.h"
#include "harness/points/measures.h"
#include "harness/scenes/pendulum.h"
#include "solvers/registry.h"

namespace harness {

using inextensible::Positions;

namespace {

constexpr double perturbation = 1e-10;             // of a start, over the scene's size
constexpr int moved_start_count = 2;               // how many disturbed starts a route is run from
constexpr double surely_known = 0.01 / sure_gaps;  // gap up to which an order is looked for
constexpr double pendulum_tolerance = 1e-13;

// This is the one place that names methods: which to trust for a scene is the maintainer's
// judgement, which no property of a row can replace.
//
// Second route of a pendulum, beside its angles.
Route smooth_route() { return {"rattle", 1e-12, 2}; }
// Where a collider makes kinks anyway. RATTLE does not survive a J W J^T that is singular at the
// start (a row straight between its pins: the patch); BDF2 takes its place then, at a limit that
// keeps off the singularity.
Route contact_route() { return {"rattle", 1e-9, 1}; }
const inextensible::Settings some_passes{{"min_iterations", 1.0}, {"smoothing_sweeps", 30.0}};
// Friction inside the solve is no smooth function of the start, and RATTLE's small steps along old
// directions get stuck on it; the passes that correct it set the limit.
Route contact_inside_route() { return {"fast_projection@bdf2", 1e-5, 1, some_passes}; }
Route contact_route_when_singular() { return {"fast_projection@bdf2", 1e-6, 1, some_passes}; }
// The second one there, at the first one's limit. The two differ in the direction of constraint
// forces, the velocity's place in the step and the linear solver.
Route second_contact_route(const Route& first) { return {"icd", first.limit, 1}; }

constexpr const char* between_routes = "routes";
constexpr const char* of_first_step = "half_step";
constexpr const char* of_second_step = "second_half_step";
constexpr const char* of_starts = "moved_start";

std::size_t valid_samples(const Reference& r) {
  std::size_t valid = 0;
  while (valid < r.gap.size() && r.times[valid] <= r.valid_until) ++valid;
  return valid;
}

Pendulum pendulum_of(const Scene& scene, double disturbance) {
  const auto& problem = *scene.problem;
  Pendulum::Links links;
  std::vector<double> angles;
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    links.length.push_back(problem.rest_length()[k]);
    links.mass.push_back(problem.mass()[k + 1]);
    angles.push_back(k % 2 == 0 ? disturbance : 0.0);
  }
  links.gravity = -problem.gravity().y();
  return Pendulum(std::move(links), std::move(angles));
}

const RouteRun& swing(const Task& task, double disturbance, double tolerance) {
  return task.keep("pendulum, start moved by " + number_text(disturbance) + ", tolerance " +
                       number_text(tolerance),
                   [&] {
                     task.tell("pendulum in angles, tolerance " + number_text(tolerance) + " ...");
                     Pendulum pendulum = pendulum_of(task.scene, disturbance);
                     const double start = pendulum.energy(), scale = energy_scale(task.scene);
                     RouteRun run;
                     for (const double time : task.r.times) {
                       pendulum.advance(time, tolerance);
                       run.path.push_back(pendulum.positions());
                       run.energy_drift =
                           std::max(run.energy_drift, std::abs(pendulum.energy() - start) / scale);
                     }
                     return run;
                   });
}

void compute_chain(const Task& task) {
  Reference& r = task.r;
  const RouteRun& swung = swing(task, 0, pendulum_tolerance);
  const Path& path = swung.path;
  r.energy_drift = swung.energy_drift;
  const Route route = smooth_route();
  const Path& coarse = path_to_the_end(task, route, 4 * task.finest);
  const Path& middle = path_to_the_end(task, route, 2 * task.finest);
  const Path& fine = path_to_the_end(task, route, task.finest);
  const std::size_t all = r.times.size();
  r.observed_order = std::log2(mean_distance(task.scene, coarse, middle, all) /
                               mean_distance(task.scene, middle, fine, all));
  const Path second = extrapolated(middle, fine, route.order);
  const Path second_half = extrapolated(coarse, middle, route.order);
  r.method = "N-link pendulum in angles, GSL rk8pd, tolerance " + number_text(pendulum_tolerance);
  r.second_method = route.solver + ", strain limit " + number_text(route.limit) +
                    ", steps down to " + number_text(task.finest) +
                    " s, Richardson extrapolated with order " + std::to_string(route.order);
  // An integrator that chooses its steps has no half of them: its tolerance is ten times as large.
  std::vector<GapPart> parts{{between_routes, &path, &second},
                             {of_first_step, &path, &swing(task, 0, 10 * pendulum_tolerance).path},
                             {of_second_step, &second, &second_half}};
  for (int k = 0; k < moved_start_count; ++k)
    parts.push_back({of_starts, &path,
                     &swing(task, (k % 2 == 0 ? 1 : -1) * perturbation, pendulum_tolerance).path});
  add_gaps(r, task.scene, parts);
  r.positions = path;
}

// The first route where there is no smooth motion in angles.
Route first_contact_route(const Scene& scene, double h) {
  // The others take no implicit forces either.
  if (scene.problem->contact_inside() || scene.problem->implicit_forces())
    return contact_inside_route();
  Route route = contact_route();
  inextensible::State state = scene.start;
  const auto stepper =
      inextensible::make_stepper(route.solver, scene.problem, {route.limit, 1, route.settings});
  if (stepper->advance(state, h)) return route;
  return contact_route_when_singular();
}

// The order with which the second route comes to the first one as its step is halved, from steps
// coarse enough to see it: those at which its distance is above the gap. Finer ones are as near as
// any two runs come, and differ by chance. Unknown if there are fewer than two.
double order_towards(const Task& task, const Path& fine, const Route& second) {
  const Reference& r = task.r;
  std::size_t sure = 0;
  double gap_squares = 0;
  for (; sure < std::min(fine.size(), r.gap.size()) && r.gap[sure] < surely_known; ++sure)
    gap_squares += r.gap[sure] * r.gap[sure];
  if (sure == 0) return unknown;
  const double gap = std::sqrt(gap_squares / static_cast<double>(sure));
  std::vector<double> halvings, logarithms;
  for (const int factor : {128, 64, 32, 16, 8, 4}) {
    const double steps = sample_interval / (factor * task.finest);
    if (std::abs(steps - std::round(steps)) > 1e-6) continue;  // it would miss the samples
    const Path& path = kept_path(task, task.scene.start, 0, second, factor * task.finest, sure);
    if (path.size() < sure) continue;
    const double distance = mean_distance(task.scene, path, fine, sure);
    if (!(distance > sure_gaps * gap)) break;
    halvings.push_back(-std::log2(factor));
    logarithms.push_back(-std::log2(distance));
  }
  if (halvings.size() < 2) return unknown;
  return (logarithms.back() - logarithms.front()) / (halvings.back() - halvings.front());
}

// After the gap's samples, where a route has ended, distances are the first route's alone.
void add_later_gaps(Reference& r, const Scene& scene, const Path& fine, const Path& half,
                    const Path& second) {
  for (std::size_t i = r.gap.size(); i < r.times.size(); ++i) {
    const Positions& other = i < second.size() ? second[i] : half[i];
    r.gap.push_back(rms_distance(scene, fine[i], other));
    r.gap_max.push_back(max_distance(scene, fine[i], other));
  }
}

// Where a collider makes kinks neither route is better than first order.
void compute_contact(const Task& task) {
  Reference& r = task.r;
  const double h = task.finest;
  const auto [first, other] = contact_routes(task.scene, h);
  const Path& fine = path_to_the_end(task, first, h);
  const Path& half = path_to_the_end(task, first, 2 * h);
  const Path& second_coarsest = path_of(task, other, 8 * h);
  const Path& second_coarse = path_of(task, other, 4 * h);
  const Path& second_fine = path_of(task, other, 2 * h);
  const Path second = extrapolated(second_coarse, second_fine, other.order);
  const Path second_half = extrapolated(second_coarsest, second_coarse, other.order);
  std::vector<GapPart> parts{{between_routes, &fine, &second},
                             {of_first_step, &fine, &half},
                             {of_second_step, &second, &second_half}};
  const auto starts = moved_starts(task.scene, perturbation * task.scene.size, moved_start_count);
  for (int k = 0; k < moved_start_count; ++k)
    parts.push_back(
        {of_starts, &fine,
         &kept_path(task, starts[static_cast<std::size_t>(k)], k + 1, first, h, r.times.size())});
  add_gaps(r, task.scene, parts);
  r.observed_order = order_towards(task, fine, other);
  r.method = first.solver + ", strain limit " + number_text(first.limit) + ", step " +
             number_text(h) + " s";
  r.second_method = other.solver + ", strain limit " + number_text(other.limit) + ", steps " +
                    number_text(4 * h) + " and " + number_text(2 * h) +
                    " s, Richardson extrapolated with order " + std::to_string(other.order);
  if (second.size() < r.times.size())
    r.second_method += ", until it fails after t = " +
                       number_text(second.empty() ? 0.0 : r.times[second.size() - 1]) + " s";
  add_later_gaps(r, task.scene, fine, half, second);
  r.positions = fine;
}

// All but paths and gaps.
Reference begun(const std::string& name, const SceneParameters& complete, const Scene& scene) {
  Reference r;
  r.scene = name;
  r.parameters = complete;
  r.times = sample_times(scene.duration);
  r.expected_order = expected_order(&*find_scene(name));
  if (r.times.empty())
    throw UsageError("a reference needs a duration of at least " + number_text(sample_interval) +
                     " s");
  return r;
}

KeepRun keep_in(std::map<std::string, RouteRun>& known) {
  return [&known](const std::string& name, const auto& compute) -> const RouteRun& {
    const auto place = known.find(name);
    return place != known.end() ? place->second : known.emplace(name, compute()).first->second;
  };
}

}  // namespace

std::pair<Route, Route> contact_routes(const Scene& scene, double h) {
  const Route first = first_contact_route(scene, h);
  return {first, second_contact_route(first)};
}

Reference compute_reference(const std::string& scene_name, const SceneParameters& complete,
                            double finest, const Tell& tell, const KeepRun& keep) {
  const auto found_type = find_scene(scene_name);
  const SceneType& type = *found_type;
  const Scene scene = type.build(complete);
  Reference r = begun(scene_name, complete, scene);
  std::map<std::string, RouteRun> known;
  const KeepRun in_memory = keep_in(known);
  if (!(finest > 0)) finest = sample_interval / (type.pendulum ? 1024 : 640);
  // The coarsest run of each route must meet the sample times.
  const double coarsest = (type.pendulum ? 4 : 8) * finest, steps = sample_interval / coarsest;
  if (!(steps >= 1) || std::abs(steps - std::round(steps)) > 1e-6)
    throw UsageError(
        "--finest is " + number_text(finest) + " s: " + number_text(coarsest / finest) +
        " of such steps must divide the sample interval, " + number_text(sample_interval) + " s");
  const Task task{r, scene, finest, tell, keep ? keep : in_memory};
  if (type.pendulum) {
    compute_chain(task);
  } else {
    compute_contact(task);
  }
  r.positions.resize(valid_samples(r));
  return r;
}

Reference finer_run(const std::string& scene_name, const SceneParameters& complete,
                    const Tell& tell) {
  const Scene scene = find_scene(scene_name)->build(complete);
  Reference r = begun(scene_name, complete, scene);
  std::map<std::string, RouteRun> known;
  const KeepRun in_memory = keep_in(known);
  constexpr double h = sample_interval / 16;
  const Task task{r, scene, h, tell, in_memory};
  const Route route = first_contact_route(scene, h);
  const Path& fine = path_to_the_end(task, route, h);
  const Path& half = path_to_the_end(task, route, 2 * h);
  const auto starts = moved_starts(scene, perturbation * scene.size, 1);
  const Path& moved = kept_path(task, starts.front(), 1, route, h, r.times.size());
  add_gaps(r, scene, {{of_first_step, &fine, &half}, {of_starts, &fine, &moved}});
  r.method = route.solver + ", strain limit " + number_text(route.limit) + ", step " +
             number_text(h) + " s, alone";
  r.second_method = "none";
  r.observed_order = unknown;
  r.positions = fine;
  r.positions.resize(valid_samples(r));
  return r;
}

}  // namespace harness
