// Runs to look at: the positions of a scene's vertices at the frames of a film, by several solvers.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/points/contestant.h"
#include "harness/scenes/scene.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {

struct FilmSpec {
  std::string scene;
  SceneParameters parameters;  // complete
  Contestants solvers;
  std::vector<double> strain_limits;  // every solver at each
  double step = 0.01;                 // s; shortened to a whole part of a frame
  double frames_per_second = 30;
};

// One run.
struct FilmRun {
  std::string solver, label;
  double strain_limit = 0;
  double step = 0;                              // s
  std::string detail;                           // why it ended early; empty: it did not
  std::string energy_gained;                    // why it fails the energy check; empty: it passes
  std::vector<inextensible::Positions> frames;  // from the start on
  std::vector<double> largest_strain;           // of each frame, as delivered
  double smallest_step = 0;                     // s; a step that is refused is halved
  std::vector<double> seconds;                  // of wall time, each frame but the first took
};

// What there is to see besides vertices.
struct FilmScene {
  Scene scene;
  inextensible::TriangleMesh body;             // empty: no obstacle
  std::vector<inextensible::Pose> body_poses;  // of each frame; empty: it stays
};

struct Recording {
  FilmSpec spec;
  FilmScene stage;
  std::vector<FilmRun> takes;
};

// Number of frames of the whole film: the one at the start, and as many as the scene's duration
// has.
std::size_t frames_in(const FilmSpec& spec);

// Springs get the stiffness that keeps the limit. told: of every frame. Throws Interrupted.
Recording record(const FilmSpec& spec, const std::function<bool()>& interrupted,
                 const std::function<void(const FilmRun&)>& told);

// Where the body's corners are at a frame.
inextensible::Positions body_at(const FilmScene& stage, std::size_t frame);

// ---- for other programs (exports.cpp) ----

// A take as files that other programs read. All write into a folder, which is made, and return the
// paths of what to open. A body beside the cloth has files of its own, <name>-body...: one where it
// stays, else as many as the cloth.

// Wavefront OBJ, one file a frame, <name>-0001.obj and so on: faces of a cloth, lines of a chain.
std::vector<std::string> write_obj(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name);

// VTK XML for ParaView: a .vtp a frame with the strain of every edge as a field, and a .pvd that
// plays them.
std::vector<std::string> write_vtk(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name);

// The first frame as OBJ and a point cache (PC2) for Blender's modifier "Mesh Cache", which reads
// it as an animated object.
std::vector<std::string> write_pc2(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name);

}  // namespace harness
