#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <cmath>
#include <memory>

#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/judge/reference_routes.h"
#include "solvers/registry.h"

namespace harness {

using inextensible::State;
using nlohmann::json;

namespace {

// This is the one place that names methods: which to trust for a scene is the maintainer's
// judgement, which no property of a row can replace.
const inextensible::Settings some_passes{{"min_iterations", 1.0}, {"smoothing_sweeps", 30.0}};
// Where a collider makes kinks neither route is better than first order.
const Route contact_route{"rattle", 1e-9, 1};
// RATTLE does not survive a J W J^T that is singular at the start (a row straight between its pins:
// the patch); BDF2 takes its place then, at a limit that keeps off the singularity.
const Route singular_route{"fast_projection@bdf2", 1e-6, 1, some_passes};
// Forces at the end of a step are for scenes that come to rest: what a limit of strain leaves to
// chance has to be small beside the creep of cloth that hangs by friction.
const inextensible::Settings one_projection{{"min_iterations", 1.0}};
const Route implicit_route{"fast_projection@bdf2", 1e-5, 1, one_projection};
// Edges as stiff springs, solved with all other forces at once: strains of 1e-4 under the weight of
// the whole scene.
constexpr double spring_stiffness = 1e4;  // over the weight
// Friction inside the solve is no smooth function of the start, and RATTLE's small steps along old
// directions get stuck on it; the passes that correct it set the limit.
const Route contact_inside_route{"fast_projection@bdf2", 1e-5, 1, some_passes};

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
  if (!journal_) return run;
  journal_->add(name, {{"energy_drift", run.energy_drift}, {"path", rows_of(run.path)}});
  return run;
}

std::string Route::name() const { return solver + ", strain limit " + number_text(limit); }

Routes contact_routes(const Scene& scene, double h) {
  const inextensible::Problem& problem = *scene.problem;
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
    const auto stepper = inextensible::make_stepper(
        contact_route.solver, scene.problem, {contact_route.limit, 1, contact_route.settings});
    first = stepper->advance(state, h) ? contact_route : singular_route;
  }
  return {first, {"icd", first.limit, 1}, {}};
}

void follow(const Scene& scene, const State& start, const Route& route, double h,
            const std::vector<double>& times, const RouteRuns& runs, const SampleVisitor& visit) {
  const auto stepper =
      inextensible::make_stepper(route.solver, scene.problem, {route.limit, 1, route.settings});
  State state = start_from(*scene.problem, start, *inextensible::find_backend(route.solver), h);
  const std::string run = route.solver + ", h = 1/" + number_text(std::round(1 / h)) + " s ";
  const long per_sample = std::lround(sample_interval / h);
  runs.tell(run + "...");
  const Pace pace{h, per_sample * static_cast<long>(times.size())};
  const DriveState driven =
      drive(*stepper, state, pace, [&](const State& now, const DriveState& so_far) {
        if (so_far.steps % per_sample == 0) visit(now);
        return true;
      });
  if (driven.end == DriveState::End::refused)
    runs.tell(run + "stopped before t = " + number_text(times[driven.steps / per_sample]) +
              " s: " + inextensible::to_string(driven.result.status) + ", " + driven.result.detail);
}

std::vector<State> moved_starts(const Scene& scene, double by, int count) {
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 gsl_rng_free);
  std::vector<State> starts(static_cast<std::size_t>(count), scene.start);
  for (State& moved : starts) {
    for (Eigen::Index i = 0; i < moved.x.size(); ++i)
      moved.x.data()[i] += by * gsl_ran_flat(random.get(), -1, 1);
    for (const int vertex : scene.problem->pinned())
      moved.x.col(vertex) = scene.start.x.col(vertex);
  }
  return starts;
}

}  // namespace harness
