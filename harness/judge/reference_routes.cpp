#include "harness/judge/reference_routes.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/scenes/pendulum.h"

namespace harness {
namespace {

constexpr double perturbation = 1e-10;  // of a start, over the scene's size
constexpr double visible_move = 1e-5;   // the same where a scene comes to rest
constexpr double parted = 1e-2;         // gap at which a reference ends
constexpr double pendulum_tolerance = 1e-13;
constexpr std::size_t most_samples = 50;
constexpr double usual_finest = sample_interval / 640;  // s, for scenes other than pendulums

struct Route {
  std::string solver;
  double limit;  // of strain
  int order;     // of the error that Richardson's rule takes away
  Settings settings = {};

  std::string name() const { return solver + ", strain limit " + number_text(limit); }
};

std::unique_ptr<Stepper> stepper_of(const Route& route, const Scene& scene) {
  return make_stepper(route.solver, scene.problem, {route.limit, 1, route.settings});
}

// This is the one place that names methods: which to trust for a scene is the maintainer's
// judgement, which no property of a row can replace.
const Settings some_passes{{"min_iterations", 1.0}, {"smoothing_sweeps", 30.0}};
// Second route of a pendulum, beside its angles.
const Route smooth_route{"rattle", 1e-12, 2};
// Where a collider makes kinks neither route is better than first order.
const Route contact_route{"rattle", 1e-9, 1};
// RATTLE does not survive a J W J^T that is singular at the start (a row straight between its pins:
// the patch); BDF2 takes its place then, at a limit that keeps off the singularity.
const Route singular_route{"fast_projection@bdf2", 1e-6, 1, some_passes};
// Forces at the end of a step are for scenes that come to rest: what a limit of strain leaves to
// chance has to be small beside the creep of cloth that hangs by friction.
const Settings one_projection{{"min_iterations", 1.0}};
const Route implicit_route{"fast_projection@bdf2", 1e-5, 1, one_projection};
// Edges as stiff springs, solved with all other forces: strains of 1e-4 under the whole weight.
constexpr double spring_stiffness = 1e4;  // over the weight
// Friction inside the solve is not a smooth function of the start, and RATTLE's small steps along
// old directions get stuck on it; the passes that correct it set the limit.
const Route contact_inside_route{"fast_projection@bdf2", 1e-5, 1, some_passes};

// The routes of a scene that is not a pendulum, in steps of h seconds. The second one has the first
// one's limit; they differ in the direction of constraint forces, the velocity's place in the step
// and the linear solver. The third, of scenes with implicit forces, knows no constraints.
struct Routes {
  Route first, second;
  std::optional<Route> third;
};

Routes contact_routes(const Scene& scene, double h) {
  const Problem& problem = *scene.problem;
  if (problem.implicit_forces()) {
    const double weight = problem.total_mass() * problem.gravity().norm();
    Routes routes{implicit_route, {"icd", implicit_route.limit, 1, one_projection}, {}};
    if (weight > 0)
      routes.third = {"implicit_springs@bdf2", 0.01, 2, {{"stiffness", spring_stiffness * weight}}};
    return routes;
  }
  Route first = contact_inside_route;
  if (!problem.contact_inside()) {
    State state = scene.start;
    first = stepper_of(contact_route, scene)->advance(state, h) ? contact_route : singular_route;
  }
  return {first, {"icd", first.limit, 1}, {}};
}

// Two starts whose coordinates differ from the scene's by up to `by` metres; pins stay.
std::vector<State> moved_starts(const Scene& scene, double by) {
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 gsl_rng_free);
  std::vector<State> starts(2, scene.start);
  for (State& moved : starts) {
    for (Eigen::Index i = 0; i < moved.x.size(); ++i)
      moved.x.data()[i] += by * gsl_ran_flat(random.get(), -1, 1);
    for (const int vertex : scene.problem->pinned())
      moved.x.col(vertex) = scene.start.x.col(vertex);
  }
  return starts;
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

// Richardson extrapolation from two runs whose error is of this order.
Path extrapolated(const Path& coarse, const Path& fine, int order) {
  Path path;
  const double factor = 1 / (std::pow(2.0, order) - 1);
  for (std::size_t i = 0; i < std::min(fine.size(), coarse.size()); ++i)
    path.push_back(fine[i] + factor * (fine[i] - coarse[i]));
  return path;
}

// Two paths that would be the same if a reference had no error.
struct GapPart {
  const char* name;
  const Path *one, *other;
};

class ReferenceMaker {
 public:
  ReferenceMaker(const std::string& name, const SceneParameters& complete, RouteRuns& runs)
      : type_(find_scene(name)), scene_(type_->build(complete)), runs_(runs) {
    r_.scene = name;
    r_.parameters = complete;
    r_.times = sample_times(scene_.duration);
    if (r_.times.empty())
      throw UsageError("a reference needs a duration of at least " + number_text(sample_interval) +
                       " s");
  }

