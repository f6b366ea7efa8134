// Scenes: what is simulated. A scene has parameters with defaults and builds a problem and its
// initial state; it knows nothing of solvers.
#pragma once

#include <map>
#include <span>
#include <utility>

#include "harness/base/text.h"
#include "solvers/problem/problem.h"

namespace harness {

using inextensible::BodyMotion, inextensible::Edge, inextensible::Pose, inextensible::Positions,
    inextensible::Problem, inextensible::ProblemParts, inextensible::State;

using SceneParameters = std::map<std::string, double>;

struct SceneParameterInfo {
  const char* name;
  double initial;
  const char* meaning;  // with its unit
  double low, high;     // permitted range, low exclusive unless `integer`
  bool integer = false;
};

struct Scene {
  std::shared_ptr<const Problem> problem;
  State start;
  double duration = 1;            // s
  double size = 1;                // m, what errors are divided by
  bool conserves_energy = false;  // nothing dissipates: energy drift is an error
  // How far total energy may rise above the start's, over weight times size and the kinetic energy
  // at the start: enough to lift the whole by 5 % of its size. Runs that blow up gain ten times as
  // much, or soon will; what methods gain by truncation alone, at the coarsest steps of the
  // ladders, stays below.
  double energy_bound = 0.05;  // infinite where a body that moves does work
  // Whether methods whose velocities are of the middle of a step start half a step back.
  bool staggered = true;
  // Vertices whose sag a result states.
  struct Mark {
    std::string name;
    int vertex;
    double height;  // m, at which it would hang if nothing stretched
  };
  std::vector<Mark> marks;
  std::vector<std::array<int, 3>> triangles;  // that cover it, all with the same side outwards
};

struct SceneType {
  std::string name;
  const char* summary;
  std::vector<SceneParameterInfo> parameters;
  std::function<Scene(const SceneParameters& complete)> build;
  // Vertices and constraints, without building anything.
  std::function<std::pair<int, int>(const SceneParameters& complete)> counts;
  // Positions at a time (s) where the motion is known exactly: errors need no reference then.
  Positions (*exact)(const SceneParameters& complete, double time) = nullptr;
  std::string like = {};  // the scene whose tuned settings it takes; empty: its own
  // Straight from a pinned end, with nothing in its way: the links of a pendulum in a plane, whose
  // smooth motion scenes/pendulum.h integrates in angles.
  bool pendulum = false;
  const char* resolution = "n";  // the parameter that a resolution sweep turns
  // A hash of the files that the scene is made of. Empty: the name says all.
  std::string identity = {};
  std::string description =
      {};                      // of a mesh, in lines: what was read and becomes of it, and a sketch
  std::string remarks = {};    // those of the lines that a run says too
  std::string reference = {};  // the .npz file of its reference; empty: it is looked for by name

  std::string kind() const { return like.empty() ? name : like; }
};

std::span<const SceneType> scene_types();
// Also "mesh:..." and "folder:..." (scene_folder.h), which throw UsageError for files that they
// cannot use; the files are read once. Null: no such scene.
std::shared_ptr<const SceneType> find_scene(std::string_view name);
std::vector<std::string> scene_kinds();  // of all scenes, each once

// The scene's parameters with `given` put in. Throws UsageError, naming the parameter, for unknown
// or impossible ones.
SceneParameters complete_parameters(const SceneType& type, const SceneParameters& given);
// The scene of an existing name, with some of its parameters given.
Scene built_scene(std::string_view name, const SceneParameters& given = {});

// ---- Cloth from a mesh of one's own: "mesh:shirt.obj,pins=y>1.2,body=body.obj" ----
//
// Warp and weft are the sides of quads. Two triangles that make a good quad are taken as one;
// springs alone hold the remaining triangles, as a net of inextensible triangles would not bend. A
// body is a closed mesh, the floor a height. Lines are ropes. With triangles=midpoints each
// triangle keeps its shape, and bends against its neighbours (cloth_mesh.h). Pins and loads are
// conditions joined by "and" and "or": "y > 1.2", "x <= 0", "v12" (a vertex of the file) and
// "near(0:1:0)" (the nearest one).

bool names_mesh(std::string_view scene);  // "mesh:..."

// The scene's name with those parts that are not empty, in the file's unit, and with the hash of
// all that it is made of: pins, load (where a weight hangs), body (files, between semicolons),
// body_then (where it is later, the same), thickness (of an open body), floor (a height), rest (a
// file with the unstretched shape), weld (corners this close are one), triangles. Throws UsageError
// for other parts, and for any where the scene is not a mesh.
std::string with_mesh_parts(const std::string& scene,
                            const std::vector<std::pair<std::string, std::string>>& parts);

// Thrown for a mesh that can be read, but not simulated as it is.
struct UnusableMesh : UsageError {
  UnusableMesh(const std::string& message, std::string what_was_read, bool only_falls = false)
      : UsageError(message), description(std::move(what_was_read)), falls(only_falls) {}
  std::string description;  // as SceneType's
  bool falls;               // it is cloth, which nothing holds
};

// Reads the files. Throws UsageError, naming file and place, for what can be no cloth.
SceneType mesh_scene(const std::string& name);

}  // namespace harness
