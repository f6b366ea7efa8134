// Random meshes through every solver with every linear solver: each step keeps its promises or is a
// clean refusal, whatever the mesh.
//   attack_meshes --seconds S --seed N
// Prints one line of JSON: what was done, and the first failures. Exit code 1 if there are any.
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/base/child_process.h"
#include "support/random_trial.h"

namespace {

using namespace inextensible;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr int batch = 50;            // meshes a child process
constexpr double most_seconds = 20;  // that one mesh may take

// A solver, as it is or with one word chosen: its linear solver, its start.
struct Variant {
  const char* backend;
  Settings settings;
  std::string name;
};

std::vector<Variant> variants() {
  std::vector<Variant> list;
  for (const Backend& backend : backends()) {
    if (backend.knob == Knob::none) continue;
    const Settings settings = testing::impatient(backend.name);
    list.push_back({backend.name, settings, backend.name});
    for (const SettingInfo& info : backend.settings) {
      for (const char* word : info.choices) {
        Settings chosen = settings;
        chosen[info.name] = std::string(word);
        list.push_back(
            {backend.name, chosen, std::string(backend.name) + " " + info.name + "=" + word});
      }
    }
  }
  return list;
}

// Chains and quads, for linear solvers that take no other pattern, and random graphs.
testing::Trial trial_of(testing::Random& random) {
  testing::Trial trial = testing::random_trial(random);
  const auto kind = random() % 3;
  if (kind == 0) {
    // Graphs with a locked part have large multipliers that cancel: of one in half a million single
    // precision leaves 6e-5.
    trial.momentum_tolerance = 1e-3;
    return trial;
  }
  const bool chain = kind == 1;
  const auto below = [&](std::uint64_t n) { return static_cast<int>(random() % n); };
  const int rows = chain ? 1 : 2 + below(4), columns = 2 + below(chain ? 20 : 4);
  const auto mesh = testing::random_mesh(random, rows, columns, below(3));
  trial.scene.problem = mesh.problem;
  trial.scene.start.x =
      testing::perturbed(random, mesh, std::pow(10, testing::uniform(random, -3, 0)));
  trial.scene.start.v = (testing::perturbed(random, mesh, 1) - mesh.x) *
                        std::pow(10, testing::uniform(random, -1, 2));
  return trial;
}

struct Figures {
  std::int64_t meshes = 0, steps = 0, unfit = 0;  // unfit: a solver that does not take the mesh
  std::vector<std::string> failures;
};

std::string run(const Variant& variant, std::uint64_t seed, json& report) {
  testing::Random random(seed);
  const testing::Trial trial = trial_of(random);
  try {
    const testing::Attempt attempt = testing::attempt(trial, variant.backend, variant.settings);
    report["steps"] = report["steps"].get<int>() + attempt.steps;
    return attempt.defect;
  } catch (const std::invalid_argument&) {
    report["unfit"] = report["unfit"].get<int>() + 1;
    return "";
  }
}

void attack(const Variant& variant, std::uint64_t first, Figures& figures) {
  const auto outcome = harness::run_in_child(
      [&](harness::Heartbeat& heartbeat) {
        json report = {{"steps", 0}, {"unfit", 0}, {"failures", json::array()}};
        for (int i = 0; i < batch; ++i) {
          heartbeat.restart();
          heartbeat.step = i;
          const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
          if (const std::string found = run(variant, seed, report); !found.empty())
            report["failures"].push_back(variant.name + ", seed " + std::to_string(seed) + ": " +
                                         found);
        }
        return report.dump();
      },
      {.timeout = most_seconds});
  figures.meshes += batch;
  if (outcome.end != harness::ChildOutcome::End::returned) {
    const auto step = static_cast<std::uint64_t>(std::max<std::int64_t>(outcome.step, 0));
    figures.failures.push_back(
        variant.name + ", seed " + std::to_string(first + step) + ": " +
        (outcome.end == harness::ChildOutcome::End::timed_out ? "hangs" : ending(outcome)));
    return;
  }
  const json report = json::parse(outcome.text);
  figures.steps += report.at("steps").get<std::int64_t>();
  figures.unfit += report.at("unfit").get<std::int64_t>();
  for (const json& failure : report.at("failures")) figures.failures.push_back(failure);
}

}  // namespace

int main(int argc, char** argv) {
  double seconds = 10;
  std::uint64_t seed = 1;
  std::string once;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i];
    if (word == "--seconds") seconds = std::atof(argv[i + 1]);
    if (word == "--seed") seed = std::strtoull(argv[i + 1], nullptr, 10);
    if (word == "--once") once = argv[i + 1];  // a variant's name, with the seed of its failure
  }
  const std::vector<Variant> all = variants();
  if (!once.empty()) {
    json report = {{"steps", 0}, {"unfit", 0}};
    for (const Variant& variant : all) {
      if (variant.name == once) std::cout << run(variant, seed, report) << '\n' << report << '\n';
    }
    return 0;
  }
  Figures figures;
  const auto start = Clock::now();
  std::uint64_t next = seed << 32;
  while (std::chrono::duration<double>(Clock::now() - start).count() < seconds) {
    for (const Variant& variant : all) {
      attack(variant, next, figures);
      next += batch;
    }
  }
  json report = {{"meshes", figures.meshes},
                 {"variants", all.size()},
                 {"steps", figures.steps},
                 {"unfit", figures.unfit},
                 {"failed", figures.failures.size()},
                 {"failures", json::array()}};
  for (std::size_t i = 0; i < std::min<std::size_t>(figures.failures.size(), 20); ++i)
    report["failures"].push_back(figures.failures[i]);
  std::cout << report.dump() << std::endl;
  return figures.failures.empty() ? 0 : 1;
}
