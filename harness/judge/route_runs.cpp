#include "harness/judge/route_runs.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "solvers/registry.h"

namespace harness {

using inextensible::Positions;

namespace {

constexpr double parted = 1e-2;  // gap at which a reference ends, over the scene's size

}  // namespace

void follow(const Scene& scene, const inextensible::State& start, const Route& route, double h,
            const std::vector<double>& times, const Tell& tell, const SampleVisitor& visit) {
  const std::string& solver = route.solver;
  const auto stepper =
      inextensible::make_stepper(solver, scene.problem, {route.limit, 1, route.settings});
  inextensible::State state =
      start_from(*scene.problem, start, *inextensible::find_backend(solver), h);
  const std::string run = solver + ", h = 1/" + number_text(std::round(1 / h)) + " s ";
  const long per_sample = std::lround(sample_interval / h);
  tell(run + "...");
  const Pace pace{h, per_sample * static_cast<long>(times.size())};
  const DriveState driven =
      drive(*stepper, state, pace, [&](const inextensible::State& now, const DriveState& so_far) {
        visit(now, so_far.steps % per_sample == 0);
        return true;
      });
  if (driven.end == DriveState::End::refused)
    tell(run + "stopped before t = " + number_text(times[driven.steps / per_sample]) +
         " s: " + inextensible::to_string(driven.result.status) + ", " + driven.result.detail);
}

std::vector<inextensible::State> moved_starts(const Scene& scene, double by, int count) {
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 gsl_rng_free);
  std::vector<inextensible::State> starts(static_cast<std::size_t>(count), scene.start);
  for (inextensible::State& moved : starts) {
    for (Eigen::Index i = 0; i < moved.x.size(); ++i)
      moved.x.data()[i] += by * gsl_ran_flat(random.get(), -1, 1);
    for (const int vertex : scene.problem->pinned())
      moved.x.col(vertex) = scene.start.x.col(vertex);
  }
  return starts;
}

const Path& kept_path(const Task& task, const inextensible::State& from, int start,
                      const Route& route, double h, std::size_t samples) {
  const std::string name = route.solver + ", strain limit " + number_text(route.limit) + ", step " +
                           number_text(h, 17) + " s, start " + std::to_string(start) + ", " +
                           std::to_string(samples) + " samples";
  const std::vector<double> times(task.r.times.begin(),
                                  task.r.times.begin() + static_cast<std::ptrdiff_t>(samples));
  return task
      .keep(name,
            [&] {
              RouteRun run;
              follow(task.scene, from, route, h, times, task.tell,
                     [&run](const inextensible::State& state, bool sampled) {
                       if (sampled) run.path.push_back(state.x);
                     });
              return run;
            })
      .path;
}

const Path& path_of(const Task& task, const Route& route, double h) {
  return kept_path(task, task.scene.start, 0, route, h, task.r.times.size());
}

const Path& path_to_the_end(const Task& task, const Route& route, double h) {
  const Path& path = path_of(task, route, h);
  if (path.size() < task.r.times.size())
    throw UsageError("no reference: " + route.solver + " with h = " + number_text(h) +
                     " s fails before t = " + number_text(task.r.times[path.size()]) +
                     " s (a smaller --finest may help)");
  return path;
}

Path extrapolated(const Path& coarse, const Path& fine, int order) {
  Path path;
  const double factor = 1 / (std::pow(2.0, order) - 1);
  for (std::size_t i = 0; i < std::min(fine.size(), coarse.size()); ++i)
    path.push_back(fine[i] + factor * (fine[i] - coarse[i]));
  return path;
}

double mean_distance(const Scene& scene, const Path& a, const Path& b, std::size_t count) {
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) squares += std::pow(rms_distance(scene, a[i], b[i]), 2);
  return std::sqrt(squares / static_cast<double>(count));
}

void add_gaps(Reference& r, const Scene& scene, const std::vector<GapPart>& parts) {
  std::size_t samples = r.times.size();
  for (const GapPart& part : parts)
    samples = std::min({samples, part.one->size(), part.other->size()});
  r.gap.assign(samples, 0);
  r.gap_max.assign(samples, 0);
  for (const GapPart& part : parts) {
    std::vector<double>& own = r.gap_parts[part.name];
    own.resize(samples, 0);
    for (std::size_t i = 0; i < samples; ++i) {
      const Positions &x = (*part.one)[i], &y = (*part.other)[i];
      own[i] = std::max(own[i], rms_distance(scene, x, y));
      r.gap[i] = std::max(r.gap[i], own[i]);
      r.gap_max[i] = std::max(r.gap_max[i], max_distance(scene, x, y));
    }
  }
  r.valid_until = 0;
  for (std::size_t i = 0; i < r.gap.size() && r.gap[i] < parted; ++i) r.valid_until = r.times[i];
}

}  // namespace harness
