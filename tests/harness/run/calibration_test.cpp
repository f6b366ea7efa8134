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

// A run that is cut short as real ones are.
CalibrationTrial judged(double strain) {
  const double reached = std::min(strain, 1.05 * calibration_cut_short * limit);
  return {reached <= limit ? PointStatus::ok : PointStatus::strain_missed, reached, 1, "formula"};
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
    int most_runs;
  };
  for (const Row& row :
       {Row{tension_law, 320, 1}, Row{tension_law, 400, 2}, Row{tension_law, 3000, 2},
        Row{tension_law, 3e6, 2}, Row{tension_law, 290, 8}, Row{tension_law, 100, 8},
        Row{tension_law, 10, 8}, Row{tension_law, 0.1, 8}, Row{growing, 1, 16},
        Row{growing, 100, 16}, Row{growing, 1e4, 16}, Row{growing, 1e6, 16}}) {
    int runs = 0;
    const Calibration found =
        calibrate_stiffness(limit, row.guess, [&](double stiffness) -> CalibrationTrial {
          ++runs;
          return judged(row.strain(stiffness));
        });
    ASSERT_TRUE(found.stiffness) << row.guess;
    EXPECT_LE(row.strain(*found.stiffness), limit);
    EXPECT_GE(row.strain(*found.stiffness), 0.85 * limit);
    EXPECT_EQ(found.runs, runs);
    EXPECT_LE(runs, row.most_runs) << row.guess;
  }
}

// A time-out is no strain: not "too soft", which would send the search to stiffer, slower springs.
TEST(Calibration, GivesUpAndSaysWhy) {
  const CalibrationTrial soft = judged(0.02), good{PointStatus::ok, 0.1 * limit, 1, ""},
                         slow{PointStatus::timeout, 0.0035, 61.5, "stopped at t = 0.25 s"},
                         fails{PointStatus::not_converged, 0.002, 1, "step 3: singular"};
  struct Row {
    CalibrationTrial first, later;
    PointStatus status;
    int runs;
    std::vector<const char*> said;
  };
  for (const Row& row :
       {Row{soft, soft, PointStatus::strain_missed, calibration_run_limit, {"no stiffness"}},
        Row{slow, slow, PointStatus::skipped, 1, {"while calibrating", "stiffness 1000 N"}},
        Row{good, slow, PointStatus::skipped, 2, {"run 2", "0.0035", "61.5 s", "t = 0.25 s"}},
        Row{fails,
            fails,
            PointStatus::not_converged,
            calibration_failure_limit,
            {"calibration, step 3: singular"}}}) {
    int runs = 0;
    const Calibration found = calibrate_stiffness(
        limit, 1000, [&](double) { return ++runs == 1 ? row.first : row.later; });
    EXPECT_FALSE(found.stiffness);
    EXPECT_EQ(found.status, row.status);
    EXPECT_EQ(found.runs, row.runs) << found.detail;
    for (const char* said : row.said)
      EXPECT_NE(found.detail.find(said), std::string::npos) << found.detail;
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
      const Calibration found =
          calibrate_stiffness(limit, guess, [&](double stiffness) -> CalibrationTrial {
            const double strain = tension_law(stiffness);
            if (works(stiffness))
              return {strain <= limit ? PointStatus::ok : PointStatus::strain_missed, strain, 1,
                      ""};
            ++failures;
            return {PointStatus::not_converged, 0.4 * strain, 1, "Newton"};
          });
      ASSERT_TRUE(found.stiffness) << guess;
      EXPECT_TRUE(works(*found.stiffness));
      EXPECT_LE(tension_law(*found.stiffness), limit);
      EXPECT_GE(tension_law(*found.stiffness), 0.85 * limit);
      EXPECT_GT(failures, 0);
    }
  }
}

}  // namespace
}  // namespace harness
