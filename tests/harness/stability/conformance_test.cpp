// `bench check` must tell sound solvers from broken ones, and say what is broken: each solver here
// is fast projection with one fault, and fails the check that is meant for it and no other.
#include "harness/stability/conformance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <iostream>
#include <set>

#include "harness/stability/stability.h"
#include "support/effort.h"
#include "support/param_name.h"

namespace inextensible {
namespace {

using harness::Finding;

// What a fault gets to see; it corrupts x after a step that was accepted, or before it.
struct Step {
  const Problem& problem;
  const Positions& x_start;
  Positions& x;
  WorkCounters& work;
};

enum class When { before, corrected, refused };  // corrected: after a step that took an iteration
struct Fault {
  const char* name;
  const char* check;  // that is meant for it
  When when;
  void (*act)(const Step&);
  double limit_factor = 1;
  bool in_hard_cases = false;  // found by these as well
};

constexpr auto nothing = [](const Step&) {};

const Fault faults[] = {
    {"sound", "", When::before, nothing},
    {"ignores_the_limit", "limit", When::before, nothing, 2, true},
    {"moves_a_pin", "pins", When::corrected,
     [](const Step& s) {
       for (const int pin : s.problem.pinned()) s.x(1, pin) += 1e-15;
     }},
    {"writes_to_the_start", "refusal", When::refused,
     [](const Step& s) { const_cast<Positions&>(s.x_start)(1, 1) += 1e-9; }},
    {"remembers_others", "determinism", When::corrected,
     [](const Step& s) {
       static int calls = 0;
       if (++calls % 3 == 0) s.x(1, s.x.cols() - 1) += 1e-14;
     }},
    {"drifts", "linear momentum", When::corrected,
     [](const Step& s) {
       if (s.problem.pinned().empty()) s.x.colwise() += Eigen::Vector3d(0, 1e-8, 0);
     },
     1, true},
    {"turns", "angular momentum", When::corrected,
     [](const Step& s) {
       if (!s.problem.pinned().empty()) return;
       const Eigen::Map<const Eigen::VectorXd> mass(s.problem.mass().data(), s.problem.vertices());
       const Eigen::Vector3d centre = s.x * mass / s.problem.total_mass();
       const Eigen::AngleAxisd turn(1e-5, Eigen::Vector3d::UnitY());
       s.x = ((turn.toRotationMatrix() * (s.x.colwise() - centre)).colwise() + centre).eval();
     }},
    {"damps_by_the_step", "consistency", When::before,
     [](const Step& s) {  // a twentieth of the velocity, however short the step is
       if (s.problem.vertices() == 8) s.x = (0.95 * s.x + 0.05 * s.x_start).eval();
     }},
    {"drags_across", "motion in space", When::before,
     [](const Step& s) {  // a hundredth of the velocity along z
       if (s.problem.vertices() == 7)
         s.x.row(2) = (0.99 * s.x.row(2) + 0.01 * s.x_start.row(2)).eval();
     }},
    {"remembers_refusals", "refusal", When::before,
     [](const Step& s) {  // where positions overflowed, the next step is another one
       static bool overflowed = false;
       if (overflowed) s.x(0, s.x.cols() - 1) *= 1 + 1e-12;
       overflowed = s.x.maxCoeff() > 1e200;
     }},
    {"uncounts_work", "counters", When::corrected, [](const Step& s) { s.work.iterations -= 100; }},
    {"meddles", "permissible candidate", When::before,
     [](const Step& s) {
       if (s.problem.pinned().size() == 1 && s.problem.vertices() == 25) s.x.col(20) *= 1.001;
     }},
    {"gives_up", "steps", When::before, [](const Step& s) {
       if (s.problem.collider()) s.x(0, 0) = std::numeric_limits<double>::quiet_NaN();
     }}};

struct Corrupted final : VelocityFilter {
  Corrupted(const Problem& problem, double limit, const Fault& fault)
      : problem_(problem),
        fault_(fault),
        filter_(make_velocity_filter("fast_projection", problem, {fault.limit_factor * limit})) {}
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override {
    const Step step{problem_, x_start, x, work};
    if (fault_.when == When::before) fault_.act(step);
    const StepResult result = filter_->apply(x_start, h, x, work);
    if (fault_.when == When::refused && !result) fault_.act(step);
    if (fault_.when == When::corrected && result && result.iterations > 0) fault_.act(step);
    return result;
  }

