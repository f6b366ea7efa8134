// One pass of strain limiting over all edges.
#include "harness/kernels/hardware_peak.h"
#include "harness/kernels/kernel.h"
#include "solvers/methods/gauss_seidel.h"
#include "solvers/methods/gauss_seidel_colored.h"
#include "solvers/methods/jacobi.h"
#include "solvers/methods/strips.h"

namespace harness::kernels {
namespace {

using namespace inextensible;
using benchmark::Counter;

// One pass over a cloth stretched by a fifth, so that every edge is corrected. A call that
// may not pass at all costs the checks, the refusal and the clock: that is taken off.
template <class Filter>
void strain_pass(benchmark::State& state, int n) {
  const Moment& m = moment("drape", n);
  typename Filter::Settings settings;
  settings.max_iterations = 1;
  if constexpr (requires { settings.sweeps; }) settings.sweeps = 0;  // a pass over yarns alone
  Filter one(m.problem(), settings);
  settings.max_iterations = 0;
  Filter none(m.problem(), settings);
  const Positions stretched = 1.2 * m.x0;
  Positions x = stretched;
  WorkCounters work;
  double total = 0;
  while (state.KeepRunning()) {
    x = stretched;
    const double begin = processor_seconds();
    benchmark::DoNotOptimize(none.apply(m.state.x, m.h, x, work));
    const double middle = processor_seconds();
    benchmark::DoNotOptimize(one.apply(m.state.x, m.h, x, work));
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
  using State = benchmark::State;
  add("strain_pass/gauss_seidel" + at, [=](State& s) {
    strain_pass<GaussSeidel>(s, n);
  })->UseManualTime();
  add("strain_pass/gauss_seidel_colored" + at, [=](State& s) {
    strain_pass<GaussSeidelColored>(s, n);
  })->UseManualTime();
  add("strain_pass/jacobi" + at, [=](State& s) { strain_pass<Jacobi>(s, n); })->UseManualTime();
  add("strain_pass/strips" + at, [=](State& s) { strain_pass<Strips>(s, n); })->UseManualTime();
}

}  // namespace harness::kernels
