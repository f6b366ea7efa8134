// References by computation: two unlike routes for each scene. References are made of runs,
// each by one route, at one step, from one start. A run is kept as soon as it is done, so that a
// computation that was stopped goes on with the next one.
#pragma once

#include "harness/base/journal.h"
#include "harness/judge/reference.h"

namespace harness {

using Tell = std::function<void(const std::string&)>;  // a line for people; may throw

struct RouteRun {
  Path path;                // at the sample times, up to where it fails
  double energy_drift = 0;  // over weight times size, where the scene conserves energy
};

class RouteRuns {
 public:
  // In memory.
  explicit RouteRuns(Tell tell) : tell_(std::move(tell)) {}
  // In a journal beside the reference's file `out`. header: what the runs depend on; kept runs of
  // another one are dropped. Throws UsageError if another process computes this reference.
  RouteRuns(Tell tell, const std::string& out, const json& header);

  // The run of that name: a kept one, or what `compute` returns. The reference stays valid.
  const RouteRun& run(const std::string& name, const std::function<RouteRun()>& compute);
  void tell(const std::string& line) const { tell_(line); }
  void remove() { journal_->remove(); }  // the reference is written

 private:
  Tell tell_;
  std::optional<Journal> journal_;
  std::map<std::string, RouteRun> known_;
};

// Computes the reference of a scene by both routes. finest: the smallest step of step halving, s; 0
// chooses by the scene. The third route is left out of quick ones, steps of quick_finest and more.
// Throws UsageError if a route fails too early.
Reference compute_reference(const std::string& scene, const SceneParameters& complete,
                            double finest, RouteRuns& runs);

// s; what `bench choose` takes.
constexpr double quick_finest = sample_interval / 32;

}  // namespace harness
