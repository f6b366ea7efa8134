// The judge on motions that are made up, and on figures found by hand.
#include "harness/judge/judge.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "support/scenes.h"

namespace harness {
namespace {

using Eigen::Vector3d, inextensible::TriangleMesh;

const Scene chain_of_four = built_scene("chain", {{"n", 4}});

// Falls by t metres; gaps of 0.001, and of 0.1 from sample 3 on.
std::shared_ptr<Reference> falling() {
  auto r = std::make_shared<Reference>();
  r->scene = "chain";
  r->parameters = testing::parameters("chain", {{"n", 4}});
  for (int k = 1; k <= 5; ++k) {
    r->times.push_back(0.04 * k);
    r->positions.push_back(chain_of_four.start.x);
    r->positions.back().row(1).array() -= 0.04 * k;
    r->gap.push_back(k < 3 ? 0.001 : 0.1);
    r->gap_max.push_back(r->gap.back());
  }
  r->valid_until = 0.2;
  return r;
}

// A run that falls `times_as_far` and is off[k - 1] metres beside after step k.
Measures judged(const std::shared_ptr<const Reference>& reference, double times_as_far,
                const std::vector<double>& off) {
  Judge judge(chain_of_four, {.reference = reference});
  State state = chain_of_four.start;
  for (const double beside : off) {
    judge.before(state, 0.04);
    state.time += 0.04;
    state.x = chain_of_four.start.x;
    state.x.row(1).array() -= times_as_far * state.time;
    state.x.row(2).setConstant(beside);
    judge.after(state.x, state, 0.04);
  }
  return judge.finish();
}

// However far off a run is, its error is over the sample times at which 3 gap is at most the level.
TEST(Judge, CountsTheSameSampleTimesForAllRuns) {
  const auto reference = falling();
  for (const double off : {0.4, 0.01, 0.002, 1e-5}) {
    const Measures found = judged(reference, 1, std::vector(5, off));
    EXPECT_EQ(found.error_samples, 2) << off;
    EXPECT_EQ(found.error_samples, reference->samples_at(headline_error));
    EXPECT_DOUBLE_EQ(found.error_until, 0.08);
    EXPECT_NEAR(found.trajectory, off, 1e-12);
    EXPECT_NEAR(found.trajectory_max, off, 1e-12);
    EXPECT_NEAR(found.gap, 0.001, 1e-12);
    EXPECT_EQ(found.unknown_because, "");
    ASSERT_EQ(found.error_series.size(), 5u);
    EXPECT_NEAR(error_at(found, 0.003).distance, off, 1e-12);
    EXPECT_EQ(error_at(found, 0.31).samples, 5) << "a looser level has more samples";
    EXPECT_FALSE(within_error(found, 0.002)) << "no sample is that sure";
    EXPECT_EQ(within_error(found, 0.02), off <= 0.02);
    EXPECT_TRUE(within_error(found, any_motion));
  }
}

// The mean would hide how far off a run is at its worst: the largest counts.
TEST(Judge, ErrorIsTheLargestOverTime) {
  const auto reference = falling();
  reference->gap.assign(5, 0.001);
  const Measures found = judged(reference, 1, {0, 0.002, 0.011, 0.003, 0.004});
  EXPECT_NEAR(found.trajectory, 0.011, 1e-12);
  EXPECT_NEAR(found.trajectory_mean, 0.004, 1e-12);
  EXPECT_TRUE(within_error(found, 0.02));
  EXPECT_FALSE(within_error(found, 0.01));
}

TEST(Judge, KnowsNoErrorWithoutSureSamplesAndOfARunThatEndedEarly) {
  const auto unsure = falling();
  unsure->gap.assign(5, 0.01);
  const std::vector off(5, 0.4);
  for (const Measures& found :
       {judged(unsure, 1, off), judged(nullptr, 1, off), judged(falling(), 1, {0.4})}) {
    EXPECT_TRUE(std::isnan(found.trajectory));
    EXPECT_NE(found.unknown_because, "");
  }
}

TEST(Judge, MeasuresHowFarARunHasMoved) {
  const std::vector never(5, 0.0);
  EXPECT_NEAR(judged(falling(), 0.3, never).moved, 0.3, 1e-12);
  EXPECT_EQ(judged(falling(), 0, never).moved, 0);
}

TEST(Strain, OfEdgesThatAreTooLongAndTooShort) {
  ProblemParts parts;
  parts.mass = {1, 2, 3};
  parts.edges = {{0, 1}, {1, 2}};
  parts.rest_length = {1, 2};
  const Problem problem(std::move(parts));
  Positions x = Positions::Zero(3, 3);
  x.row(0) << 0, 1, 3;
  const auto expect = [&](double most, double stretch, std::size_t edge) {
    const StrainRange found = strain_range(problem, x);
    EXPECT_NEAR(found.most, most, 1e-15);
    EXPECT_NEAR(found.stretch, stretch, 1e-15);
    EXPECT_EQ(found.edge, edge);
  };
  EXPECT_EQ(strain_range(problem, x).most, 0);
  x(0, 2) = 2.5;  // the second edge: 1.5 m of 2 m
  expect(0.25, 0, 1);
  x(0, 0) = -0.5;  // the first: 1.5 m of 1 m
  expect(0.5, 0.5, 0);
  std::vector<double> strains;
  append_strains(problem, x, strains);
  EXPECT_EQ(strains, (std::vector<double>{0.5, 0.25}));
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    x(1, 2) = value;
    EXPECT_TRUE(std::isinf(strain_range(problem, x).most));
    EXPECT_EQ(strain_range(problem, x).edge, 1u);
  }
}

TEST(Judge, MeasuresStrainBeforeAndAfterTheObstacle) {
  const Scene drape = built_scene("drape", {{"n", 3}});
  Judge judge(drape, {});
  State state = drape.start;
  judge.before(state, 0.01);
  state.time = 0.01;
  state.x(0, 4) += 0.1;  // the middle vertex by a fifth of an edge's length
  judge.after(drape.start.x, state, 0.01);
  const Measures found = judge.finish();
  EXPECT_NEAR(found.max_strain, 0, 1e-12);
  EXPECT_NEAR(found.max_strain_after_collision, 0.2, 1e-12);
  EXPECT_NEAR(found.rms_strain, 0, 1e-12);
}

// ---- The energy of motions that are known: free fall, and a vibration in step with the steps ----

constexpr double g = 10;

// One edge of 1 m, two vertices of 1 kg, thrown upwards with this speed, m/s.
Scene pair_of_vertices(double speed = 0) {
  ProblemParts parts;
  parts.mass = {1, 1};
  parts.edges = {{0, 1}};
  parts.rest_length = {1};
  parts.gravity = {0, -g, 0};
  Scene scene;
  scene.problem = std::make_shared<const Problem>(std::move(parts));
  scene.start.x.setZero(3, 2);
  scene.start.x(0, 1) = 1;
  scene.start.v.setZero(3, 2);
  scene.start.v.row(1).setConstant(speed);
  return scene;
}

// Where such a pair of 2 m/s is at t = n h, with the mean velocity of the step before.
State thrown(State state, double t, double h) {
  state.time = t;
  state.x.row(1).setConstant(2 * t - 0.5 * g * t * t);
  state.v.row(1).setConstant(2 - g * (t - 0.5 * h));
  return state;
}

TEST(EnergyRecord, DoesNotTakeTheLagOfHalfStepVelocitiesForAGain) {
  const Scene scene = pair_of_vertices(2);
  for (const double h : {0.04, 0.02}) {
    EnergyRecord halves(scene, Velocities::half_step), whole(scene, Velocities::whole_step);
    for (int n = 1; n * h < 0.2; ++n) {  // it rises, and slows down
      halves.after(thrown(scene.start, n * h, h), h);
      whole.after(thrown(scene.start, n * h, h), h);
    }
    halves.finish();
    // What is left is of second order: m (g h / 2)^2 / 2 of each vertex. At the last step, without
    // one after it, energy is underestimated.
    const double second = 2 * 0.5 * std::pow(0.5 * g * h, 2) / halves.scale();
    EXPECT_NEAR(halves.gain(), second, 1e-12);
    EXPECT_GT(whole.gain(), 10 * second) << "the lag itself, of first order";
  }
}

// A record of the pair, and the state that it is shown after each step.
struct Recorded {
  explicit Recorded(Velocities velocities) : record(scene, velocities) {}
  const Scene scene = pair_of_vertices();
  EnergyRecord record;
  State state = scene.start;
};

TEST(EnergyRecord, SeesAVibrationThatTurnsRoundInEveryStep) {
  Recorded r(Velocities::half_step);
  for (int n = 1; n <= 10; ++n) {
    r.state.v.row(0) << (n % 2 == 0 ? 3 : -3), (n % 2 == 0 ? -3 : 3);
    r.record.after(r.state, 0.01);
  }
  EXPECT_NEAR(r.record.gain(), 9 / (2 * g), 1e-12);
}

// The gain of a loss throughout is negative.
TEST(EnergyRecord, TellsWhenEnergyWasHighest) {
  Recorded r(Velocities::whole_step);
  for (int n = 1; n <= 5; ++n) {
    r.state.time = 0.1 * n;
    r.state.x.row(1).setConstant(n == 3 ? -0.25 : -1);
    EXPECT_NEAR(r.record.after(r.state, 0.1).value(), n == 3 ? -0.25 : -1, 1e-12);
  }
  EXPECT_FALSE(r.record.finish());
  EXPECT_NEAR(r.record.gain(), -0.25, 1e-12);
  EXPECT_NEAR(r.record.gain_time(), 0.3, 1e-12);
  EXPECT_EQ(r.record.gain_step(), 3);
  EXPECT_NEAR(r.record.drift(), 1, 1e-12);
}

// Steps of different lengths: the end of the first is nearer the middle of the shorter one.
TEST(EnergyRecord, InterpolatesBetweenUnequalSteps) {
  Recorded r(Velocities::half_step);
  r.state.v(0, 0) = 2;  // 2 J
  EXPECT_FALSE(r.record.after(r.state, 0.3));
  r.state.v(0, 0) = 4;  // 8 J
  EXPECT_NEAR(r.record.after(r.state, 0.1).value(), (0.1 * 2 + 0.3 * 8) / 0.4 / (2 * g), 1e-12);
}

// ---- Ways through a body ----

TriangleMesh box(const Vector3d& half) {
  TriangleMesh mesh;
  add_block(mesh, -half, half);
  return mesh;
}

// How many of single vertices with these ways cross the body.
int crossed(const TriangleMesh& body, const std::vector<std::pair<Vector3d, Vector3d>>& ways,
            BodyMotion motion = {}) {
  ProblemParts parts;
  parts.mass.assign(ways.size(), 1);
  parts.collider = std::make_shared<inextensible::TriangleCollider>(body, 0);
  parts.body_motion = std::move(motion);
  const Problem problem(parts);
  State before{Positions(3, ways.size()), {}}, after = before;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    before.x.col(i) = ways[i].first;
    after.x.col(i) = ways[i].second;
  }
  after.time = 1;
  Crossings crossings(problem);
  crossings.before(before);
  crossings.after(after);
  return crossings.vertices();
}

