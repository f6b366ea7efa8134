// Problems without an edge: nothing to constrain, so everybody falls freely or stays where it is
// pinned.
#include <gtest/gtest.h>

#include "solvers/registry.h"

namespace inextensible {
namespace {

struct Mesh {
  const char* name;
  int vertices;
  std::vector<int> pinned;
};
const Mesh meshes[] = {{"one vertex", 1, {}},
                       {"one pinned vertex", 1, {0}},
                       {"three vertices", 3, {}},
                       {"all pinned", 3, {0, 1, 2}},
                       {"one of three pinned", 3, {1}}};

// The solver as it is, and once for each word that one of its settings may have.
std::vector<Settings> variants(const Backend& backend) {
  std::vector<Settings> list{{}};
  for (const SettingInfo& info : backend.settings) {
    for (const char* word : info.choices) list.push_back({{info.name, std::string(word)}});
  }
  return list;
}

std::string text_of(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings) text += name + "=" + std::get<std::string>(value);
  return text;
}

TEST(WithoutEdges, EverySolverWithEveryLinearSolverLetsVerticesFall) {
  const double step = 0.01;
  int runs = 0;
  for (const Backend& backend : backends()) {
    for (const Settings& settings : variants(backend)) {
      for (const Mesh& mesh : meshes) {
        SCOPED_TRACE(std::string(backend.name) + " " + text_of(settings) + ", " + mesh.name);
        ProblemParts parts;
        parts.mass.assign(static_cast<std::size_t>(mesh.vertices), 0.5);
        parts.pinned = mesh.pinned;
        parts.gravity = {0, -9.81, 0};
        const auto problem = std::make_shared<const Problem>(parts);
        State state;
        state.x = Positions::Random(3, mesh.vertices);
        state.v = Positions::Zero(3, mesh.vertices);
        const Positions start = state.x;
        std::unique_ptr<Stepper> stepper;
        try {
          stepper = make_stepper(backend.name, problem, {0.01, 1, settings});
        } catch (const std::invalid_argument&) {
          continue;  // a clean refusal, of chain solvers for instance
        }
        ++runs;
        for (int i = 0; i < 4; ++i) {
          const StepResult result = stepper->advance(state, step);
          ASSERT_TRUE(result) << result.detail;
        }
        for (int i = 0; i < mesh.vertices; ++i) {
          const bool pinned =
              std::find(mesh.pinned.begin(), mesh.pinned.end(), i) != mesh.pinned.end();
          // Steps of order one fall between these two, second-order ones in their middle.
          const double fallen = start(1, i) - state.x(1, i), t = 4 * step;
          EXPECT_NEAR(fallen, pinned ? 0 : 0.5 * 9.81 * t * t,
                      pinned ? 0 : 0.5 * 9.81 * t * step * 1.01);
          EXPECT_NEAR(state.x(0, i), start(0, i), pinned ? 0 : 1e-14);
        }
      }
    }
  }
  EXPECT_GT(runs, 60);
}

}  // namespace
}  // namespace inextensible
