// One pass of strain limiting over all edges.
#include "harness/kernels/hardware_peak.h"
#include "harness/kernels/kernel.h"
#include "solvers/registry.h"

namespace harness::kernels {
namespace {

using namespace inextensible;
using benchmark::Counter;

std::unique_ptr<VelocityFilter> filter(const Problem& problem, const char* method, double passes) {
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
void strain_pass(benchmark::State& state, const char* method, int n) {
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
  state.counters["floor_ratio"] =
      Counter(total / m.problem().constraints() / sqrt_div_seconds(), Counter::kAvgIterations);
  state.counters["corrected"] =
      Counter(static_cast<double>(work.edge_projections) / m.problem().constraints(),
              Counter::kAvgIterations);
}

}  // namespace

void register_strain_passes(int n, const std::string& at) {
  for (const char* method : {"gauss_seidel", "gauss_seidel_colored", "jacobi", "yarn_projection"}) {
    add("strain_pass/" + std::string(method) + at, [=](benchmark::State& state) {
      strain_pass(state, method, n);
    })->UseManualTime();
  }
}

}  // namespace harness::kernels
