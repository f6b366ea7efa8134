#include "harness/kernels/floors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <map>

namespace harness::kernels {
namespace {

#if defined(__AVX512F__)
constexpr std::size_t vector_bytes = 64;
#elif defined(__AVX__)
constexpr std::size_t vector_bytes = 32;
#else
constexpr std::size_t vector_bytes = 16;
#endif
using Vector = double __attribute__((vector_size(vector_bytes), may_alias));
constexpr std::size_t lanes = vector_bytes / sizeof(double);
// Independent accumulators: as many as the latency of an addition (four cycles or so) times the
// additions a cycle (two), within sixteen registers.
constexpr std::size_t chains = 8;

double sum(const Vector (&v)[chains]) {
  double total = 0;
  for (const Vector& one : v)
    for (std::size_t i = 0; i < lanes; ++i) total += one[i];
  return total;
}

volatile double sink;  // so that no work is left out

// s of processor time, the shortest of several runs: other programs do not count.
template <class Work>
double shortest(int rounds, Work work) {
  double best = 1e300;
  for (int round = 0; round < rounds; ++round) {
    const double start = processor_seconds();
    work();
    best = std::min(best, processor_seconds() - start);
  }
  return best;
}

}  // namespace

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double read_all(const Eigen::VectorXd& data) {
  Vector v[chains] = {};
  const auto size = static_cast<std::size_t>(data.size());
  for (std::size_t i = 0; i < size; i += chains * lanes) {
    for (std::size_t k = 0; k < chains; ++k)
      v[k] += *reinterpret_cast<const Vector*>(data.data() + i + k * lanes);
  }
  return sum(v);
}

double multiply_add(std::size_t times) {
  const Vector scale = Vector{} + 0.999999, shift = Vector{} + 1e-6;
  Vector v[chains];
  for (std::size_t k = 0; k < chains; ++k) v[k] = Vector{} + static_cast<double>(k);
  for (std::size_t i = 0; i < times; i += chains) {
    for (std::size_t k = 0; k < chains; ++k) v[k] = v[k] * scale + shift;
  }
  return sum(v);
}

double flops_of_multiply_add(std::size_t times) { return 2.0 * static_cast<double>(times * lanes); }

Lengths some_lengths() {
  Lengths lengths;
  lengths.fill(1.2);
  return lengths;
}

void sqrt_div(Lengths& lengths) {
  for (double& q : lengths) q = 1.5 - 0.5 / std::sqrt(q);
}

double sqrt_div_seconds() {
  static const double seconds = [lengths = some_lengths()]() mutable {
    return shortest(1000,
                    [&] {
                      for (int repeat = 0; repeat < 20; ++repeat) sqrt_div(lengths);
                      sink = lengths.front();
                    }) /
           static_cast<double>(20 * lengths.size());
  }();
  return seconds;
}

double read_bandwidth(double bytes) {
  static std::map<std::size_t, double> known;
  const std::size_t size =
      std::bit_ceil(std::max(read_granularity, static_cast<std::size_t>(bytes / sizeof(double))));
  double& rate = known[size];
  if (rate > 0) return rate;
  const Eigen::VectorXd data = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(size));
  const std::size_t passes = std::max<std::size_t>(1, (std::size_t{1} << 21) / size);
  const double seconds = shortest(10, [&] {
    for (std::size_t pass = 0; pass < passes; ++pass) sink = read_all(data);
  });
  rate = static_cast<double>(passes * size * sizeof(double)) / seconds;
  return rate;
}

double peak_flops() {
  constexpr std::size_t times = 1 << 20;
  static const double rate =
      flops_of_multiply_add(times) / shortest(10, [] { sink = multiply_add(times); });
  return rate;
}

}  // namespace harness::kernels
