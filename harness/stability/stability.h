// `bench --sweep stability`: the matrix of hard cases and solvers, the largest stable steps, the
// degrees of freedom that constraints leave, and the same frames from fast projection and ICD.
#pragma once

#include "harness/base/journal.h"
#include "harness/judge/reference.h"
#include "harness/stability/hard_case.h"

namespace harness {

struct StabilityCell {
  const HardCase* hard_case;
  std::string solver;
  TrialResult result;
  Expectation expectation;
  bool expected = true;                    // the outcome is the expected one, or admitted beside it
  const KnownDifference* known = nullptr;  // of an outcome that is not expected
};

// Whether theory admits the outcome. It knows nothing of solvers from outside: where others
// survive, these may also refuse or be slow, but never be wrong.
bool acceptable(const Expectation& expectation, const std::string& solver,
                const TrialResult& result);

struct ExpectationCounts {
  int cells = 0, strict = 0, two_admitted = 0, not_as_expected = 0, new_differences = 0;
};

// A scene for which the largest stable step is sought over one simulated second.
struct StabilityScene {
  const char *name, *type;
  int n;
  double smallest;  // s; the largest step is 1/4 s
};

struct LargestStep {
  std::string scene, solver;
  double step = unknown;          // s, the largest at which one second was survived
  double failing_step = unknown;  // s, the next larger one that was tried and failed
  std::string detail;             // why that one failed
};
LargestStep largest_step(const StabilityScene& scene, const std::string& solver, std::uint64_t seed,
                         const std::function<bool()>& interrupted);

// Degrees of freedom that constraints leave to a cloth (claim C14): 3 per free vertex less the rank
// of J (SuiteSparseQR), at random displacements, hence in general position.
struct Freedom {
  // All edges of "quads" or "triangles", or edges between "midpoints" of triangles' sides.
  std::string mesh;
  int vertices;  // of quads and triangles
  int constraints, rank, degrees_of_freedom;
};
std::vector<Freedom> degrees_of_freedom(int n);

// Figure 6 of the paper by direct comparison (claim C8): one cloth at one step by fast projection
// and by ICD. A drape falls freely until it touches the sphere; the patch hangs from two pins, so
// that only constraints act on it, from the first step on.
struct SameFrameScene {
  std::string scene;    // "drape" or "patch"
  int side;             // vertices along the cloth
  double strain_limit;  // of both solvers

  static constexpr double step = 1.0 / 200;  // s
  std::string name() const;
};

// How far apart frames are, over the scene's size, at their times.
struct FrameDistances {
  std::vector<double> rms, largest;  // root mean square over vertices by mass; any vertex
};

struct SameFrame {
  SameFrameScene scene;
  double first_contact = unknown;  // s, the first step's end at which the sphere moved a vertex, in
                                   // the run of fast projection; unknown where there is no sphere
  std::vector<double> times = {};  // s
  FrameDistances icd = {};         // from fast projection to ICD
  std::string stopped = {};        // empty: both ran to the end
};
SameFrame same_frame(const SameFrameScene& scene, std::uint64_t seed);

struct StabilityPlan {
  std::vector<std::string> solvers;
  std::vector<HardCase> cases;
  std::vector<StabilityScene> scenes = {};  // for the largest steps
  std::vector<SameFrameScene> frames = {};
  bool freedom = false;

  std::size_t cells() const { return cases.size() * solvers.size(); }
};
// All of hard_cases(profile) and beside them. solver: must match the solver's whole name;
// hard_case: must be found in a row's or a case's name. Throws UsageError if nothing matches.
StabilityPlan plan_stability(const std::string& profile, const std::optional<Pattern>& solver,
                             const std::optional<Pattern>& hard_case);

struct StabilityOutcome {
  std::vector<StabilityCell> cells;
  std::vector<LargestStep> largest_steps;
  std::vector<Freedom> freedom;
  std::vector<SameFrame> same_frames;
  bool complete = true;  // false: interrupted

  ExpectationCounts counts() const;
};

inline std::string cell_key(const std::string& hard_case, const std::string& solver) {
  return hard_case + "/" + solver;
}

// Results are kept under their cells' keys; `events.done` also reports everything else, without
// counts. The plan must outlive the outcome.
StabilityOutcome run_stability(const StabilityPlan& plan, std::uint64_t seed,
                               const RunEvents& events);

json stability_document(json context, const StabilityOutcome& outcome, std::uint64_t seed,
                        const std::vector<std::string>& command);

}  // namespace harness
