// Chooses the fastest solver and step that is accurate enough for a scene, within a given time.
#pragma once

#include "harness/run/sweep.h"

namespace harness {

struct Wish {
  double error = headline_error;  // over the scene's size; any_motion: no limit
  double rate = 60;               // frames a second, one of frame_rates
  double budget = 0;              // s of computing time a frame; 0: none is given
};

struct ChooseLimits {
  double seconds = 60;                // for everything
  std::function<double()> elapsed;    // s since the beginning
  std::function<bool()> interrupted;  // asked in runs, too, which then throw Interrupted
};

struct Trials {
  std::vector<PointResult> screened;  // one of each search, in their order; skipped: no time
  std::vector<PointResult> points;    // of ladders, the fastest with more samples
  bool complete = true;               // false: the time was over before all ladders were done
};

// The order of the searches' ladders: contestants that met the strain limit when screened, fastest
// first; then those that missed it; then the rest.
std::vector<std::size_t> ladder_order(const std::vector<PointResult>& screened);

// Screens all contestants, runs their ladders in ladder_order(), and samples the fastest runs
// again. The run in progress is stopped when the time is over. Throws Interrupted.
Trials try_contestants(const Suite& suite, const std::vector<Search>& searches, const Wish& wish,
                       const ChooseLimits& limits, const SweepEvents& events, const Runner& run);

struct Pick {
  const PointResult* point = nullptr;
  FrameTime frame;
  double error = unknown;  // over the scene's size; unknown: nothing says
};

// How many of a run's frames keep the budget: 99 % of them, half of them, or fewer.
enum class Kept { nearly_all, half, fewer };

// The fastest run within limit and error that keeps the budget best. not_by: one to leave out.
std::optional<Pick> fastest(const std::vector<PointResult>& points, const Wish& wish,
                            const std::string& not_by = {});

// A run that keeps the budget in fewer than half of its frames is not recommended.
struct Recommendation {
  std::optional<Pick> best, next;  // next: of another contestant, whatever the budget
  Kept budget = Kept::nearly_all;  // without one: nearly_all
  bool to_be_taken() const { return best && budget != Kept::fewer; }
  bool all_is_well() const { return best && budget == Kept::nearly_all; }
};
Recommendation recommend(const std::vector<PointResult>& points, const Wish& wish);

// Why a contestant has no run within strain limit and error; "": it has one.
std::string why_not(const std::string& contestant, const Trials& trials, const Wish& wish);

}  // namespace harness
