// Chains whose motion is known: small oscillations of one that hangs, and one that hangs between
// two pins and stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "solvers/registry.h"
#include "solvers/systems/constrained_acceleration.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;

constexpr double g = 9.81;

// Links of one length between vertices of 1 kg, the given ones pinned.
std::shared_ptr<const Problem> chain_of(int vertices, double link, std::vector<int> pinned) {
  inextensible::ProblemParts parts;
  parts.mass.assign(static_cast<std::size_t>(vertices), 1);
  parts.pinned = std::move(pinned);
  parts.gravity = {0, -g, 0};
  for (int i = 0; i + 1 < vertices; ++i) {
    parts.edges.push_back({i, i + 1});
    parts.rest_length.push_back(link);
  }
  return std::make_shared<const Problem>(std::move(parts));
}

// L_0(x) ... L_n(x), Laguerre polynomials: (i + 1) L_{i+1} = (2 i + 1 - x) L_i - i L_{i-1}.
std::vector<double> laguerre(int n, double x) {
  std::vector<double> values{1};
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    values.push_back(((2 * i + 1 - x) * values[k] - (i > 0 ? i * values[k - 1] : 0)) / (i + 1));
  }
  return values;
}

// The k-th zero of L_n, from 1 on.
double laguerre_zero(int n, int k) {
  constexpr double stride = 1e-3;
  for (double x = 0;; x += stride) {
    double low = x, high = x + stride;
    if (laguerre(n, low).back() * laguerre(n, high).back() > 0 || --k > 0) continue;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (laguerre(n, low).back() * laguerre(n, middle).back() > 0 ? low : high) = middle;
    }
    return low;
  }
}

TEST(LaguerreZeros, OfTheDoublePendulum) {
  EXPECT_NEAR(laguerre_zero(2, 1), 2 - std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(laguerre_zero(2, 2), 2 + std::sqrt(2.0), 1e-12);
}

// N equal masses on links of length l oscillate with omega_k^2 = (g / l) x_k, x_k the zeros of L_N,
// and deflections L_i(x_k), i counted from the free end. RATTLE, as any Stoermer-Verlet method, is
// fast by (omega h)^2 / 24.
TEST(HangingChain, OscillatesWithTheFrequenciesOfLaguerresZeros) {
  constexpr int masses = 10;
  constexpr double link = 0.1, amplitude = 1e-4, h = 1e-3;
  const auto problem = chain_of(masses + 1, link, {0});
  for (const int mode : {1, 2, 3}) {
    const double zero = laguerre_zero(masses, mode), omega = std::sqrt(g / link * zero);
    const std::vector<double> shape = laguerre(masses, zero);
    State state;
    state.x.setZero(3, masses + 1);
    state.v.setZero(3, masses + 1);
    for (int i = 1; i <= masses; ++i) {  // from the pin downwards
      state.x(0, i) = amplitude * shape[static_cast<std::size_t>(masses - i)];
      const double aside = state.x(0, i) - state.x(0, i - 1);
      state.x(1, i) = state.x(1, i - 1) - std::sqrt(link * link - aside * aside);
    }
    const auto stepper = inextensible::make_stepper("rattle", problem, {1e-13, 1, {}});
    // The free end's zero crossings, a quarter of a period after the start and then every half one.
    std::vector<double> crossings;
    while (crossings.size() < 11) {
      const double before = state.x(0, masses), time = state.time;
      ASSERT_TRUE(stepper->advance(state, h));
      const double after = state.x(0, masses);
      if (before * after < 0) crossings.push_back(time + h * before / (before - after));
      ASSERT_LT(state.time, 20);
    }
    const double found = M_PI * 10 / (crossings.back() - crossings.front());
    EXPECT_NEAR(found / omega, 1 + std::pow(omega * h, 2) / 24, 2e-6) << "mode " << mode;
  }
}

// Link i of N, from the left, has tan(slope) = V_i / H with V_i = m g (i - (N + 1) / 2).
TEST(Catenary, OfLinksStaysWhereItHangs) {
  constexpr int links = 12;
  constexpr double link = 0.1, span = 0.8;
  const auto rise = [](int i) { return g * (i - 0.5 * (links + 1)); };
  double low = 1e-6, high = 1e6;  // H, N
  for (int k = 0; k < 200; ++k) {
    const double tension = std::sqrt(low * high);
    double reach = 0;
    for (int i = 1; i <= links; ++i) reach += link * tension / std::hypot(tension, rise(i));
    (reach < span ? low : high) = tension;
  }
  const auto problem = chain_of(links + 1, link, {0, links});
  State start;
  start.x.setZero(3, links + 1);
  start.v.setZero(3, links + 1);
  for (int i = 1; i <= links; ++i) {
    const double length = std::hypot(low, rise(i));
    start.x.col(i) = start.x.col(i - 1) + link / length * Eigen::Vector3d(low, rise(i), 0);
  }
  EXPECT_NEAR(start.x(0, links), span, 1e-12);
  EXPECT_NEAR(start.x(1, links), 0, 1e-12);
  EXPECT_LT(inextensible::constrained_acceleration(*problem, start).cwiseAbs().maxCoeff(), 1e-9);
  const auto drift = [&](const char* solver, double h) {
    const auto stepper = inextensible::make_stepper(solver, problem, {1e-11, 1, {}});
    State state = start;
    while (state.time < 1 - 0.5 * h)
      if (!stepper->advance(state, h)) return std::nan("");
    return (state.x - start.x).cwiseAbs().maxCoeff();
  };
  // Solutions of the step's equations stay; what the strain limit leaves of each fall adds up.
  for (const char* solver : {"shake", "rattle", "icd"})
    EXPECT_LT(drift(solver, 0.01), 1e-6) << solver;
  // Iterations that end elsewhere on the constraints shift the equilibrium, less by smaller steps.
  for (const char* solver : {"fast_projection", "fast_projection@bdf2", "gauss_seidel"}) {
    const double coarse = drift(solver, 0.01), fine = drift(solver, 0.0025);
    EXPECT_LT(coarse, 1e-3) << solver;
    EXPECT_LT(fine, coarse / 4) << solver << ": " << coarse << ", " << fine;
  }
}

}  // namespace
}  // namespace harness