// Through a plate, from its surface too; not beside it, into it, along it, or over its rim.
TEST(Crossings, AreWaysThroughThePlate) {
  const TriangleMesh plate = box({0.5, 0.0002, 0.5});
  for (const auto& [from, to, wanted] : std::vector<std::tuple<Vector3d, Vector3d, int>>{
           {{0.1, 0.01, 0.2}, {0.1, -0.01, 0.2}, 1},
           {{0.1, -0.3, 0.2}, {-0.2, 0.1, 0.2}, 1},
           {{0.1, 0.0002, 0.2}, {0.1, -0.0002, 0.2}, 1},
           {{0.6, 0.01, 0.2}, {0.6, -0.01, 0.2}, 0},
           {{0.1, 0.01, 0.2}, {0.1, 0.0001, 0.2}, 0},
           {{0.1, 0.0002, 0.2}, {0.4, 0.0002, 0.2}, 0},
           {{0.45, 0.001, 0.2}, {0.55, 0.0005, 0.2}, 0}})
    EXPECT_EQ(crossed(plate, {{from, to}}), wanted) << from.transpose() << " to " << to.transpose();
}

TEST(Crossings, AreSeenWhereThePlateMoves) {
  const Vector3d still(0.1, 0.05, 0.2);
  const auto rise = [](double time) {
    return Pose{Eigen::Matrix3d::Identity(), Vector3d(0, 0.1 * time, 0)};
  };
  EXPECT_EQ(crossed(box({0.5, 0.002, 0.5}), {{still, still}}), 0);
  EXPECT_EQ(crossed(box({0.5, 0.002, 0.5}), {{still, still}}, rise), 1);
}

// Chords of a ball: through its middle they cross, near its surface they cut a bulge.
TEST(Crossings, AreNotChordsOfABulge) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const TriangleMesh ball = inextensible::icosphere(Vector3d::Zero(), 1, 3);
  for (const auto& [turn, wanted] : {std::pair(0.2, 0), {0.9, 0}, {3.0, 20}}) {
    std::vector<std::pair<Vector3d, Vector3d>> ways;
    for (int i = 0; i < 20; ++i) {
      const Vector3d from = Vector3d(normal(random), normal(random), normal(random)).normalized();
      ways.emplace_back(1.01 * from,
                        Eigen::AngleAxisd(turn, from.unitOrthogonal()) * (1.01 * from));
    }
    EXPECT_EQ(crossed(ball, ways), wanted) << turn;
  }
}

}  // namespace
}  // namespace harness