  Reference by_two_routes(double finest) {
    const bool angles = type_->pendulum;
    const double h = finest > 0 ? finest : angles ? sample_interval / 1024 : usual_finest;
    // The coarsest run of each route must meet the sample times.
    const int coarsest = angles ? 4 : 8;
    const double steps = sample_interval / (coarsest * h);
    if (!(steps >= 1) || std::abs(steps - std::round(steps)) > 1e-6)
      throw UsageError(concat("--finest is ", h, " s: ", coarsest,
                              " of such steps must divide the sample interval, ", sample_interval,
                              " s"));
    return angles ? by_angles(h) : by_contact_routes(h);
  }

 private:
  // A route's path at the sample times, up to where it fails; h divides the sample interval. start:
  // the number of the start `from`, 0 for the scene's own.
  const Path& path(const Route& route, double h, const State& from, int start) {
    const std::size_t samples = r_.times.size();
    const std::string name = concat(route.name(), ", step ", number_text(h, 17), " s, start ",
                                    start, ", ", samples, " samples");
    const auto compute = [&] {
      const auto stepper = stepper_of(route, scene_);
      State state = start_from(*scene_.problem, from, *find_backend(route.solver), h);
      const std::string words = route.solver + ", h = 1/" + number_text(std::round(1 / h)) + " s ";
      const long per_sample = std::lround(sample_interval / h);
      runs_.tell(words + "...");
      RouteRun run;
      const DriveState driven = drive(*stepper, state, {h, per_sample * static_cast<long>(samples)},
                                      [&](const State& now, const DriveState& so_far) {
                                        if (so_far.steps % per_sample == 0)
                                          run.path.push_back(now.x);
                                        return true;
                                      });
      if (driven.end == DriveState::End::refused)
        runs_.tell(concat(words, "stopped before t = ", r_.times[driven.steps / per_sample],
                          " s: ", to_string(driven.result.status), ", ", driven.result.detail));
      return run;
    };
    return runs_.run(name, compute).path;
  }
  const Path& path(const Route& route, double h) { return path(route, h, scene_.start, 0); }

  const Path& whole_path(const Route& route, double h) {
    const Path& found = path(route, h);
    if (found.size() < r_.times.size())
      throw UsageError(concat("no reference: ", route.solver, " with h = ", h,
                              " s fails before t = ", r_.times[found.size()],
                              " s (bench reference with a smaller --finest may help)"));
    return found;
  }

  const RouteRun& swing(double disturbance, double tolerance) {
    const std::string name =
        concat("pendulum, start moved by ", disturbance, ", tolerance ", tolerance);
    return runs_.run(name, [&] {
      runs_.tell("pendulum in angles, tolerance " + number_text(tolerance) + " ...");
      Pendulum pendulum = pendulum_of(scene_, disturbance);
      const double start = pendulum.energy(), scale = energy_scale(scene_);
      RouteRun run;
      for (const double time : r_.times) {
        pendulum.advance(time, tolerance);
        run.path.push_back(pendulum.positions());
        const double drift = std::abs(pendulum.energy() - start) / scale;
        run.energy_drift = std::max(run.energy_drift, drift);
      }
      return run;
    });
  }

