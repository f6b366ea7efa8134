// Passes over all edges or vertices, and whole iterations of solvers.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "harness/kernels/floors.h"
#include "harness/kernels/kernel.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"

namespace harness::kernels {
namespace {

using namespace inextensible;

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
  if (collision) state.counters["contacts"] = average(static_cast<double>(work.contacts));
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

std::unique_ptr<VelocityFilter> filter(const Problem& problem, const std::string& method,
                                       double passes) {
  const Backend& row = *find_backend(method);
  BackendOptions options{.settings = complete_settings(row, {})};
  options.settings["max_iterations"] = passes;
  // A pass over yarns alone.
  if (const auto sweeps = options.settings.find("sweeps"); sweeps != options.settings.end())
    sweeps->second = 0.0;
  return row.make_filter(problem, options, Along::edges);
}

// One pass over a cloth stretched by a fifth, so that every edge is corrected. A call that
// may not pass at all costs the checks, the refusal and the clock: that is taken off.
void strain_pass(benchmark::State& state, const std::string& method, int n) {
  const Moment& m = moment("drape", n);
  const auto one = filter(m.problem(), method, 1), none = filter(m.problem(), method, 0);
  const Positions stretched = 1.2 * m.x0;
  Positions x = stretched;
  WorkCounters work;
  double total = 0;
  while (state.KeepRunning()) {
    x = stretched;
    const double begin = processor_seconds();
    benchmark::DoNotOptimize(none->apply(m.state.x, m.h, x, work));
    const double middle = processor_seconds();
    benchmark::DoNotOptimize(one->apply(m.state.x, m.h, x, work));
    const double seconds = (processor_seconds() - middle) - (middle - begin);
    state.SetIterationTime(seconds);
    total += seconds;
  }
  per_item(state, m.problem().constraints());
  state.counters["floor_ratio"] = average(total / m.problem().constraints() / sqrt_div_seconds());
  state.counters["corrected"] =
      average(static_cast<double>(work.edge_projections) / m.problem().constraints());
}

}  // namespace

void register_steps(const std::string& scene, int n) {
  const std::string at = "/" + scene + ":" + std::to_string(n);
  add("unconstrained_step" + at, vertex_pass, false, scene, n);
  add("edge_pass" + at, edge_pass, true, scene, n);
  add("strain_check" + at, edge_pass, false, scene, n);
  if (scene == "drape") {
    add("collision_pass" + at, vertex_pass, true, scene, n);
    for (const std::string method :
         {"gauss_seidel", "gauss_seidel_colored", "jacobi", "yarn_projection"})
      add("strain_pass/" + method + at, strain_pass, method, n)->UseManualTime();
    return;
  }
  std::vector<std::string> solvers{"fast_projection", "implicit_springs"};
  if (n <= 80) solvers.insert(solvers.end(), {"shake", "rattle", "icd"});
  for (const std::string& name : solvers)
    add("iteration/" + name + at, iteration, name, scene, n)->UseManualTime();
}

}  // namespace harness::kernels
