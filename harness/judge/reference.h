// References: trajectories that errors are measured against. A reference comes from two unlike
// routes and carries their distance as its own uncertainty; it is computed by `bench reference`,
// stored as JSON (schema inextensible-reference/2) and is never a contestant.
#pragma once

#include "harness/base/npz.h"
#include "harness/points/measures.h"
#include "harness/scenes/scene.h"

namespace harness {

using Path = std::vector<Positions>;  // at sample times, m

struct Reference {
  std::string scene;
  SceneParameters parameters;  // complete
  std::string method, second_method;
  std::vector<double> times;  // s, ascending
  Path positions;             // at times up to valid_until
  // How far the path may be off: the largest of the distance between the routes, of each route from
  // its own run at half as many steps, and of the first one from itself with starts moved a little.
  std::vector<double> gap;
  std::vector<double> gap_max;  // the same in the maximum norm
  // The parts whose largest is the gap; empty in references made without them.
  std::map<std::string, std::vector<double>> gap_parts;
  double valid_until = 0;   // s: the last sample before the gap exceeds 1 % of the scene's size
  double energy_drift = 0;  // of the first route, where the scene conserves energy
  // The order of the stepping route under step halving. It explains a reference and decides
  // nothing: kinks of contact lower an order and leave paths close.
  double observed_order = unknown;
  bool exact = false;  // no route: the scene's motion is known

  double duration() const { return times.empty() ? 0 : times.back(); }
  // How many sample times count at a level of error: those at which 3 gap is at most the level.
  int samples_at(double level) const;
  double known_until(double level) const;  // s: the last of these; 0: none
  std::string name() const;                // that of its file; "exact"
};

// Mass-weighted RMS distance of two sets of positions over the scene's size.
double rms_distance(const Scene& scene, const Positions& x, const Positions& y);
// The largest distance of any vertex, over the scene's size.
double max_distance(const Scene& scene, const Positions& x, const Positions& y);

constexpr double sample_interval = 0.04;  // s; every step of the usual ladders meets it
std::vector<double> sample_times(double duration);

// The file of a scene's reference: chain-n80.json, or with a hash of the parameters that are not
// the defaults (but duration), or mesh-9f3c...-n1.json of a scene made of files.
std::string reference_name(const std::string& scene, const SceneParameters& complete);

json to_json(const Reference& reference);
// Throws UsageError, naming the file, for anything that is not a reference.
// scene: whose it is, by the name under which its files are found here; "": the document's own.
Reference read_reference(const std::string& path, const std::string& scene = "");
// The same from a parsed document; `path` is for messages.
Reference reference_of(const json& document, const std::string& path,
                       const std::string& scene = "");

// A path as rows of coordinates, rounded to this many parts of a metre; 0: not rounded.
json rows_of(const Path& path, double per_metre = 0);
Path path_of(const json& rows);
// The same as an array of frames x vertices x 3. Throws UsageError for another shape.
NumberArray array_of(const Path& path);
Path path_of(const NumberArray& array, const std::string& file);

// The same as arrays for NumPy, and back: positions (samples x vertices x 3), times, gap, gap_max.
NumberArrays arrays_of(const Reference& reference);

// Where a scene's reference is written: results/references, or beside the user's own results where
// it is made of files or the program is installed.
std::string reference_path(const std::string& scene, const SceneParameters& complete);

// The references of folders, read when they are asked for, and exact ones.
class ReferenceFolder {
 public:
  explicit ReferenceFolder(std::vector<std::string> folders) : folders_(std::move(folders)) {}
  static std::shared_ptr<ReferenceFolder> usual();  // the user's, and those of the program
  // Null if there is none. Not thread safe.
  std::shared_ptr<const Reference> find(const std::string& scene, const SceneParameters& complete);
  // Adds a reference that has no file.
  void put(std::shared_ptr<const Reference> reference);
  // What a result file says of each reference that its errors were measured against.
  json summaries() const;

 private:
  std::vector<std::string> folders_;
  std::map<std::string, std::shared_ptr<const Reference>> known_;
};

}  // namespace harness
