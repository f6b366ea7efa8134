// What a picture costs: the wall time of a run cut into the frames of a film or a game.
#pragma once

#include <array>
#include <vector>

#include "harness/points/point.h"

namespace harness {

// Frames a second of film, television and games.
inline constexpr std::array frame_rates{24.0, 30.0, 60.0};

class FrameTimes {
 public:
  // step: s, the run's; no figures are given for frames that are shorter.
  explicit FrameTimes(double step);

  // `steps` equal ones that ended at `time` (s, of the scene) took `seconds` of wall time together.
  // A step belongs to the frame in which it ends.
  void add(int steps, double step, double time, double seconds);

  // Times of whole frames; a rate without any is left out.
  std::vector<FrameTime> summary() const;

 private:
  struct Film {
    double rate;                  // frames a second
    std::vector<double> seconds;  // of wall time, of each frame so far
  };
  std::vector<Film> films_;
  double time_ = 0;  // s, that has been simulated
};

}  // namespace harness
