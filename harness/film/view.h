// Where the camera stands: it is the same for all panels of a film or a sheet.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "harness/film/recording.h"

namespace harness {

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
  // Where a point is seen, in the same measures.
  Eigen::Vector2d seen(const Eigen::Vector3d& point) const;
};

// Sees body and cloth of all takes at the frames that are shown, as long as the cloth stays near
// the body, or near where it started: what falls off leaves the picture, and does not make it
// small. A take that has ended is shown as it was last.
View view_of(const Recording& recording, const std::vector<std::size_t>& frames);

}  // namespace harness
