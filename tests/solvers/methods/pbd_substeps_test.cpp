// Small steps against an independent sweep over the same colors, the strain that theory gives a
// loaded yarn, and what attachments promise.

#include <gtest/gtest.h>

#include "solvers/methods/colored_edges.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/registry.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

// Equation 18 of Macklin et al. 2016 for one edge after the other, in the order of the colors.
Positions swept(const Problem& problem, Positions x, double relaxation) {
  const ColoredEdges colored(problem);
  for (int entry = 0; entry < colored.entries(); ++entry) {
    const int k = colored.problem_edge()[entry];
    if (k < 0) continue;
    const Edge e = problem.edges()[k];
    const double wa = problem.inverse_mass()[e.a], wb = problem.inverse_mass()[e.b];
    const Eigen::Vector3d d = x.col(e.b) - x.col(e.a);
    const Eigen::Vector3d n = d.normalized();
    const double lambda = -relaxation * (d.norm() - problem.rest_length()[k]) / (wa + wb);
    x.col(e.a) -= wa * lambda * n;
    x.col(e.b) += wb * lambda * n;
  }
  return x;
}

TEST(PbdSubsteps, AreAGivenNumberOfSweeps) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    testing::Random random(seed);
    const auto mesh = testing::random_mesh(random, 1 + static_cast<int>(random() % 12),
                                           2 + static_cast<int>(random() % 12), 2);
    const int sweeps = 1 + static_cast<int>(random() % 3);
    const double relaxation = testing::uniform(random, 0.5, 1.5);
    const auto filter = make_velocity_filter(
        "pbd_substeps", *mesh.problem,
        {.settings = {{"sweeps", static_cast<double>(sweeps)}, {"relaxation", relaxation}}});
    Positions x = testing::perturbed(random, mesh, 0.05), wanted = x;
    for (int i = 0; i < sweeps; ++i) wanted = swept(*mesh.problem, wanted, relaxation);
    WorkCounters work;
    ASSERT_TRUE(filter->apply(mesh.x, 0.01, x, work));
    EXPECT_LE((x - wanted).cwiseAbs().maxCoeff(), 1e-12);
  }
}

// A yarn at rest that hangs by one end.
struct Hanging {
  static constexpr int links = 10;
  static constexpr double length = 0.1, gravity = 9.81;

  explicit Hanging(double step, std::string attachments = "none", double seconds = 2) {
    ProblemParts parts;
    parts.gravity = {0, -gravity, 0};
    parts.mass.assign(links + 1, 0.1);
    parts.pinned = {0};
    for (int i = 0; i < links; ++i) parts.edges.push_back({i, i + 1});
    parts.rest_length.assign(links, length);
    problem = std::make_shared<const Problem>(parts);
    State start{Positions::Zero(3, links + 1), Positions::Zero(3, links + 1), 0};
    for (int i = 0; i <= links; ++i) start.x(1, i) = -i * length;
    BackendOptions options{.settings = {{"attachments", std::move(attachments)}}};
    options.start = &start;
    const auto stepper = make_stepper("pbd_substeps", problem, options);
    state = start;
    for (double t = 0; t < seconds; t += step) EXPECT_TRUE(stepper->advance(state, step));
  }
  double largest_strain() const { return EdgeConstraints(*problem, 1).worst(state.x).strain; }

  std::shared_ptr<const Problem> problem;
  State state;
};

// Along a vertical line a sweep is linear. With one sweep a step in two colors, here the links 2,
// 4,
// ... from the pin before 1, 3, ..., a yarn rests where each vertex is lifted by the g h^2 that
// it falls: the links of the last color have their rest length, and link k of N of the first is
// longer by 2 (N - k + 1) g h^2. (A sweep from the pin downwards leaves (N - k) g h^2 in link k.)
TEST(PbdSubsteps, LeaveAHangingYarnTheStrainOfTheory) {
  for (const double step : {0.004, 0.002, 0.001, 0.0005}) {
    const Hanging yarn(step, "none", 20);
    const double fall = Hanging::gravity * step * step;
    for (int k = 1; k <= Hanging::links; ++k) {
      const double longer = k % 2 == 0 ? 2 * (Hanging::links - k + 1) * fall : 0;
      const double length = (yarn.state.x.col(k) - yarn.state.x.col(k - 1)).norm();
      EXPECT_NEAR(length - Hanging::length, longer, 1e-3 * fall) << "link " << k << ", " << step;
    }
  }
}

TEST(PbdSubsteps, AttachmentsHoldAHangingYarnAtItsLength) {
  for (const char* attachments : {"edges", "straight"}) {
    SCOPED_TRACE(attachments);
    const Hanging yarn(0.002, attachments);
    for (int i = 0; i <= Hanging::links; ++i)
      EXPECT_LE((yarn.state.x.col(i) - yarn.state.x.col(0)).norm(),
                i * Hanging::length * (1 + 1e-12));
    EXPECT_LT(yarn.largest_strain(), 0.1 * Hanging(0.002).largest_strain());
  }
}

// The way along edges, here around a corner of a net.
TEST(PbdSubsteps, AttachmentsFollowEdgesOrGoStraight) {
  testing::Random random(1);
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass.assign(4, 1);
  parts.pinned = {0};
  parts.edges = {{0, 1}, {1, 3}, {0, 2}, {2, 3}};
  parts.rest_length.assign(4, 1);
  const Problem square(parts);
  Positions rest(3, 4);
  rest << 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0;
  for (const auto& [kind, distance] :
       {std::pair<std::string_view, double>{"edges", 2}, {"straight", std::sqrt(2.0)}}) {
    const State start{rest, 0 * rest, 0};
    const auto filter =
        make_velocity_filter("pbd_substeps", square,
                             {.settings = {{"attachments", std::string(kind)}}, .start = &start});
    Positions x = 1000 * rest;
    WorkCounters work;
    ASSERT_TRUE(filter->apply(rest, 0.01, x, work));
    EXPECT_NEAR(x.col(3).norm(), distance, 1e-9) << kind;
  }
  EXPECT_THROW(make_velocity_filter("pbd_substeps", square,
                                    {.settings = {{"attachments", std::string("straight")}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace inextensible
