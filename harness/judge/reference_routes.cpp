#include "harness/judge/reference_routes.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <algorithm>
#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/judge/measures.h"
#include "harness/points/measures.h"
#include "harness/scenes/pendulum.h"
#include "inextensible/registry.h"
#include "inextensible/systems/constrained_acceleration.h"

namespace harness {

using inextensible::Positions;

namespace {

constexpr double perturbation = 1e-10;  // of a start, over the scene's size
constexpr double parted = 1e-2;         // gap at which a reference ends, over the scene's size
constexpr double surely_known = 1e-3;   // gap up to which an order is looked for
constexpr double pendulum_tolerance = 1e-13;

// A route that steps. This is the one place that names methods: whom to trust for a scene is the
// maintainer's judgement, which no property of a row can replace.
struct Route {
  std::string solver;
  double limit;  // of strain
  int order;     // of the error that Richardson's rule takes away
};
// Of a pendulum, beside its angles.
Route smooth_route() { return {"rattle", 1e-12, 2}; }
// Where a collider makes kinks anyway. RATTLE does not survive a J W J^T that is singular at the
// start (a row straight between its pins: the patch); BDF2 takes its place then, at a limit that
// keeps off the singularity.
Route contact_route() { return {"rattle", 1e-9, 1}; }
// Friction inside the solve is no smooth function of the start, and RATTLE's small steps along old
// directions get stuck on it; sweeps that mend it set the limit.
Route contact_inside_route() { return {"fast_projection_bdf2", 1e-5, 1}; }
Route contact_route_when_singular() { return {"fast_projection_bdf2", 1e-6, 1}; }
// The second one there, at the first one's limit. The two differ in the direction of constraint
// forces, the velocity's place in the step and the linear solver.
Route second_contact_route(const Route& first) { return {"icd", first.limit, 1}; }

using Tell = std::function<void(const std::string&)>;
using Path = std::vector<Positions>;  // at the sample times

// A backend's path at the sample times, up to where it fails; h divides the sample interval.
Path follow(const Scene& scene, const inextensible::State& start, const Route& route, double h,
            const std::vector<double>& times, const Tell& tell) {
  const std::string& solver = route.solver;
  const auto stepper = inextensible::make_stepper(solver, scene.problem, {route.limit, 1, {}});
  const bool half =
      inextensible::find_backend(solver)->velocities == inextensible::Velocities::half_step;
  inextensible::State state =
      half ? inextensible::start_half_step_back(*scene.problem, start, h) : start;
  const auto per_sample = std::lround(sample_interval / h);
  Path path;
  tell(solver + ", h = 1/" + number_text(std::round(1 / h)) + " s ...");
  for (const double time : times) {
    for (long i = 0; i < per_sample; ++i) {
      const auto result = stepper->advance(state, h);
      if (!result) {
        tell(solver + ", h = 1/" + number_text(std::round(1 / h)) +
             " s stopped before t = " + number_text(time) +
             " s: " + inextensible::to_string(result.status) + ", " + result.detail);
        return path;
      }
    }
    path.push_back(state.x);
  }
  return path;
}

Path follow_to_the_end(const Scene& scene, const Route& route, double h,
                       const std::vector<double>& times, const Tell& tell) {
  Path path = follow(scene, scene.start, route, h, times, tell);
  if (path.size() < times.size())
    throw UsageError("no reference: " + route.solver + " with h = " + number_text(h) +
                     " s fails before t = " + number_text(times[path.size()]) +
                     " s (a smaller --finest may help)");
  return path;
}

// p (finer) beyond itself by Richardson's rule, where the error is of this order.
Path extrapolated(const Path& coarse, const Path& fine, int order) {
  Path path;
  const double factor = 1 / (std::pow(2.0, order) - 1);
  for (std::size_t i = 0; i < fine.size(); ++i)
    path.push_back(fine[i] + factor * (fine[i] - coarse[i]));
  return path;
}

double mean_distance(const Scene& scene, const Path& a, const Path& b, std::size_t count) {
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) squares += std::pow(rms_distance(scene, a[i], b[i]), 2);
  return std::sqrt(squares / static_cast<double>(count));
}

// How far `path` may be off at each sample that both others reach: it is not known better than a
// second route agrees with it, nor than it agrees with itself from a disturbed start.
void add_gaps(Reference& r, const Scene& scene, const Path& path, const Path& second,
              const Path& disturbed) {
  for (std::size_t i = 0; i < std::min({path.size(), second.size(), disturbed.size()}); ++i) {
    r.gap.push_back(std::max(rms_distance(scene, path[i], second[i]),
                             rms_distance(scene, path[i], disturbed[i])));
    r.gap_max.push_back(std::max(max_distance(scene, path[i], second[i]),
                                 max_distance(scene, path[i], disturbed[i])));
  }
  r.valid_until = 0;
  for (std::size_t i = 0; i < r.gap.size() && r.gap[i] < parted; ++i) r.valid_until = r.times[i];
}

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

Path swing(const Scene& scene, double disturbance, const std::vector<double>& times,
           double* energy_drift) {
  Pendulum pendulum = pendulum_of(scene, disturbance);
  const double start = pendulum.energy();
  const double scale = energy_scale(scene);
  Path path;
  for (const double time : times) {
    pendulum.advance(time, pendulum_tolerance);
    path.push_back(pendulum.positions());
    if (energy_drift)
      *energy_drift = std::max(*energy_drift, std::abs(pendulum.energy() - start) / scale);
  }
  return path;
}

void compute_chain(Reference& r, const Scene& scene, double finest, const Tell& tell) {
  tell("pendulum in angles, tolerance " + number_text(pendulum_tolerance) + " ...");
  const Path path = swing(scene, 0, r.times, &r.energy_drift);
  const Path disturbed = swing(scene, perturbation, r.times, nullptr);
  const Route route = smooth_route();
  const Path coarse = follow_to_the_end(scene, route, 4 * finest, r.times, tell);
  const Path middle = follow_to_the_end(scene, route, 2 * finest, r.times, tell);
  const Path fine = follow_to_the_end(scene, route, finest, r.times, tell);
  const std::size_t all = r.times.size();
  r.observed_order = std::log2(mean_distance(scene, coarse, middle, all) /
                               mean_distance(scene, middle, fine, all));
  const Path second = extrapolated(middle, fine, route.order);
  r.method = "N-link pendulum in angles, GSL rk8pd, tolerance " + number_text(pendulum_tolerance);
  r.second_method = route.solver + ", strain limit " + number_text(route.limit) +
                    ", steps down to " + number_text(finest) +
                    " s, Richardson extrapolated with order " + std::to_string(route.order);
  add_gaps(r, scene, path, second, disturbed);
  for (std::size_t i = 0; i < all; ++i) {
    r.shape.push_back(shape_statistics(scene, path[i]));
    r.shape_gap.push_back({});
  }
  r.positions = path;
}

// The first route where there is no smooth motion in angles.
Route first_contact_route(const Scene& scene, double h) {
  if (scene.problem->contact_inside()) return contact_inside_route();
  Route route = contact_route();
  inextensible::State state = scene.start;
  const auto stepper =
      inextensible::make_stepper(route.solver, scene.problem, {route.limit, 1, {}});
  if (stepper->advance(state, h)) return route;
  return contact_route_when_singular();
}

// The order with which the second route comes to the first one as its step is halved, by coarser
// steps than those that the reference is made of: these are as near as kinks let any two runs come,
// and differ by chance. Unknown if fewer than two of them are farther away than the gap.
double order_towards(const Reference& r, const Scene& scene, const Path& fine, const Route& second,
                     double finest, const Tell& tell) {
  std::size_t sure = 0;
  double gap_squares = 0;
  for (; sure < fine.size() && r.gap[sure] < surely_known; ++sure)
    gap_squares += r.gap[sure] * r.gap[sure];
  if (sure == 0) return unknown;
  const double gap = std::sqrt(gap_squares / static_cast<double>(sure));
  const std::vector<double> times(r.times.begin(),
                                  r.times.begin() + static_cast<std::ptrdiff_t>(sure));
  std::vector<double> halvings, logarithms;
  for (const int factor : {32, 16, 8, 4}) {
    const double steps = sample_interval / (factor * finest);
    if (std::abs(steps - std::round(steps)) > 1e-6) continue;  // it would miss the samples
    const Path path = follow(scene, scene.start, second, factor * finest, times, tell);
    if (path.size() < sure) continue;
    const double distance = mean_distance(scene, path, fine, sure);
    if (!(distance > sure_gaps * gap)) break;
    halvings.push_back(-std::log2(factor));
    logarithms.push_back(-std::log2(distance));
  }
  if (halvings.size() < 2) return unknown;
  return (logarithms.back() - logarithms.front()) / (halvings.back() - halvings.front());
}

// Where a collider makes kinks neither route is better than first order.
void compute_contact(Reference& r, const Scene& scene, double finest, const Tell& tell) {
  inextensible::State moved = scene.start;
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 gsl_rng_free);
  for (Eigen::Index i = 0; i < moved.x.size(); ++i)
    moved.x.data()[i] += perturbation * scene.size * gsl_ran_flat(random.get(), -1, 1);
  for (const int vertex : scene.problem->pinned()) moved.x.col(vertex) = scene.start.x.col(vertex);