  Reference by_angles(double h) {
    const RouteRun& swung = swing(0, pendulum_tolerance);
    r_.energy_drift = swung.energy_drift;
    const Route& route = smooth_route;
    const Path &coarse = whole_path(route, 4 * h), &middle = whole_path(route, 2 * h),
               &fine = whole_path(route, h);
    const auto distance = [this](const Path& a, const Path& b) {
      double squares = 0;  // over all samples
      for (std::size_t i = 0; i < a.size(); ++i)
        squares += std::pow(rms_distance(scene_, a[i], b[i]), 2);
      return std::sqrt(squares / static_cast<double>(a.size()));
    };
    r_.observed_order = std::log2(distance(coarse, middle) / distance(middle, fine));
    const Path second = extrapolated(middle, fine, route.order),
               second_half = extrapolated(coarse, middle, route.order);
    r_.method =
        "N-link pendulum in angles, GSL rk8pd, tolerance " + number_text(pendulum_tolerance);
    r_.second_method = route.name() + ", steps down to " + number_text(h) +
                       " s, Richardson extrapolated with order " + std::to_string(route.order);
    // An integrator that chooses its steps has no half of them: a tenth of its precision instead.
    const Path& half = swing(0, 10 * pendulum_tolerance).path;
    std::vector<GapPart> parts{{"routes", &swung.path, &second},
                               {"half_step", &swung.path, &half},
                               {"second_half_step", &second, &second_half}};
    for (const double disturbance : {perturbation, -perturbation})
      parts.push_back({"moved_start", &swung.path, &swing(disturbance, pendulum_tolerance).path});
    add_gaps(parts);
    return finished(swung.path);
  }

  Reference by_contact_routes(double h) {
    const auto [first, other, third] = contact_routes(scene_, h);
    const Path &fine = whole_path(first, h), &half = whole_path(first, 2 * h);
    // Where cloth creeps by friction Richardson's rule adds more than it takes away; and the steps
    // of a scene that comes to rest are affordable.
    const bool settles = third.has_value();
    const double finest = settles ? h : 2 * h;
    const Path &second_fine = path(other, finest), &second_coarse = path(other, 2 * finest);
    Path second = second_fine, second_half = second_coarse;
    if (!settles) {
      second = extrapolated(second_coarse, second_fine, other.order);
      second_half = extrapolated(path(other, 4 * finest), second_coarse, other.order);
    }
    std::vector<GapPart> parts{{"routes", &fine, &second},
                               {"half_step", &fine, &half},
                               {"second_half_step", &second, &second_half}};
    int moved = 0;
    for (const State& start :
         moved_starts(scene_, (settles ? visible_move : perturbation) * scene_.size))
      parts.push_back({"moved_start", settles ? &half : &fine,
                       &path(first, settles ? 2 * h : h, start, ++moved)});
    const bool springs = third && h < quick_finest;
    if (springs) parts.push_back({"third_route", &fine, &path(*third, 8 * h)});
    add_gaps(parts);
    r_.method = first.name() + ", step " + number_text(h) + " s";
    r_.second_method =
        other.name() + (settles ? concat(", step ", finest, " s")
                                : concat(", steps ", 2 * finest, " and ", finest,
                                         " s, Richardson extrapolated with order ", other.order));
    if (springs)
      r_.second_method +=
          concat("; ", third->solver,
                 ", EA = ", number_text(std::get<double>(third->settings.at("stiffness")), 3),
                 " N, step ", 8 * h, " s");
    if (second.size() < r_.times.size())
      r_.second_method += concat(
          ", until it fails after t = ", second.empty() ? 0.0 : r_.times[second.size() - 1], " s");
    // After the gap's samples, where a route has ended, distances are the first route's alone.
    for (std::size_t i = r_.gap.size(); i < r_.times.size(); ++i) {
      const Positions& there = i < second.size() ? second[i] : half[i];
      r_.gap.push_back(rms_distance(scene_, fine[i], there));
      r_.gap_max.push_back(max_distance(scene_, fine[i], there));
    }
    return finished(fine);
  }