 private:
  const Problem& problem_;
  const Fault& fault_;
  std::unique_ptr<VelocityFilter> filter_;
};

Backend row(const char* name, const Fault& fault = faults[0]) {
  Backend corrupted{.name = name, .summary = "fast projection, corrupted"};
  corrupted.make = [&fault](std::shared_ptr<const Problem> problem, const BackendOptions& options) {
    auto filter = std::make_unique<Corrupted>(*problem, options.strain_limit, fault);
    return std::make_unique<FilterStepper>(std::move(problem), std::move(filter));
  };
  return corrupted;
}

using Checks = std::set<std::string>;

Checks failed_checks(const std::string& solver, bool hard_cases = false) {
  Checks failed;
  for (const Finding& finding : harness::examine(solver, {1, hard_cases})) {
    if (finding.grade != Finding::Grade::fail) continue;
    failed.insert(finding.check);
    std::cout << solver << ": " << finding.check << ", " << finding.measured << '\n'
              << finding.advice << '\n';
    EXPECT_NE(finding.measured, "") << finding.check;
    EXPECT_NE(finding.advice, "") << finding.check;
  }
  return failed;
}

struct BrokenSolvers : ::testing::Test {
  static void SetUpTestSuite() {
    if (find_backend("sound")) return;
    std::vector<Backend> rows{row("over_relaxed")};
    rows[0].make = [](std::shared_ptr<const Problem> problem, BackendOptions options) {
      options.settings["relaxation"] = 1.3;
      return make_stepper("gauss_seidel", std::move(problem), options);
    };
    for (const Fault& fault : faults) rows.push_back(row(fault.name, fault));
    add_backends(rows);
  }
};

TEST_F(BrokenSolvers, FailTheCheckThatIsMeantForThemAndNoOther) {
  if (testing::sanitized) GTEST_SKIP() << "too slow with sanitizers";
  for (const Fault& fault : faults) {
    Checks wanted{fault.check};
    if (fault.in_hard_cases) wanted.insert("hard cases");
    wanted.erase("");
    EXPECT_EQ(failed_checks(fault.name, fault.in_hard_cases), wanted) << fault.name;
  }
  // Its corrections overshoot, but along their edges, which is not a fault.
  EXPECT_EQ(failed_checks("over_relaxed"), Checks{});
}

TEST_F(BrokenSolvers, CannotTakeANameOrBringHalfARow) {
  const std::size_t count = backends().size();
  const Backend good = row("good");
  for (const char* name : {"shake", "sound", "", "two words", "Upper", "a/b"}) {
    const std::vector<Backend> rows{good, row(name)};
    EXPECT_THROW(add_backends(rows), std::invalid_argument) << name;
  }
  Backend half = row("half");
  half.make = nullptr;
  EXPECT_THROW(add_backends(std::vector<Backend>{good, half}), std::invalid_argument);
  EXPECT_THROW(add_backends(std::vector<Backend>{good, good}), std::invalid_argument);
  EXPECT_EQ(backends().size(), count);
  EXPECT_EQ(find_backend("good"), nullptr);
  EXPECT_FALSE(is_built_in("sound"));
  EXPECT_TRUE(is_built_in("dense_newton"));
}

class BuiltInSolvers : public ::testing::TestWithParam<const char*> {};

TEST_P(BuiltInSolvers, Conform) {
  if (testing::sanitized) GTEST_SKIP() << "too slow with sanitizers";
  EXPECT_EQ(failed_checks(GetParam(), true), Checks{});
}

INSTANTIATE_TEST_SUITE_P(All, BuiltInSolvers, ::testing::ValuesIn(names::rows_that([](auto& row) {
                           return is_built_in(row.name);
                         })),
                         names::contestant_name);

}  // namespace
}  // namespace inextensible
