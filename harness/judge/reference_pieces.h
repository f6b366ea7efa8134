// A reference is made in pieces: each run of a route is kept as soon as it is done, in a journal
// beside the reference's file, so that a computation that was stopped goes on with the next run.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "harness/base/journal.h"
#include "harness/judge/shape.h"
#include "harness/scenes/scene.h"

namespace harness {

// Run of one route at one step from one start.
struct RouteRun {
  std::vector<inextensible::Positions> path;  // at the sample times, up to where it fails
  double energy_drift = 0;  // over weight times size, where the scene conserves energy
  ShapeSeries shape;        // of an ensemble's runs, which have no path
};

// Gives the run of a name: a kept one, or what `compute` returns.
using KeepRun = std::function<const RouteRun&(const std::string& name,
                                              const std::function<RouteRun()>& compute)>;

// Runs that are kept in a journal beside the reference's file.
class ReferencePieces {
 public:
  // out: the reference's file. header: what the runs depend on; kept runs of another one are
  // dropped. Throws UsageError if another process computes this reference.
  ReferencePieces(const std::string& out, const nlohmann::json& header);

  const RouteRun& run(const std::string& name, const std::function<RouteRun()>& compute);
  // What has become of an earlier process's runs, a line each for people.
  const std::vector<std::string>& news() const { return news_; }
  void remove() { journal_.remove(); }  // the reference is written

 private:
  Journal journal_;
  std::map<std::string, RouteRun> known_;  // references to its entries stay valid
  std::vector<std::string> news_;
};

}  // namespace harness
