// The search for a stiffness, with runs that are formulas.
#include "harness/run/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace harness {
namespace {

constexpr double limit = 0.01;

struct Found {
  std::optional<double> stiffness;
  std::vector<double> tried;
  PointStatus status;
};

// strain(stiffness), in runs that are cut short as real ones are.
template <class Strain>
Found search(double guess, Strain strain) {
  std::vector<double> tried;
  Calibration calibration(limit, [&](double stiffness) -> Calibration::Trial {
    tried.push_back(stiffness);
    const double reached = std::min(strain(stiffness), 1.05 * Calibration::cut_short * limit);
    return {reached <= limit ? PointStatus::ok : PointStatus::strain_missed, reached, 1, "formula"};
  });
  const auto found = calibration.find(guess);
  EXPECT_EQ(calibration.runs(), static_cast<int>(tried.size()));
  EXPECT_LE(calibration.runs(), Calibration::run_limit);
  return {found, tried, calibration.status()};
}

// What a limit of 1 % asks for is 300 N.
double tension_law(double stiffness) { return 3 / stiffness; }

// From above the law leads there; from below runs are cut short, and say little; and where tension
// grows with stiffness, it is no law.
TEST(Calibration, FindsItsWay) {
  const auto growing = [](double stiffness) {
    return 0.3 * std::pow(stiffness, -0.5) * (1 + 0.05 * std::sin(7 * std::log(stiffness)));
  };
  struct Row {
    std::function<double(double)> strain;
    double guess;
    std::size_t most_runs;
  };
  for (const Row& row :
       {Row{tension_law, 320, 1}, Row{tension_law, 400, 2}, Row{tension_law, 3000, 2},
        Row{tension_law, 3e6, 2}, Row{tension_law, 290, 8}, Row{tension_law, 100, 8},
        Row{tension_law, 10, 8}, Row{tension_law, 0.1, 8}, Row{growing, 1, 16},
        Row{growing, 100, 16}, Row{growing, 1e4, 16}, Row{growing, 1e6, 16}}) {
    const Found outcome = search(row.guess, row.strain);
    ASSERT_TRUE(outcome.stiffness) << row.guess;
    EXPECT_LE(row.strain(*outcome.stiffness), limit);
    EXPECT_GE(row.strain(*outcome.stiffness), 0.85 * limit);
    EXPECT_LE(outcome.tried.size(), row.most_runs) << row.guess;
  }
}

TEST(Calibration, GivesUpWhereNoStiffnessHelps) {
  const Found outcome = search(100, [](double) { return 0.02; });
  EXPECT_FALSE(outcome.stiffness);
  EXPECT_EQ(outcome.status, PointStatus::strain_missed);
}

// A time-out is no strain: not "too soft", which would send the search to stiffer, slower springs.
TEST(Calibration, EndsWithTheFirstRunThatTimesOut) {
  for (const bool after_a_success : {false, true}) {
    std::vector<double> tried;
    Calibration calibration(limit, [&](double stiffness) -> Calibration::Trial {
      tried.push_back(stiffness);
      if (after_a_success && tried.size() == 1) return {PointStatus::ok, 0.1 * limit, 1, ""};
      return {PointStatus::timeout, 0.0035, 61.5, "longer than 60 s; stopped at t = 0.25 s"};
    });
    EXPECT_FALSE(calibration.find(1000));
    EXPECT_EQ(tried.size(), after_a_success ? 2u : 1u);
    EXPECT_EQ(calibration.status(), PointStatus::skipped);
    for (const char* said :
         {"timed out while calibrating", "0.0035", "61.5 s", "stopped at t = 0.25 s",
          after_a_success ? "run 2" : "stiffness 1000 N"})
      EXPECT_NE(calibration.detail().find(said), std::string::npos) << calibration.detail();
  }
}

// Runs that fail beyond some stiffness, or below one, as Newton's iteration does, at a strain that
// the run's beginning alone has seen.
TEST(Calibration, LooksOnBothSidesOfARunThatFailed) {
  for (const bool stiff_ones_fail : {true, false}) {
    const auto works = [&](double stiffness) {
      return stiff_ones_fail ? stiffness < 330 : stiffness > 301;
    };
    for (const double guess : stiff_ones_fail ? std::vector{400.0, 1000.0} : std::vector{150.0}) {
      int failures = 0;
      Calibration calibration(limit, [&](double stiffness) -> Calibration::Trial {
        const double strain = tension_law(stiffness);
        if (!works(stiffness)) {
          ++failures;
          return {PointStatus::not_converged, 0.4 * strain, 1, "Newton"};
        }
        return {strain <= limit ? PointStatus::ok : PointStatus::strain_missed, strain, 1, ""};
      });
      const auto found = calibration.find(guess);
      ASSERT_TRUE(found) << guess;
      EXPECT_TRUE(works(*found));
      EXPECT_LE(tension_law(*found), limit);
      EXPECT_GE(tension_law(*found), 0.85 * limit);
      EXPECT_GT(failures, 0);
    }
  }
}

TEST(Calibration, EndsWhereEverythingFailsAndSaysHow) {
  Calibration calibration(limit, [](double) -> Calibration::Trial {
    return {PointStatus::not_converged, 0.002, 1, "step 3: the Newton matrix is singular"};
  });
  EXPECT_FALSE(calibration.find(100));
  EXPECT_EQ(calibration.runs(), Calibration::failure_limit);
  EXPECT_EQ(calibration.status(), PointStatus::not_converged);
  EXPECT_EQ(calibration.detail(), "calibration, step 3: the Newton matrix is singular");
}

}  // namespace
}  // namespace harness
