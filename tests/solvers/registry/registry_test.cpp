// What rows and their tables promise: of methods and their settings.
#include "solvers/registry.h"

#include "solvers/problem/edge_constraints.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

TEST(Registry, RowsSayWhatFiguresNeed) {
  std::set<std::string> labels;
  for (const Backend& row : backends()) {
    SCOPED_TRACE(row.name);
    EXPECT_TRUE(labels.insert(row.label).second) << row.label;
    const Backend* family = find_backend(row.family);
    ASSERT_NE(family, nullptr) << row.family;
    EXPECT_STREQ(family->family, family->name);
    EXPECT_EQ(family->direction, row.direction);
    if (row.contestant) {
      EXPECT_STRNE(row.citation, "");
      EXPECT_NE(row.direction, Direction::none);
    }
  }
}

// Each method is there once by itself, and in each other stepper or not, with the reason.
TEST(Registry, EveryPairIsARowOrHasAReason) {
  for (const Backend& method : backends()) {
    if (!method.contestant || std::string_view(method.name) != method.method) continue;
    const std::string published = std::string(method.name) + "@" + method.stepper;
    EXPECT_EQ(find_backend(published), find_backend(method.name)) << published;
    for (const TimeStepper& stepper : time_steppers()) {
      const std::string name = std::string(method.name) + "@" + stepper.name;
      SCOPED_TRACE(name);
      const Backend* pair = find_backend(name);
      EXPECT_EQ(pair == nullptr, mismatch(method, stepper) != nullptr);
      EXPECT_EQ(why_no_pair(name).empty(), pair != nullptr);
      if (!pair) continue;
      EXPECT_STREQ(pair->method, method.name);
      EXPECT_STREQ(pair->stepper, stepper.name);
      EXPECT_EQ(pair->origin, method.origin);
      EXPECT_EQ(pair->stepper_origin, stepper.origin);
      EXPECT_TRUE(pair->contestant);
    }
  }
  EXPECT_NE(why_no_pair("icd@leapfrog"), "");
  EXPECT_EQ(why_no_pair("icy@bdf2"), "");
}

TEST(Registry, DefaultsAndTunableRangesArePermitted) {
  for (const Backend& row : backends())
    for (const SettingInfo& info : row.settings) {
      SCOPED_TRACE(std::string(row.name) + ": " + info.name);
      if (const auto* word = std::get_if<const char*>(&info.initial)) {
        EXPECT_NO_THROW(complete_settings(row, {{info.name, std::string(*word)}}));
        continue;
      }
      EXPECT_TRUE(info.range.contains(std::get<double>(info.initial)));
      if (!info.tunable) continue;
      EXPECT_LT(info.tunable->least, info.tunable->largest);
      EXPECT_TRUE(info.range.contains(info.tunable->least));
      EXPECT_TRUE(info.range.contains(info.tunable->largest));
    }
}

TEST(Registry, SettingsOutOfRangeAreRefusedByName) {
  const struct {
    const char *solver, *setting;
    std::variant<double, std::string> value;
    bool taken;
  } cases[] = {{"jacobi", "relaxation", 2.0, false},
               {"jacobi", "relaxation", 1.99, true},
               {"shake", "max_iterations", 1.5, false},
               {"shake", "max_iterations", 0.0, false},
               {"gauss_seidel", "target", 1.01, false},
               {"gauss_seidel", "target", 1.0, true},
               {"icd", "cg_tolerance", std::nan(""), false},
               {"icd", "cg_tolerance", "low", false},
               {"icd", "colour", 1.0, false}};
  for (const auto& [solver, setting, value, taken] : cases) {
    std::string refusal;
    try {
      complete_settings(*find_backend(solver), {{setting, value}});
    } catch (const std::invalid_argument& error) {
      refusal = error.what();
    }
    EXPECT_EQ(refusal.empty(), taken) << refusal;
    EXPECT_TRUE(taken || refusal.starts_with(std::string("solver '") + solver + "': setting '" +
                                             setting + "' "))
        << refusal;
  }
}

struct Recorder final : IterateObserver {
  void iterate(const EdgeConstraints& edges, int j, const Positions& x,
               const Eigen::VectorXd& multipliers) override {
    if (j == 0) largest = 0;
    if (j > 0) {  // x_{j+1} = x_j - W J(x_j)^T h^2 dlambda
      Eigen::Matrix3Xd u(3, multipliers.size());
      edges.gradient(before, u);
      Positions step = before - x;
      edges.apply(u, multipliers - multipliers_before, step);
      largest = std::max(largest, step.cwiseAbs().maxCoeff());
    }
    before = x;
    multipliers_before = multipliers;
    last = j;
  }
  Positions before;
  Eigen::VectorXd multipliers_before;
  int last = -1;
  double largest = 0;
};

TEST(Observer, SeesIteratesAndTheirMultipliersAndChangesNothing) {
  testing::for_seeds(4, [&](testing::Random& random, std::uint64_t) {
    const testing::RandomMesh mesh = testing::random_mesh(random, 5, 6, 1);
    State state{mesh.x, (testing::perturbed(random, mesh, 1) - mesh.x) * 10}, alone = state;
    const BackendOptions options{1e-6, 1, {}};
    const auto observed = make_stepper("fast_projection", mesh.problem, options);
    Recorder recorder;
    observed->observe(&recorder);
    const StepResult result = observed->advance(state, 0.01);
    ASSERT_TRUE(result);
    EXPECT_GT(result.iterations, 1);
    EXPECT_EQ(recorder.last, result.iterations);
    EXPECT_LT(recorder.largest, 1e-10);
    ASSERT_TRUE(make_stepper("fast_projection", mesh.problem, options)->advance(alone, 0.01));
    EXPECT_EQ(state.x, alone.x);
  });
}

TEST(Observer, IsCalledByThoseThatSayIt) {
  testing::Random random(1);
  const testing::RandomMesh mesh = testing::random_mesh(random, 4, 4, 1);
  for (const Backend& row : backends()) {
    SCOPED_TRACE(row.name);
    State state{mesh.x, (testing::perturbed(random, mesh, 1) - mesh.x)};
    const auto stepper = make_stepper(row.name, mesh.problem, {0.001, 1, {}});
    Recorder recorder;
    stepper->observe(&recorder);
    stepper->advance(state, 0.01);
    EXPECT_EQ(recorder.last >= 0, row.shows_iterates);
  }
}

}  // namespace
}  // namespace inextensible
