// What the core can do at best.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "harness/kernels/hardware_peak.h"
#include "harness/kernels/kernel.h"

namespace harness::kernels {
namespace {

using benchmark::Counter;

// A square root and a division an edge, independent of each other, in the first-level cache.
void sqrt_div(std::array<double, 1024>& lengths) {
  for (double& q : lengths) q = 1.5 - 0.5 / std::sqrt(q);
  benchmark::DoNotOptimize(lengths.data());
  benchmark::ClobberMemory();
}

void floor_read(benchmark::State& state, std::size_t bytes) {
  const std::size_t size = bytes / sizeof(double);
  const Eigen::VectorXd data = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(size));
  while (state.KeepRunning()) benchmark::DoNotOptimize(read_all(data.data(), size));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void floor_multiply_add(benchmark::State& state) {
  constexpr std::size_t times = 1 << 16;
  while (state.KeepRunning()) benchmark::DoNotOptimize(multiply_add(times));
  state.counters["flops"] =
      Counter(flops_of_multiply_add(times), Counter::kIsIterationInvariantRate);
}

}  // namespace

double sqrt_div_seconds() {
  static const double seconds = [] {
    std::array<double, 1024> lengths;
    lengths.fill(1.2);
    double best = 1;
    for (int i = 0; i < 1000; ++i) {
      const double begin = processor_seconds();
      for (int repeat = 0; repeat < 20; ++repeat) sqrt_div(lengths);
      best = std::min(best, processor_seconds() - begin);
    }
    return best / (20 * 1024);
  }();
  return seconds;
}

void register_floors() {
  add("floor/sqrt_div", [](benchmark::State& s) {
    std::array<double, 1024> lengths;
    lengths.fill(1.2);
    while (s.KeepRunning()) sqrt_div(lengths);
    per_item(s, 1024);
  });
  add("floor/multiply_add", floor_multiply_add);
  for (const std::size_t kib : {16, 512, 8192, 262144})
    add("floor/stream_read/KiB:" + std::to_string(kib),
        [=](benchmark::State& s) { floor_read(s, 1024 * kib); });
}

}  // namespace harness::kernels
