// The chain as Simbody has it. Simbody's headers are not C++20, so that they stay behind this one.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "contestants/common/links.h"

namespace engines {

std::string simbody_version();

// Links on pins, in the plane of x and y, or on line orientations. The first hangs on the origin.
class MobilizerChain {
 public:
  // gravity in m/s^2; one of `integrators`.
  MobilizerChain(const Links& links, const Eigen::Vector3d& gravity, bool pins,
                 std::string_view integrator, double accuracy);
  ~MobilizerChain();

  static constexpr const char* integrators[] = {"merson", "fehlberg", "verlet"};

  void set(const LinkPoses& poses);
  // To `h` later. False if Simbody's steps became too many, or too short. Whatever Simbody throws.
  bool step(double h);
  // Tried since set().
  int internal_steps() const;

  struct Point {
    Eigen::Vector3d place, velocity;
  };
  Point end_of(int link) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace engines
