// What a step does beside its filter, and whole iterations of solvers.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "harness/kernels/hardware_peak.h"
#include "harness/kernels/kernel.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"

namespace harness::kernels {
namespace {

using namespace inextensible;
using benchmark::Counter;

void edge_pass(benchmark::State& state, bool gradients, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const EdgeConstraints edges(m.problem(), 1);  // nothing violates: the whole pass
  if (!edges.permissible(m.x0)) return state.SkipWithError("leaves early");
  Eigen::Matrix3Xd u(3, edges.count());
  Eigen::VectorXd c(edges.count());
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(gradients ? edges.linearize(m.x0, u, c) : edges.permissible(m.x0));
    benchmark::ClobberMemory();
  }
  per_item(state, edges.count());
}

void vertex_pass(benchmark::State& state, bool collision, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const Problem& problem = m.problem();
  Positions x = m.x0;
  WorkCounters work;
  std::optional<Contacts> contacts;
  if (collision) contacts.emplace(problem);
  while (state.KeepRunning()) {
    if (collision) {
      x = m.x0;
      contacts->begin(m.state.x, m.state.time, m.h);
      contacts->push_out(x, work);
    } else {
      unconstrained_step(problem, m.state, m.h, x, work);
    }
    benchmark::ClobberMemory();
  }
  per_item(state, problem.vertices(), "s_per_vertex");
  if (collision)
    state.counters["contacts"] =
        Counter(static_cast<double>(work.contacts), Counter::kAvgIterations);
}

// One iteration of a solver as it is in a step: steps from one state, less those of `null`, over
// their iterations. So it holds also what a solver does once a step, a last look at the edges, say.
void iteration(benchmark::State& state, const std::string& name, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  BackendOptions options{.strain_limit = 1e-4};  // so that there is something to do
  for (const SettingInfo& setting : find_backend(name)->settings)
    if (std::string_view(setting.name) == "min_iterations") options.settings[setting.name] = 1.0;
  const auto stepper = make_stepper(name, m.scene.problem, options);
  const auto null = make_stepper("null", m.scene.problem, {});
  const int rounds = std::max(1, 20000 / n);  // so that clock reads do not count
  State s;
  const auto seconds = [&](Stepper& which) {
    const double begin = processor_seconds();
    for (int round = 0; round < rounds; ++round) {
      s = m.state;
      benchmark::DoNotOptimize(which.advance(s, m.h));
    }
    return processor_seconds() - begin;
  };
  s = m.state;
  const StepResult first = stepper->advance(s, m.h);
  if (!first || first.iterations == 0) return state.SkipWithError("refused, or nothing to do");
  while (state.KeepRunning()) {
    const double without = seconds(*null);
    state.SetIterationTime(seconds(*stepper) - without);
  }
  per_item(state, m.problem().constraints() * first.iterations * rounds);
  state.counters["iterations"] = first.iterations;
}

}  // namespace

void register_steps(const std::string& scene, int n, const std::string& at) {
  using State = benchmark::State;
  add("unconstrained_step" + at, [=](State& s) { vertex_pass(s, false, scene, n); });
  add("edge_pass" + at, [=](State& s) { edge_pass(s, true, scene, n); });
  add("strain_check" + at, [=](State& s) { edge_pass(s, false, scene, n); });
}

void register_collision(const std::string& scene, int n, const std::string& at) {
  add("collision_pass" + at, [=](benchmark::State& s) { vertex_pass(s, true, scene, n); });
}

void register_iterations(const std::string& scene, int n, const std::string& at,
                         const std::vector<std::string>& solvers) {
  for (const std::string& name : solvers) {
    add("iteration/" + name + at, [=](benchmark::State& s) {
      iteration(s, name, scene, n);
    })->UseManualTime();
  }
}

}  // namespace harness::kernels
