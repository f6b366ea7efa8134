// What the stability sweep measures beside the matrix of hard cases.
#include <Eigen/SPQRSupport>

#include "harness/base/text.h"
#include "harness/stability/cases.h"
#include "harness/stability/stability.h"
#include "solvers/problem/forces.h"

namespace harness {

// Down the powers of two to the first step that is survived, then logarithmic bisection.
LargestStep largest_step(const StabilityScene& scene, const std::string& solver, std::uint64_t seed,
                         const std::function<bool()>& interrupted) {
  constexpr double largest = 0.25;  // s
  constexpr int bisections = 3;  // between the first step that survives and the one above: to 9 %
  const auto whole = [](double step) { return 1 / std::round(1 / step); };  // so is a second
  LargestStep found{scene.name, solver, unknown, unknown, ""};
  const auto survives = [&](double step) {
    const TrialResult result = run_isolated_trial(
        [&] {
          Trial trial = cases::trial_of(
              built_scene(scene.type, {{"n", static_cast<double>(scene.n)}}), whole(step));
          trial.timeout = trial.timeout_smaller = 2;
          return trial;
        },
        solver, seed, interrupted);
    if (result.fixed != Outcome::survived)
      found.detail = to_string(result.fixed) + (": " + result.detail);
    return result.fixed == Outcome::survived;
  };
  double high = unknown, low = largest;
  const double smallest = scene.smallest * (1 - 1e-9);
  while (low >= smallest && !survives(low)) {
    high = low;
    low /= 2;
  }
  if (low < smallest) {
    found.failing_step = high;
    return found;
  }
  for (int i = 0; i < bisections && std::isfinite(high); ++i) {
    const double middle = std::sqrt(low * high);
    (survives(middle) ? low : high) = middle;
  }
  found.step = whole(low);
  if (std::isfinite(high)) found.failing_step = whole(high);
  return found;
}

// Rank of the Jacobian of | d |^2 / l over all coordinates.
static int rank_of_jacobian(const Draft& mesh, int constraints, int coordinates) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < constraints; ++k) {
    const auto [a, b] = mesh.parts.edges[k];
    const Eigen::Vector3d u =
        2 * (mesh.scene.start.x.col(b) - mesh.scene.start.x.col(a)) / mesh.parts.rest_length[k];
    for (int axis = 0; axis < 3; ++axis) {
      entries.emplace_back(k, 3 * a + axis, -u[axis]);
      entries.emplace_back(k, 3 * b + axis, u[axis]);
    }
  }
  Eigen::SparseMatrix<double> jacobian(constraints, coordinates);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  return static_cast<int>(Eigen::SPQR<Eigen::SparseMatrix<double>>(jacobian).rank());
}

std::vector<Freedom> degrees_of_freedom(int n) {
  std::vector<Freedom> list;
  for (auto [name, mesh] : {std::pair("quads", cases::cloth(n)),
                            {"triangles", cases::cloth(n, true)},
                            {"midpoints", cases::midpoint_cloth(n)}}) {
    std::mt19937_64 random(1);
    cases::add_noise(mesh.scene.start.x, {}, 0.2 / (n - 1), random);
    const auto edges = static_cast<int>(mesh.parts.edges.size()),
               coordinates = static_cast<int>(3 * mesh.parts.mass.size());
    const int rank = rank_of_jacobian(mesh, edges, coordinates);
    list.push_back({name, n * n, edges, rank, coordinates - rank});
  }
  return list;
}

std::string SameFrameScene::name() const {
  return concat(scene, " ", side, " x ", side, ", strain limit ", strain_limit);
}

// Compares every step until shortly after the early first contact, then at sample_interval.
SameFrame same_frame(const SameFrameScene& wanted, std::uint64_t seed) {
  constexpr double densely_until = 0.05;  // s
  const Scene scene = built_scene(wanted.scene, {{"n", wanted.side}});
  SameFrame found{.scene = wanted};
  struct Run {
    const char* solver;
    std::unique_ptr<Stepper> stepper;
    State state;
  };
  std::vector<Run> runs;
  for (const char* solver : {"fast_projection", "icd"})
    runs.push_back({solver, make_stepper(solver, scene.problem, {wanted.strain_limit, seed, {}}),
                    scene.start});
  const long steps = std::lround(scene.duration / SameFrameScene::step);
  for (long i = 1; i <= steps; ++i) {
    for (Run& run : runs) {
      const auto result = run.stepper->advance(run.state, wanted.step);
      if (result) continue;
      found.stopped =
          concat(run.solver, " at step ", i, ": ", to_string(result.status), ", ", result.detail);
      return found;
    }
    const double time = static_cast<double>(i) * wanted.step;
    if (std::isnan(found.first_contact) && runs[0].stepper->work().contacts > 0)
      found.first_contact = time;
    if (time > densely_until && std::abs(std::remainder(time, sample_interval)) > 1e-9) continue;
    found.times.push_back(time);
    found.icd.rms.push_back(rms_distance(scene, runs[0].state.x, runs[1].state.x));
    found.icd.largest.push_back(max_distance(scene, runs[0].state.x, runs[1].state.x));
  }
  return found;
}

}  // namespace harness
