// What contact does to a run as a whole: with the step errors fall, and energy does not come back.
#include <gtest/gtest.h>

#include <string>

#include "harness/judge/reference.h"
#include "harness/run/measure_point.h"
#include "solvers/registry.h"
#include "support/param_name.h"

namespace harness {
namespace {

PointResult drape(const std::string& solver, double permitted, double h,
                  std::shared_ptr<ReferenceFolder> references) {
  const auto found_type = find_scene("drape");
  PointSpec spec;
  spec.sweep = "strain";
  spec.scene = "drape";
  spec.scene_parameters = complete_parameters(*found_type, {{"n", 15}});
  spec.solver = spec.contestant = solver;
  spec.strain_limit = permitted;
  spec.step = h;
  RunLimits limits;
  limits.timed = false;
  limits.references = std::move(references);
  return run_point(spec, limits, {});
}

class DrapeErrors : public ::testing::TestWithParam<const char*> {};

// A cloth that falls onto a sphere with friction, nearly inextensible: with each halving of the
// step the error falls until it is what the reference cannot tell from zero, and what is dissipated
// never comes back.
TEST_P(DrapeErrors, FallWithTheStepToTheReferencesGap) {
  const auto references =
      std::make_shared<ReferenceFolder>(std::string(SOURCE_DIR) + "/results/references");
  double before = 1;
  for (const double h : {0.02, 0.01, 0.005, 0.0025, 0.00125}) {
    const PointResult point = drape(GetParam(), 0.001, h, references);
    ASSERT_EQ(point.status, PointStatus::ok) << "h = " << h << ": " << point.detail;
    EXPECT_LE(point.measures.energy_rise, 0.002) << "h = " << h;
    double error = 0, sure = 0;
    for (const ErrorSample& sample : point.measures.error_series) {
      if (!(sure_gaps * sample.gap <= headline_error)) continue;
      error = std::max(error, sample.error);
      sure = std::max(sure, sure_gaps * sample.gap);
    }
    EXPECT_GT(error, 0);
    EXPECT_LE(error, std::max(0.9 * before, sure)) << "h = " << h;
    before = error;
  }
}

INSTANTIATE_TEST_SUITE_P(ContactMethods, DrapeErrors,
                         ::testing::Values("fast_projection", "icd", "yarn_projection",
                                           "yarn_projection@bdf2", "yarn_projection@midpoint",
                                           "fast_projection_adaptive@bdf2", "gauss_seidel_colored",
                                           "jacobi", "implicit_springs"),
                         inextensible::names::contestant_name);

// Edges that shake between limits of 10 % bring energy back step by step.
TEST(EnergyRise, OfAShakingClothFailsIt) {
  const PointResult point = drape("fast_projection", 0.1, 1.0 / 1600, nullptr);
  EXPECT_EQ(point.status, PointStatus::energy_gained) << point.detail;
  EXPECT_GT(point.measures.energy_rise, 0.05);
}

}  // namespace
}  // namespace harness
