// Figure 6 of the paper by direct comparison (claim C8): one cloth at one step by fast projection,
// by ICD, and by fast projection from a start that was moved by next to nothing, which tells how
// far apart runs come that should be the same. A drape falls freely until it touches the sphere;
// the patch hangs from two pins, so that constraints act on it from the first step on, and nothing
// else does.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "harness/judge/reference.h"
#include "harness/points/point.h"

namespace harness {

struct SameFrameScene {
  std::string scene;    // "drape" or "patch"
  int side;             // vertices along the cloth
  double strain_limit;  // of both solvers
  double step;          // s
  double moved;  // of the start's vertices in each coordinate, over the scene's size, at most

  std::string name() const;
};
std::vector<SameFrameScene> same_frame_scenes();

// Numbers over the times of frames, by name.
using FrameSeries = std::map<std::string, std::vector<double>>;

// How far frames are apart: "rms" and "largest" distance over the scene's size, and the difference
// of each shape statistic.
struct SameFrame {
  SameFrameScene scene;
  double first_contact = unknown;  // s, the first step's end at which the sphere moved a vertex, in
                                   // the run of fast projection; unknown where there is no sphere
  std::vector<double> times;       // s
  FrameSeries icd;                 // from fast projection to ICD
  FrameSeries moved;               // to fast projection from the moved start
  // Standard deviations of the reference's ensemble at its sample times; else unknown.
  FrameSeries deviation;
  std::string stopped;  // empty: all three ran to the end
};

SameFrame same_frame(const SameFrameScene& scene, std::uint64_t seed, ReferenceFolder& references);

}  // namespace harness
