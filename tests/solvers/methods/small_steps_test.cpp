// Methods whose strain the time step controls, PBD with substeps and soft step: the strain that
// theory gives a loaded rope.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solvers/registry.h"
#include "support/motion.h"

namespace inextensible {
namespace {

constexpr int rope_links = 10;
constexpr double link_length = 0.1, vertex_mass = 0.1;

// What each link is longer than at rest after some time of hanging.
std::vector<double> elongations(const char* solver, double step, const Settings& settings) {
  const testing::HangingRope rope(rope_links, link_length, vertex_mass);
  const auto stepper = make_stepper(solver, rope.problem, {0.01, 1, settings});
  State state = rope.start;
  while (state.time < 20) EXPECT_TRUE(stepper->advance(state, step));
  std::vector<double> longer;
  for (int k = 1; k <= rope_links; ++k)
    longer.push_back((state.x.col(k) - state.x.col(k - 1)).norm() - link_length);
  return longer;
}

// Along a vertical line a sweep is linear. With one sweep a step in two colors, here the links 2,
// 4, ... from the pin before 1, 3, ..., a rope rests where each vertex is lifted by the g h^2 that
// it falls: the links of the last color have their rest length, and link k of N of the first is
// longer by 2 (N - k + 1) g h^2. (A sweep from the pin downwards leaves (N - k) g h^2 in link k.)
TEST(PbdSubsteps, LeaveAHangingRopeTheStrainOfTheory) {
  for (const double step : {0.004, 0.002, 0.001, 0.0005}) {
    const auto longer = elongations("pbd_substeps", step, {});
    const double fall = testing::HangingRope::gravity * step * step;
    for (int k = 1; k <= rope_links; ++k)
      EXPECT_NEAR(longer[k - 1], k % 2 == 0 ? 2 * (rope_links - k + 1) * fall : 0, 1e-3 * fall)
          << "link " << k << ", " << step;
  }
}

// The way along edges, here around a corner of a net.
TEST(PbdSubsteps, AttachmentsFollowEdgesOrGoStraight) {
  Positions rest(3, 4);
  rest << 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0;
  const Problem square(
      testing::parts_at_rest(rest, {{0, 1}, {1, 3}, {0, 2}, {2, 3}}, {1, 1, 1, 1}, {0}));
  const State start{rest, 0 * rest, 0};
  for (const auto& [kind, distance] :
       {std::pair<const char*, double>{"edges", 2}, {"straight", std::sqrt(2.0)}}) {
    const Settings settings{{"attachments", std::string(kind)}};
    const auto filter =
        make_velocity_filter("pbd_substeps", square, {.settings = settings, .start = &start});
    Positions x = 1000 * rest;
    WorkCounters work;
    ASSERT_TRUE(filter->apply(rest, 0.01, x, work));
    EXPECT_NEAR(x.col(3).norm(), distance, 1e-9) << kind;
  }
  EXPECT_THROW(make_velocity_filter("pbd_substeps", square,
                                    {.settings = {{"attachments", std::string("straight")}}}),
               std::invalid_argument);
}

// At rest the impulses are the loads, and what is soft in them leaves link k longer by
// load / (m_k omega^2), omega = 2 pi frequency / h, m_k = 1 / (w_a + w_b).
TEST(SoftStep, LeavesAHangingRopeTheElongationOfItsSprings) {
  for (const double step : {0.004, 0.001}) {
    for (const double frequency : {0.25, 0.5}) {
      SCOPED_TRACE("step " + std::to_string(step) + ", frequency " + std::to_string(frequency));
      const auto longer = elongations("soft_step", step, {{"frequency", frequency}});
      const double omega = 2 * std::numbers::pi * frequency / step;
      for (int k = 1; k <= rope_links; ++k) {
        const double load = (rope_links - k + 1) * vertex_mass * testing::HangingRope::gravity;
        const double wanted = load / ((k == 1 ? vertex_mass : vertex_mass / 2) * omega * omega);
        EXPECT_NEAR(longer[k - 1], wanted, 1e-3 * wanted) << "link " << k;
      }
    }
  }
}

// A link that turns about a pin: the step's impulse is along its direction at the start, and the
// second stage leaves no velocity along it at the end.
TEST(SoftStep, LeavesNoVelocityAlongALink) {
  constexpr double step = 0.01;
  State state = testing::stretched_edge(1);
  state.v(1, 1) = 2;
  ASSERT_TRUE(make_stepper("soft_step", testing::one_edge(1, 1, {0}), {})->advance(state, step));
  EXPECT_NEAR(state.x(0, 1), 1, 1e-15);
  EXPECT_NEAR(state.x(1, 1), step * 2, 1e-15);
  const Eigen::Vector3d d = state.x.col(1), free(0, 2, 0);
  EXPECT_NEAR(state.v.col(1).dot(d), 0, 1e-15);
  EXPECT_NEAR((state.v.col(1) - (free - d.dot(free) / d.squaredNorm() * d)).norm(), 0, 1e-14);
}

}  // namespace
}  // namespace inextensible
