// The pictures of a recording: every take at some frames, by the same camera, with light and shadow
// (ray tracing by Embree), strain as colour, and yarns as lines on the cloth.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/film/recording.h"

namespace harness {

// ---- the camera ----

struct View {
  Eigen::Vector3d centre, eye;         // m
  Eigen::Vector3d right, up, towards;  // unit vectors; towards: from the centre to the eye
  double size = 1;                     // half of what a picture shows, m
  double aspect = 1;                   // a picture's height over its width
  double tangent = 1;                  // of half the angle that a picture's width covers

  int height(int width) const;  // pixels
  // The direction from the eye through a point of the picture: x from -1 (left) to 1, y from -1
  // (below) to 1.
  Eigen::Vector3d ray(double x, double y) const;
};

// Sees body and cloth of all takes at the frames that are shown, as long as the cloth stays near
// the body, or near where it started: what falls off leaves the picture, and does not make it
// small. A take that has ended is shown as it was last.
View view_of(const Recording& recording, const std::vector<std::size_t>& frames);

// ---- light and colours (tracer.cpp) ----

// Light is computed in linear colours from 0 to 1, files hold sRGB.
Eigen::Vector3d linear(const Eigen::Vector3d& srgb);
std::array<std::uint8_t, 3> shade(const Eigen::Vector3d& rgb);  // in sRGB, of a linear colour

// What a picture shows at one time; the stage must outlive it.
struct Shot {
  const FilmScene& stage;         // without triangles its edges are drawn, as a rope
  inextensible::Positions cloth;  // m
  // Which sides of each triangle are yarns: 1 from corner 0 to 1, 2 from 1 to 2, 4 from 2 to 0.
  std::vector<std::uint8_t> yarns = {};
  Eigen::Matrix3Xd colours = {};      // of each vertex, linear
  inextensible::Positions body = {};  // m; empty: none
  double yarn = 0;                    // half the width of a line, or the radius of a rope, m
  double yarn_shade = 0;              // how much darker a line is: 0 to 1
  double thickness = 0;  // so far the cloth may lie inside the body, and is seen nevertheless, m
};

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from above, sRGB
};

// Samples a pixel: samples x samples. Every pixel takes the same pattern of rays, so that flat
// cloth has one shade. Usable from several threads.
Pixels trace(const Shot& shot, const View& view, int width, int samples);

// ---- pictures ----

struct PictureSpec {
  std::vector<std::size_t> frames;  // in rising order
  int width = 480;                  // pixels
  int samples = 2;                  // a pixel has samples x samples
};

// What a take shows at a frame.
Shot shot_of(const Recording& recording, const View& view, std::size_t take, std::size_t frame,
             int width);

// Into a folder that is there: <take>-<frame>.ppm for each frame that the take has, and its last
// one if it ended early; film.json with the width, the height, the frames, what is said of each
// take, and the colours of strain over its limit from 0 to legend_end. On all cores. told: how many
// of all are done. Throws FileError, Interrupted.
void write_pictures(const std::string& folder, const Recording& recording, const PictureSpec& spec,
                    const std::function<bool()>& interrupted,
                    const std::function<void(std::size_t done, std::size_t all)>& told);

}  // namespace harness
