// References: trajectories that errors are measured against. A reference comes from two unlike
// routes and carries their distance as its own uncertainty; it is computed by `bench reference`,
// stored as JSON (schema inextensible-reference/1) and is never a contestant.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/scenes/scene.h"

namespace harness {

// What can still be compared where paths are chaotic.
struct ShapeStatistics {
  double potential_energy = 0;  // over weight times size
  double corner_height = 0;     // mean over the cloth's corners, over size
  double shadow = 0;            // area of the shadow on a horizontal plane, over size^2
};
ShapeStatistics shape_statistics(const Scene& scene, const inextensible::Positions& x);

struct Reference {
  std::string scene;
  SceneParameters parameters;  // complete
  std::string method, second_method;
  std::vector<double> times;                       // s, ascending
  std::vector<inextensible::Positions> positions;  // at times up to valid_until, m
  std::vector<double> gap;      // of both routes, or of two runs of one: the larger
  std::vector<double> gap_max;  // the same in the maximum norm
  std::vector<ShapeStatistics> shape, shape_gap;  // at all times; gap: |difference| of both routes
  double valid_until = 0;     // s: the last sample before the gap exceeds 1 % of the scene's size
  double energy_drift = 0;    // of the first route, where the scene conserves energy
  double observed_order = 0;  // of the route that steps, under step halving
  double expected_order = 1;
  bool exact = false;  // no route: the scene's motion is known

  double duration() const { return times.empty() ? 0 : times.back(); }
  // Below half the order that theory expects, what is finer is not known to be nearer, and nothing
  // is an error against it.
  bool converged() const { return exact || observed_order >= 0.5 * expected_order; }
  std::string name() const;  // that of its file; "exact"
};

// Mass-weighted RMS distance of two sets of positions over the scene's size.
double rms_distance(const Scene& scene, const inextensible::Positions& x,
                    const inextensible::Positions& y);
// The largest distance of any vertex, over the scene's size.
double max_distance(const Scene& scene, const inextensible::Positions& x,
                    const inextensible::Positions& y);

// The file a reference of this scene is kept in: chain-n80.json, or with a hash of the parameters
// that are not the defaults. Duration does not count.
std::string reference_name(const std::string& scene, const SceneParameters& complete);

nlohmann::json to_json(const Reference& reference);
// What a result file says of a reference that its errors were measured against.
nlohmann::json summary_of(const Reference& reference);
// Throws UsageError, naming the file, for anything that is not a reference.
Reference read_reference(const std::string& path);

// The motion of a scene that is known exactly, at the sample times. Null for other scenes.
std::shared_ptr<const Reference> exact_reference(const std::string& scene,
                                                 const SceneParameters& complete);

// Computes the reference of a scene by both routes. finest: the smallest step of step halving, s; 0
// chooses by the scene. tell is called with a line now and then. Throws UsageError if a
// route fails too early.
Reference compute_reference(const std::string& scene, const SceneParameters& complete,
                            double finest, const std::function<void(const std::string&)>& tell);

// The references of a folder, read when they are asked for, and exact ones.
class ReferenceShelf {
 public:
  explicit ReferenceShelf(std::string folder) : folder_(std::move(folder)) {}
  // Null if there is none. Not thread safe.
  std::shared_ptr<const Reference> find(const std::string& scene, const SceneParameters& complete);
  // All that find() has found so far.
  nlohmann::json summaries() const;

 private:
  std::string folder_;
  std::map<std::string, std::shared_ptr<const Reference>> known_;
};

}  // namespace harness
