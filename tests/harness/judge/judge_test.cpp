// The judge on motions that are made up: which samples of a reference count, what is delivered
// after a collision, and what hardly moves. Strain against figures found by hand.
#include "harness/judge/judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "harness/judge/mechanics.h"
#include "support/scenes.h"

namespace harness {
namespace {

using inextensible::State;

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
Measures judged(const std::shared_ptr<const Reference>& reference, double times_as_far, double off,
                int steps = 5) {
  return judged(reference, times_as_far, std::vector<double>(steps, off));
}

// However far off a run is, its error is over the sample times at which 3 gap is at most the level.
TEST(Judge, CountsTheSameSampleTimesForAllRuns) {
  const auto reference = falling();
  for (const double off : {0.4, 0.01, 0.002, 1e-5}) {
    const Measures found = judged(reference, 1, off);
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
  for (const Measures& found :
       {judged(unsure, 1, 0.4), judged(nullptr, 1, 0.4), judged(falling(), 1, 0.4, 1)}) {
    EXPECT_TRUE(std::isnan(found.trajectory));
    EXPECT_NE(found.unknown_because, "");
  }
}

TEST(Judge, MeasuresHowFarARunHasMoved) {
  EXPECT_NEAR(judged(falling(), 0.3, 0).moved, 0.3, 1e-12);
  EXPECT_EQ(judged(falling(), 0, 0).moved, 0);
}

TEST(Strain, OfEdgesThatAreTooLongAndTooShort) {
  inextensible::ProblemParts parts;
  parts.mass = {1, 2, 3};
  parts.edges = {{0, 1}, {1, 2}};
  parts.rest_length = {1, 2};
  const inextensible::Problem problem(std::move(parts));
  inextensible::Positions x = inextensible::Positions::Zero(3, 3);
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
  // One of the twelve edges is longer and one shorter by 0.2, two turn: sqrt(1.04) - 1.
  const double turned = std::sqrt(1.04) - 1;
  EXPECT_NEAR(found.delivered_strain_rms, std::sqrt((2 * 0.2 * 0.2 + 2 * turned * turned) / 12),
              1e-12);
  EXPECT_GT(found.delivered_strain_p99, 0.19);
  EXPECT_NEAR(found.rms_strain, 0, 1e-12);
}

}  // namespace
}  // namespace harness
