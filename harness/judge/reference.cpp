#include "harness/judge/reference.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/fields_json.h"
#include "harness/base/text.h"
#include "harness/judge/measures.h"
#include "harness/points/context.h"
#include "harness/points/measures.h"
#include "harness/scenes/pendulum.h"
#include "inextensible/problem/forces.h"
#include "inextensible/registry.h"
#include "inextensible/systems/constrained_acceleration.h"

namespace harness {
namespace {

using inextensible::Positions;
using nlohmann::json;

constexpr const char* schema = "inextensible-reference/1";
constexpr double sample_interval = 0.04;  // s; every step of the usual ladders meets it
constexpr double perturbation = 1e-10;    // of a start, over the scene's size
constexpr double parted = 1e-2;           // gap at which a reference ends, over the scene's size
constexpr double surely_known = 1e-3;     // gap up to which an order is looked for
constexpr double pendulum_tolerance = 1e-13;
constexpr double tight_limit = 1e-12;    // strain limit of the second route, smooth scenes
constexpr double contact_limit = 1e-9;   // of both routes where a collider makes kinks anyway
constexpr double singular_limit = 1e-6;  // of both routes where J W J^T is singular at the limit 0

using Tell = std::function<void(const std::string&)>;
using Path = std::vector<Positions>;  // at the sample times

std::vector<double> sample_times(double duration) {
  std::vector<double> times;
  for (int k = 1; k * sample_interval <= duration * (1 + 1e-9); ++k)
    times.push_back(k * sample_interval);
  return times;
}

// A backend's path at the sample times, up to where it fails; h divides the sample interval.
Path follow(const Scene& scene, const inextensible::State& start, const std::string& solver,
            double limit, double h, const std::vector<double>& times, const Tell& tell) {
  const auto stepper = inextensible::make_stepper(solver, scene.problem, {limit, 1, {}});
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

Path follow_to_the_end(const Scene& scene, const std::string& solver, double limit, double h,
                       const std::vector<double>& times, const Tell& tell) {
  Path path = follow(scene, scene.start, solver, limit, h, times, tell);
  if (path.size() < times.size())
    throw UsageError("no reference: " + solver + " with h = " + number_text(h) +
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
  const Path coarse = follow_to_the_end(scene, "rattle", tight_limit, 4 * finest, r.times, tell);
  const Path middle = follow_to_the_end(scene, "rattle", tight_limit, 2 * finest, r.times, tell);
  const Path fine = follow_to_the_end(scene, "rattle", tight_limit, finest, r.times, tell);
  const std::size_t all = r.times.size();
  r.observed_order = std::log2(mean_distance(scene, coarse, middle, all) /
                               mean_distance(scene, middle, fine, all));
  const Path second = extrapolated(middle, fine, 2);
  r.method = "N-link pendulum in angles, GSL rk8pd, tolerance " + number_text(pendulum_tolerance);
  r.second_method = "rattle, strain limit " + number_text(tight_limit) + ", steps down to " +
                    number_text(finest) + " s, Richardson extrapolated with order 2";
  add_gaps(r, scene, path, second, disturbed);
  for (std::size_t i = 0; i < all; ++i) {
    r.shape.push_back(shape_statistics(scene, path[i]));
    r.shape_gap.push_back({});
  }
  r.positions = path;
}

// The first route where there is no smooth motion in angles. RATTLE, but where J W J^T is singular
// at the start (a row straight between its pins: the patch), which it does not survive.
struct FirstRoute {
  std::string solver = "rattle";
  double limit = contact_limit;  // of both routes
};

FirstRoute first_route(const Scene& scene, double h) {
  FirstRoute route;
  inextensible::State state = scene.start;
  const auto stepper =
      inextensible::make_stepper(route.solver, scene.problem, {route.limit, 1, {}});
  if (stepper->advance(state, h)) return route;
  return {"fast_projection_bdf2", singular_limit};
}

// The order with which the second route comes to the first one as its step is halved, by coarser
// steps than those that the reference is made of: these are as near as kinks let any two runs come,
// and differ by chance. Unknown if fewer than two of them are farther away than the gap.
double order_towards(const Reference& r, const Scene& scene, const Path& fine, double limit,
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
    const Path path = follow(scene, scene.start, "icd", limit, factor * finest, times, tell);
    if (path.size() < sure) continue;
    const double distance = mean_distance(scene, path, fine, sure);
    if (!(distance > sure_gaps * gap)) break;
    halvings.push_back(-std::log2(factor));
    logarithms.push_back(-std::log2(distance));
  }
  if (halvings.size() < 2) return unknown;
  return (logarithms.back() - logarithms.front()) / (halvings.back() - halvings.front());
}

// Where a collider makes kinks neither route is better than first order; the two differ in the
// direction of constraint forces, the velocity's place in the step and the linear solver.
void compute_contact(Reference& r, const Scene& scene, double finest, const Tell& tell) {
  inextensible::State moved = scene.start;
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 gsl_rng_free);
  for (Eigen::Index i = 0; i < moved.x.size(); ++i)
    moved.x.data()[i] += perturbation * scene.size * gsl_ran_flat(random.get(), -1, 1);
  for (const int vertex : scene.problem->pinned()) moved.x.col(vertex) = scene.start.x.col(vertex);

  const auto [solver, limit] = first_route(scene, finest);
  const Path fine = follow(scene, scene.start, solver, limit, finest, r.times, tell);
  const Path disturbed = follow(scene, moved, solver, limit, finest, r.times, tell);
  const Path icd_coarse = follow_to_the_end(scene, "icd", limit, 4 * finest, r.times, tell);
  const Path icd_fine = follow_to_the_end(scene, "icd", limit, 2 * finest, r.times, tell);
  const Path second = extrapolated(icd_coarse, icd_fine, 1);
  add_gaps(r, scene, fine, second, disturbed);
  r.observed_order = order_towards(r, scene, fine, limit, finest, tell);
  r.method =
      solver + ", strain limit " + number_text(limit) + ", step " + number_text(finest) + " s";
  r.second_method = "icd, strain limit " + number_text(limit) + ", steps " +
                    number_text(4 * finest) + " and " + number_text(2 * finest) +
                    " s, Richardson extrapolated with order 1";
  if (fine.size() < r.times.size())
    r.method +=
        ", until it fails after t = " + number_text(fine.empty() ? 0.0 : r.times[fine.size() - 1]) +
        " s; shape statistics from there on by icd alone";
  for (std::size_t i = 0; i < r.times.size(); ++i) {
    const bool both = i < fine.size();
    const Positions& one = both ? fine[i] : icd_fine[i];
    const Positions& other = both ? second[i] : icd_coarse[i];
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

// Area covered by triangles seen from above: pixel centres of a raster, over size^2.
double shadow_area(const Scene& scene, const Positions& x) {
  constexpr int pixels = 512;
  const double reach = 0.75 * scene.size;  // a square cloth of side 1 reaches 0.71 from its middle
  const double pixel = 2 * reach / pixels;
  std::vector<char> dark(pixels * pixels, 0);
  const auto index = [&](double coordinate) {
    return std::clamp(static_cast<int>((coordinate + reach) / pixel), 0, pixels - 1);
  };
  for (const auto& [a, b, c] : scene.triangles) {
    const Eigen::Vector2d p(x(0, a), x(2, a)), q(x(0, b), x(2, b)), r(x(0, c), x(2, c));
    const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
      return u.x() * v.y() - u.y() * v.x();
    };
    const double area = cross(q - p, r - p);
    if (area == 0) continue;
    const Eigen::Vector2d low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
    for (int j = index(low.y()); j <= index(high.y()); ++j) {
      for (int i = index(low.x()); i <= index(high.x()); ++i) {
        const Eigen::Vector2d s((i + 0.5) * pixel - reach, (j + 0.5) * pixel - reach);
        if (cross(q - p, s - p) / area >= 0 && cross(r - q, s - q) / area >= 0 &&
            cross(p - r, s - r) / area >= 0)
          dark[j * pixels + i] = 1;
      }
    }
  }
  const auto count = std::count(dark.begin(), dark.end(), 1);
  return static_cast<double>(count) * pixel * pixel / (scene.size * scene.size);
}

double rounded(double value, double scale = 1e12) { return std::round(value * scale) / scale; }

// Smooth motion lets RATTLE have its order; kinks of contact leave no method more than the first.
double expected_order(const std::string& scene) { return scene == "chain" ? 2 : 1; }

json shape_json(const std::vector<ShapeStatistics>& list) {
  json rows = json::array();
  for (const auto& s : list)
    rows.push_back({rounded(s.potential_energy), rounded(s.corner_height), rounded(s.shadow)});
  return rows;
}

std::vector<ShapeStatistics> shape_of(const json& rows) {
  std::vector<ShapeStatistics> list;
  for (const json& row : rows)
    list.push_back({row.at(0).get<double>(), row.at(1).get<double>(), row.at(2).get<double>()});
  return list;
}

}  // namespace

ShapeStatistics shape_statistics(const Scene& scene, const Positions& x) {
  ShapeStatistics shape;
  shape.potential_energy = inextensible::potential_energy(*scene.problem, x) / energy_scale(scene);
  for (const int corner : scene.corners)
    shape.corner_height += x(1, corner) / scene.size / static_cast<double>(scene.corners.size());
  if (!scene.triangles.empty()) shape.shadow = shadow_area(scene, x);
  return shape;
}

double rms_distance(const Scene& scene, const Positions& x, const Positions& y) {
  double sum = 0;  // term by term, so that equal runs have equal errors to the last digit
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    sum += scene.problem->mass()[i] * (x.col(i) - y.col(i)).squaredNorm();
  return std::sqrt(sum / scene.problem->total_mass()) / scene.size;
}

double max_distance(const Scene& scene, const Positions& x, const Positions& y) {
  return std::sqrt((x - y).colwise().squaredNorm().maxCoeff()) / scene.size;
}

std::string reference_name(const std::string& scene, const SceneParameters& complete) {
  const SceneType& type = *find_scene(scene);
  std::string changed;
  for (const auto& info : type.parameters) {
    const std::string name = info.name;
    if (name == type.resolution || name == "duration") continue;
    if (complete.at(name) != info.initial)
      changed += name + "=" + number_text(complete.at(name)) + ";";
  }
  return scene + "-n" + number_text(complete.at(type.resolution)) +
         (changed.empty() ? "" : "-" + fnv1a(changed)) + ".json";
}

json to_json(const Reference& r) {
  json positions = json::array();
  // A file holds the digits that its gaps leave standing.
  const double least = r.gap.empty() ? 0 : *std::min_element(r.gap.begin(), r.gap.end());
  const double scale = least > 1e-7 ? 1e9 : 1e12;
  for (const Positions& x : r.positions) {
    json row = json::array();
    for (Eigen::Index i = 0; i < x.size(); ++i) row.push_back(rounded(x.data()[i], scale));
    positions.push_back(std::move(row));
  }
  return {{"schema", schema},
          {"scene", r.scene},
          {"scene_parameters", r.parameters},
          {"method", r.method},
          {"second_method", r.second_method},
          {"valid_until", r.valid_until},
          {"energy_drift", r.energy_drift},
          {"observed_order", number(r.observed_order)},
          {"expected_order", r.expected_order},
          {"times", r.times},
          {"gap", r.gap},
          {"gap_max", r.gap_max},
          {"shape", shape_json(r.shape)},
          {"shape_gap", shape_json(r.shape_gap)},
          {"positions", std::move(positions)}};
}

json summary_of(const Reference& r) {
  double squares = 0;
  for (std::size_t i = 0; i < r.positions.size(); ++i) squares += r.gap[i] * r.gap[i];
  const auto valid = static_cast<double>(std::max<std::size_t>(r.positions.size(), 1));
  return {{"name", r.name()},
          {"method", r.method},
          {"second_method", r.second_method},
          {"valid_until", r.valid_until},
          {"gap", std::sqrt(squares / valid)},
          {"observed_order", number(r.observed_order)},
          {"converged", r.converged()},
          {"energy_drift", r.energy_drift}};
}

Reference read_reference(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw UsageError("cannot read the reference '" + path + "'");
  try {
    const json document = json::parse(file);
    if (document.at("schema") != schema)
      throw UsageError("'" + path + "': schema is " + document.at("schema").dump() +
                       ", must be \"" + schema + "\"");
    Reference r;
    r.scene = document.at("scene").get<std::string>();
    r.parameters = document.at("scene_parameters").get<SceneParameters>();
    r.method = document.at("method").get<std::string>();
    r.second_method = document.at("second_method").get<std::string>();
    r.valid_until = document.at("valid_until").get<double>();
    r.energy_drift = document.at("energy_drift").get<double>();
    r.observed_order = number_of(document.at("observed_order"));
    r.expected_order = document.value("expected_order", expected_order(r.scene));
    r.times = document.at("times").get<std::vector<double>>();
    r.gap = document.at("gap").get<std::vector<double>>();
    // Older files know one norm: nothing in the other one is sure then.
    r.gap_max = document.value("gap_max", std::vector<double>(r.gap.size(), unknown));
    r.shape = shape_of(document.at("shape"));
    r.shape_gap = shape_of(document.at("shape_gap"));
    for (const json& row : document.at("positions")) {
      const auto numbers = row.get<std::vector<double>>();
      r.positions.emplace_back(Eigen::Map<const Positions>(
          numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3)));
    }
    if (r.gap.size() != r.times.size() || r.gap_max.size() != r.times.size() ||
        r.shape.size() != r.times.size() || r.shape_gap.size() != r.times.size() ||
        r.positions.size() > r.times.size())
      throw UsageError("'" + path + "': lists of different lengths");
    return r;
  } catch (const json::exception& error) {
    throw UsageError("'" + path + "' is not a reference: " + error.what());
  }
}

Reference compute_reference(const std::string& scene_name, const SceneParameters& complete,
                            double finest, const Tell& tell) {
  const SceneType& type = *find_scene(scene_name);
  const Scene scene = type.build(complete);
  Reference r;
  r.scene = scene_name;
  r.parameters = complete;
  r.times = sample_times(scene.duration);
  r.expected_order = expected_order(scene_name);
  if (r.times.empty())
    throw UsageError("a reference needs a duration of at least " + number_text(sample_interval) +
                     " s");
  if (scene_name == "chain") {
    compute_chain(r, scene, finest > 0 ? finest : sample_interval / 1024, tell);
  } else {
    compute_contact(r, scene, finest > 0 ? finest : sample_interval / 640, tell);
  }
  r.positions.resize(valid_samples(r));
  return r;
}

std::string Reference::name() const { return exact ? "exact" : reference_name(scene, parameters); }

std::shared_ptr<const Reference> exact_reference(const std::string& scene_name,
                                                 const SceneParameters& complete) {
  const SceneType& type = *find_scene(scene_name);
  if (!type.exact) return nullptr;
  const auto r = std::make_shared<Reference>();
  r->scene = scene_name;
  r->parameters = complete;
  r->method = r->second_method = "exact";
  r->exact = true;
  r->times = sample_times(complete.at("duration"));
  for (const double time : r->times) r->positions.push_back(type.exact(complete, time));
  r->gap.assign(r->times.size(), 0);
  r->gap_max = r->gap;
  r->valid_until = r->duration();
  r->observed_order = unknown;
  return r;
}

std::shared_ptr<const Reference> ReferenceShelf::find(const std::string& scene,
                                                      const SceneParameters& complete) {
  const std::string name = reference_name(scene, complete);
  const std::string key = name + " " + number_text(complete.at("duration"));
  auto [place, fresh] = known_.try_emplace(key, nullptr);
  if (fresh) place->second = exact_reference(scene, complete);
  if (fresh && !place->second) {
    const std::filesystem::path path = std::filesystem::path(folder_) / name;
    if (std::filesystem::exists(path))
      place->second = std::make_shared<const Reference>(read_reference(path.string()));
  }
  return place->second;
}

json ReferenceShelf::summaries() const {
  json list = json::array();
  for (const auto& [name, reference] : known_)
    if (reference) list.push_back(summary_of(*reference));
  return list;
}

}  // namespace harness