  // Fills in the reference's gaps, at each sample that all paths reach, and valid_until.
  void add_gaps(const std::vector<GapPart>& parts) {
    std::size_t samples = r_.times.size();
    for (const auto& [name, one, other] : parts)
      samples = std::min({samples, one->size(), other->size()});
    r_.gap.assign(samples, 0);
    r_.gap_max.assign(samples, 0);
    for (const auto& [name, one, other] : parts) {
      std::vector<double>& own = r_.gap_parts[name];
      own.resize(samples, 0);
      for (std::size_t i = 0; i < samples; ++i) {
        const Positions &x = (*one)[i], &y = (*other)[i];
        own[i] = std::max(own[i], rms_distance(scene_, x, y));
        r_.gap[i] = std::max(r_.gap[i], own[i]);
        r_.gap_max[i] = std::max(r_.gap_max[i], max_distance(scene_, x, y));
      }
    }
    for (std::size_t i = 0; i < r_.gap.size() && r_.gap[i] < parted; ++i)
      r_.valid_until = r_.times[i];
  }

  Reference finished(const Path& path) {
    const auto valid = std::ranges::upper_bound(r_.times, r_.valid_until) - r_.times.begin();
    r_.positions.assign(path.begin(), path.begin() + valid);
    if (r_.times.size() <= most_samples) return std::move(r_);
    // Every third sample, so that files of long motions stay small.
    const auto keep = [](auto& list) {
      std::size_t kept = 0;
      for (std::size_t i = 2; i < list.size(); i += 3) list[kept++] = list[i];
      list.resize(kept);
    };
    keep(r_.times);
    keep(r_.positions);
    keep(r_.gap);
    keep(r_.gap_max);
    for (auto& [name, part] : r_.gap_parts) keep(part);
    r_.valid_until = r_.positions.empty() ? 0 : r_.times[r_.positions.size() - 1];
    return std::move(r_);
  }

  std::shared_ptr<const SceneType> type_;
  Scene scene_;
  RouteRuns& runs_;
  Reference r_;
};

}  // namespace

RouteRuns::RouteRuns(Tell tell, const std::string& out, const json& header)
    : tell_(std::move(tell)), journal_(out) {
  if (!journal_->damage().empty())
    tell_(journal_->path() + ", " + journal_->damage() + ": what is damaged is run again");
  const std::size_t done = journal_->known().size();
  const bool same = journal_->header() == header;
  if (done > 0)
    tell_(same ? "continues after " + std::to_string(done) + " runs that are done"
               : "runs of another build or --finest are dropped");
  if (!same) journal_->start(header);
}

const RouteRun& RouteRuns::run(const std::string& name, const std::function<RouteRun()>& compute) {
  if (const auto known = known_.find(name); known != known_.end()) return known->second;
  if (const json* kept = journal_ ? journal_->find(name) : nullptr)
    return known_[name] = {path_of(kept->at("path")), kept->at("energy_drift").get<double>()};
  const RouteRun& run = known_[name] = compute();
  if (journal_)
    journal_->add(name, {{"energy_drift", run.energy_drift}, {"path", rows_of(run.path)}});
  return run;
}

Reference compute_reference(const std::string& scene, const SceneParameters& complete,
                            double finest, RouteRuns& runs) {
  return ReferenceMaker(scene, complete, runs).by_two_routes(finest);
}

}  // namespace harness
