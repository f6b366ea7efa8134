// Simbody's chain. This header hides Simbody's own, which are not C++20.
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
  // Steps by `h`. False if Simbody's steps became too many, or too short. Throws what Simbody does.
  bool step(double h);
  // Attempted since set().
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
