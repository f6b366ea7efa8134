// Films: positions of a scene at the frames of a film, by several solvers; ray-traced pictures
// (Embree) of them by one camera, with strain as colour and yarns as lines; and files to export.
#pragma once

#include <Eigen/Geometry>

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

struct View {
  Eigen::Vector3d centre, eye;         // m
  Eigen::Vector3d right, up, towards;  // unit vectors; towards: from the centre to the eye
  double size = 1;                     // half of what a picture shows, m
  double aspect = 1;                   // a picture's height over its width
  double tangent = 1;                  // of half the angle that a picture's width covers

  int height(int width) const;  // pixels
  // The direction from the eye through x from -1 (left) to 1 and y from -1 (below) to 1.
  Eigen::Vector3d ray(double x, double y) const;
};

// Sees the body and the cloth of all runs at these frames, or at the last one of a run that has
// ended. Cloth that falls far leaves the picture instead of making it small.
View view_of(const Recording& recording, const std::vector<std::size_t>& frames);

// ---- light and colours (tracer.cpp) ----

// Light is computed in linear colours from 0 to 1; files hold sRGB.
Eigen::Vector3d linear(const Eigen::Vector3d& srgb);
std::array<std::uint8_t, 3> shade(const Eigen::Vector3d& rgb);  // linear to sRGB

// What a picture shows at one time; the recording must outlive it.
struct Shot {
  const Recording& recording;  // a scene without triangles is drawn as a rope
  Positions cloth;             // m
  // Which sides of each triangle are yarns: 1 from corner 0 to 1, 2 from 1 to 2, 4 from 2 to 0.
  std::vector<std::uint8_t> yarns = {};
  Eigen::Matrix3Xd colours = {};  // of each vertex, linear
  Positions body = {};            // m; empty: none
  double yarn = 0;                // half the width of a line, or the radius of a rope, m
  double yarn_shade = 0;          // how much darker a line is: 0 to 1
  double thickness = 0;           // depth inside the body at which cloth is still visible, m
};

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from above, sRGB
};

// Takes samples x samples rays a pixel, in one pattern for all. Safe to call from several threads.
Pixels trace(const Shot& shot, const View& view, int width, int samples);

struct PictureSpec {
  std::vector<std::size_t> frames;  // in rising order
  int width = 480;                  // pixels
  int samples = 2;                  // a pixel has samples x samples
};

Shot shot_of(const Recording& recording, const View& view, std::size_t take, std::size_t frame,
             int width);

// Writes <take>-<frame>.ppm for each frame that a run has (or its last one) into a folder, using
// all cores, and film.json, which plots/film.py reads. Throws FileError, Interrupted.
void write_pictures(const std::string& folder, const Recording& recording, const PictureSpec& spec,
                    const std::function<void(std::size_t done, std::size_t all)>& told);

// Writes a run into an existing folder and returns the paths to open. By the ending:
//   .obj  Wavefront OBJ, one file a frame (<name>-0001.obj ...), faces for cloth, lines for chains;
//         ParaView opens the files as a series
//   .pc2  the first frame as OBJ, and a point cache for Blender's modifier "Mesh Cache"
// A body has files of its own, <name>-body...: one if it does not move, else as many as the cloth.
std::vector<std::string> write_run(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name,
                                   const std::string& ending);

}  // namespace harness
