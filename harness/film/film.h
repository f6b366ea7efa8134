// Films: positions of a scene at the frames of a film, by several solvers; pictures of them, which
// POV-Ray traces, by one camera, with strain as colour and yarns as lines; and files to export.
#pragma once

#include "harness/points/contestant.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {

struct FilmSpec {
  std::string scene;
  SceneParameters parameters;  // complete
  Contestants solvers;
  std::vector<double> strain_limits{0.01};  // every solver runs at each of them
  double step = 0.01;                       // s; shortened to a whole part of a frame
  double frames_per_second = 30;
};

struct FilmRun {
  std::string solver, label;
  double strain_limit = 0;
  double step = 0;                     // s
  std::string detail;                  // why it ended early; empty: it did not
  std::string energy_gained;           // why it fails the energy check; empty: it passes
  std::vector<Positions> frames;       // the first is the start
  std::vector<double> largest_strain;  // of each frame, as delivered
  double smallest_step = 0;            // s; a step that is refused is halved
  std::vector<double> seconds;         // wall time of each frame but the first
};

struct Recording {
  FilmSpec spec;
  Scene scene;
  inextensible::TriangleMesh body;  // empty: no obstacle
  std::vector<Pose> body_poses;     // at each frame; empty: it does not move
  std::vector<FilmRun> takes;
};

// Number of frames of the whole film, including the one at the start.
std::size_t frames_in(const FilmSpec& spec);

// Springs get the stiffness that keeps the limit. Calls told after each frame. Throws Interrupted.
Recording record(const FilmSpec& spec, const std::function<void(const FilmRun&)>& told);

Positions body_at(const Recording& recording, std::size_t frame);

struct PictureSpec {
  std::vector<std::size_t> frames;  // in rising order
  int width = 480;                  // pixels
  bool still = false;               // worth more rays a pixel than one of the hundreds of a film
};

// Throws UsageError unless POV-Ray is installed.
void check_povray();

// Writes <take>-<frame>.png for each frame that a run has (or its last one) into a folder, using
// all cores, and film.json, which plots/film.py reads. Throws FileError, Interrupted.
void write_pictures(const std::string& folder, const Recording& recording, const PictureSpec& spec,
                    const std::function<void(std::size_t done, std::size_t all)>& told);

// Writes a run into an existing folder as Wavefront OBJ and returns the paths: <name>-0001.obj and
// so on, a file a frame, with faces for cloth and lines for chains. A body has files of its own,
// <name>-body...: one if it does not move, else as many as the cloth.
std::vector<std::string> write_meshes(const Recording& recording, const FilmRun& take,
                                      const std::string& folder, const std::string& name);

}  // namespace harness