  const Route first = first_contact_route(scene, finest);
  const Route other_route = second_contact_route(first);
  const Path fine = follow(scene, scene.start, first, finest, r.times, tell);
  const Path disturbed = follow(scene, moved, first, finest, r.times, tell);
  const Path second_coarse = follow_to_the_end(scene, other_route, 4 * finest, r.times, tell);
  const Path second_fine = follow_to_the_end(scene, other_route, 2 * finest, r.times, tell);
  const Path second = extrapolated(second_coarse, second_fine, other_route.order);
  add_gaps(r, scene, fine, second, disturbed);
  r.observed_order = order_towards(r, scene, fine, other_route, finest, tell);
  r.method = first.solver + ", strain limit " + number_text(first.limit) + ", step " +
             number_text(finest) + " s";
  r.second_method = other_route.solver + ", strain limit " + number_text(other_route.limit) +
                    ", steps " + number_text(4 * finest) + " and " + number_text(2 * finest) +
                    " s, Richardson extrapolated with order " + std::to_string(other_route.order);
  if (fine.size() < r.times.size())
    r.method +=
        ", until it fails after t = " + number_text(fine.empty() ? 0.0 : r.times[fine.size() - 1]) +
        " s; shape statistics from there on by " + other_route.solver + " alone";
  for (std::size_t i = 0; i < r.times.size(); ++i) {
    const bool both = i < fine.size();
    const Positions& one = both ? fine[i] : second_fine[i];
    const Positions& other = both ? second[i] : second_coarse[i];
    if (i >= r.gap.size()) {  // where a run has ended
      r.gap.push_back(rms_distance(scene, one, other));
      r.gap_max.push_back(max_distance(scene, one, other));
    }
    const ShapeStatistics a = shape_statistics(scene, one);
    const ShapeStatistics b = shape_statistics(scene, other);
    r.shape.push_back(a);
    r.shape_gap.push_back({std::abs(a.potential_energy - b.potential_energy),
                           std::abs(a.corner_height - b.corner_height),
                           std::abs(a.shadow - b.shadow)});
  }
  r.positions = fine;
}

}  // namespace

Reference compute_reference(const std::string& scene_name, const SceneParameters& complete,
                            double finest, const Tell& tell) {
  const auto found_type = find_scene(scene_name);
  const SceneType& type = *found_type;
  const Scene scene = type.build(complete);
  Reference r;
  r.scene = scene_name;
  r.parameters = complete;
  r.times = sample_times(scene.duration);
  r.expected_order = expected_order(&type);
  if (r.times.empty())
    throw UsageError("a reference needs a duration of at least " + number_text(sample_interval) +
                     " s");
  if (type.pendulum) {
    compute_chain(r, scene, finest > 0 ? finest : sample_interval / 1024, tell);
  } else {
    compute_contact(r, scene, finest > 0 ? finest : sample_interval / 640, tell);
  }
  r.positions.resize(valid_samples(r));
  return r;
}

}  // namespace harness
