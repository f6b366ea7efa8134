// The planar N-link pendulum in angles: the chain's motion by a route that shares nothing with the
// solvers.
//
// Link i leads from point i to point i + 1 in the direction e_i = (cos theta_i, sin theta_i); point
// 0 is fixed. With the link tensions T,
//   m_i r_i'' = m_i g + T_i e_i - T_{i-1} e_{i-1},
// and (r_{i+1} - r_i)'' . e_i = -l_i theta_i'^2 gives the tensions as the solution of a symmetric
// positive definite tridiagonal system (GSL), so that accelerations cost O(N).
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

class Pendulum {
 public:
  struct Links {
    std::vector<double> mass;    // kg, of points 1 ... N
    std::vector<double> length;  // m, of links 0 ... N - 1
    double gravity = 9.81;       // m/s^2, along -y
  };
  // angles: theta of each link from the x axis, counterclockwise, rad; at rest at time 0. One mass,
  // length and angle for each of one link or more; masses and lengths are positive.
  Pendulum(Links links, std::vector<double> angles);

  // Integrates to `time` (s, not before the last call's) by GSL's Runge-Kutta-Prince-Dormand pair
  // of orders 8 and 9, with this tolerance on every angle (rad) and rate (rad/s). Throws
  // std::runtime_error if the integrator gives up.
  void advance(double time, double tolerance);

  double energy() const;  // J, potential 0 at the fixed point's height
  // Points 0 ... N (3 x (N + 1), m), point 0 at the origin.
  Positions positions() const;

  // Rates (theta', theta'') of a state (theta, theta'), 2 N numbers each. False if the tensions
  // cannot be found.
  bool rates(const double* state, double* rate);

 private:
  Links links_;
  std::vector<double> state_;  // theta, then theta'
  double time_ = 0;
  std::vector<double> scratch_;  // of rates(), six numbers a link
  double step_ = 1e-6;           // s, the integrator's next one
};

}  // namespace harness
