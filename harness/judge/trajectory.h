// Trajectories that other programs have made of a scene, judged like runs of a solver.
#pragma once

#include "harness/judge/reference.h"
#include "harness/points/point.h"

namespace harness {

struct Trajectory {
  double interval = 0;  // s between frames; the first is the scene's start
  Path frames;
};

// An .npz file (`positions`: frames x vertices x 3, and `times` unless the rate is given), or
// numbered OBJ files in their order. rate: frames a second; 0: not given. Throws
// UsageError, naming file and frame, for frames that are missing, not finite or not of this scene.
Trajectory read_trajectory(const std::vector<std::string>& files, const Scene& scene, double rate);

// A solver that repeats the frames, in steps of the interval.
Backend playback(const char* name, const char* label, std::shared_ptr<const Trajectory> trajectory);

// The worst places of a trajectory, for people: strain, depth in the body, moved pins, in lines.
std::string worst_places(const Trajectory& trajectory, const Scene& scene);

}  // namespace harness
