// References by computation: two unlike routes for each scene. References are made of runs,
// each by one route, at one step, from one start. A run is kept as soon as it is done, so that a
// computation that was stopped goes on with the next one.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/journal.h"
#include "harness/judge/reference.h"
#include "solvers/methods/backend.h"

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
  RouteRuns(Tell tell, const std::string& out, const nlohmann::json& header);

  // The run of that name: a kept one, or what `compute` returns. The reference stays valid.
  const RouteRun& run(const std::string& name, const std::function<RouteRun()>& compute);
  const std::map<std::string, RouteRun>& known() const { return known_; }  // asked for so far
  void tell(const std::string& line) const { tell_(line); }
  void remove() { journal_->remove(); }  // the reference is written

 private:
  Tell tell_;
  std::optional<Journal> journal_;
  std::map<std::string, RouteRun> known_;
};

// A route that steps.
struct Route {
  std::string solver;
  double limit;  // of strain
  int order;     // of the error that Richardson's rule takes away
  inextensible::Settings settings = {};

  std::string name() const;  // "rattle, strain limit 1e-09"
};

// The routes of a scene that is no pendulum, in steps of h seconds. The second one has the first
// one's limit; they differ in the direction of constraint forces, the velocity's place in the step
// and the linear solver. The third, of scenes with implicit forces, knows no constraints.
struct Routes {
  Route first, second;
  std::optional<Route> third;
};
Routes contact_routes(const Scene& scene, double h);

// At each sample time.
using SampleVisitor = std::function<void(const inextensible::State& state)>;

// A route's run to the last of the sample times, or up to where it fails; h divides the sample
// interval.
void follow(const Scene& scene, const inextensible::State& start, const Route& route, double h,
            const std::vector<double>& times, const RouteRuns& runs, const SampleVisitor& visit);

// Starts off the scene's by at most so many metres a coordinate, at random; pinned vertices stay.
std::vector<inextensible::State> moved_starts(const Scene& scene, double by, int count);

// ---- What is made of runs ----

// Computes the reference of a scene by both routes. finest: the smallest step of step halving, s; 0
// chooses by the scene. The third route is left out of quick ones, steps of quick_finest and more.
// Throws UsageError if a route fails too early.
Reference compute_reference(const std::string& scene, const SceneParameters& complete,
                            double finest, RouteRuns& runs);

// s; what `bench choose` takes.
constexpr double quick_finest = sample_interval / 32;

// How long compute_reference takes, s, estimated from a few steps of each route. 0 for pendulums,
// which take seconds.
double reference_seconds(const std::string& scene, const SceneParameters& complete);

}  // namespace harness
