// Runs of the routes that a reference is made of, and the distances between them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/judge/reference.h"
#include "harness/judge/reference_pieces.h"

namespace harness {

// A route that steps.
struct Route {
  std::string solver;
  double limit;  // of strain
  int order;     // of the error that Richardson's rule takes away
  inextensible::Settings settings = {};
};

using Tell = std::function<void(const std::string&)>;
using Path = std::vector<inextensible::Positions>;  // at the sample times

// After each step; sampled: whether it ends at a sample time.
using SampleVisitor = std::function<void(const inextensible::State& state, bool sampled)>;

// A route's run to the last of the sample times, or up to where it fails; h divides the sample
// interval.
void follow(const Scene& scene, const inextensible::State& start, const Route& route, double h,
            const std::vector<double>& times, const Tell& tell, const SampleVisitor& visit);

// Starts off the scene's by at most so many metres a coordinate, at random; pinned vertices stay.
std::vector<inextensible::State> moved_starts(const Scene& scene, double by, int count);

// What every part of the computation of a reference needs.
struct Task {
  Reference& r;
  const Scene& scene;
  double finest;  // s
  const Tell& tell;
  const KeepRun& keep;
};

// A route's path at the sample times, up to where it fails; h divides the sample interval. start:
// the number of a moved start; 0 is the scene's own. samples: how many of the reference's are
// wanted.
const Path& kept_path(const Task& task, const inextensible::State& from, int start,
                      const Route& route, double h, std::size_t samples);
// From the scene's start, at all sample times.
const Path& path_of(const Task& task, const Route& route, double h);
// Throws UsageError if it fails before the end.
const Path& path_to_the_end(const Task& task, const Route& route, double h);

// p (finer) beyond itself by Richardson's rule, where the error is of this order.
Path extrapolated(const Path& coarse, const Path& fine, int order);

// Root mean square over the first `count` samples, over the scene's size.
double mean_distance(const Scene& scene, const Path& a, const Path& b, std::size_t count);

// Two paths that would be one if a reference were without error.
struct GapPart {
  const char* name;
  const Path *one, *other;
};
// Fills in the reference's gaps, at each sample that all paths reach, and valid_until.
void add_gaps(Reference& r, const Scene& scene, const std::vector<GapPart>& parts);

}  // namespace harness
