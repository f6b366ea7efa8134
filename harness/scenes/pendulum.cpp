#include "harness/scenes/pendulum.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_odeiv2.h>

#include <cmath>

namespace harness {

Pendulum::Pendulum(Links links, std::vector<double> angles)
    : links_(std::move(links)), state_(std::move(angles)) {
  state_.resize(2 * state_.size(), 0.0);
  scratch_.resize(3 * state_.size());
}

bool Pendulum::rates(const double* state, double* rate) {
  const std::size_t n = links_.mass.size();
  const double* theta = state;
  const double* omega = state + n;
  double *cosine = scratch_.data(), *sine = cosine + n, *diagonal = sine + n, *off = diagonal + n,
         *right = off + n, *tension = right + n;
  for (std::size_t i = 0; i < n; ++i) {
    cosine[i] = std::cos(theta[i]);
    sine[i] = std::sin(theta[i]);
  }
  const auto inverse_mass = [&](std::size_t point) {  // point 0 is fixed
    return point == 0 ? 0.0 : 1 / links_.mass[point - 1];
  };
  // (r_{i+1} - r_i)'' = -T_i (w_{i+1} + w_i) e_i + T_{i+1} w_{i+1} e_{i+1} + T_{i-1} w_i e_{i-1},
  // and gravity on link 0, whose other end does not fall.
  for (std::size_t i = 0; i < n; ++i) {
    diagonal[i] = inverse_mass(i) + inverse_mass(i + 1);
    if (i + 1 < n)
      off[i] = -inverse_mass(i + 1) * (cosine[i] * cosine[i + 1] + sine[i] * sine[i + 1]);
    right[i] = links_.length[i] * omega[i] * omega[i];
  }
  right[0] += -links_.gravity * sine[0];
  if (n == 1) {
    tension[0] = right[0] / diagonal[0];
  } else {
    const auto d = gsl_vector_const_view_array(diagonal, n);
    const auto e = gsl_vector_const_view_array(off, n - 1);
    const auto b = gsl_vector_const_view_array(right, n);
    auto t = gsl_vector_view_array(tension, n);
    if (gsl_linalg_solve_symm_tridiag(&d.vector, &e.vector, &b.vector, &t.vector) != GSL_SUCCESS)
      return false;
  }
  for (std::size_t i = 0; i < n; ++i) {
    // theta_i'' l_i = n_i . (r_{i+1} - r_i)'' with n_i = (-sin theta_i, cos theta_i).
    double turning = i == 0 ? -links_.gravity * cosine[0] : 0.0;
    if (i + 1 < n)
      turning += tension[i + 1] * inverse_mass(i + 1) *
                 (cosine[i] * sine[i + 1] - sine[i] * cosine[i + 1]);
    if (i > 0)
      turning +=
          tension[i - 1] * inverse_mass(i) * (cosine[i] * sine[i - 1] - sine[i] * cosine[i - 1]);
    rate[i] = omega[i];
    rate[n + i] = turning / links_.length[i];
  }
  return true;
}

void Pendulum::advance(double time, double tolerance) {
  if (time <= time_) return;
  gsl_set_error_handler_off();
  gsl_odeiv2_system system{[](double /*t*/, const double* y, double* dydt, void* self) -> int {
                             return static_cast<Pendulum*>(self)->rates(y, dydt) ? GSL_SUCCESS
                                                                                 : GSL_EBADFUNC;
                           },
                           nullptr, state_.size(), this};
  const std::unique_ptr<gsl_odeiv2_driver, decltype(&gsl_odeiv2_driver_free)> driver(
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, step_, tolerance, 0.0),
      gsl_odeiv2_driver_free);
  const int status = gsl_odeiv2_driver_apply(driver.get(), &time_, time, state_.data());
  if (status != GSL_SUCCESS)
    throw std::runtime_error("pendulum: GSL's integrator stopped at t = " + std::to_string(time_) +
                             " s: " + gsl_strerror(status));
  step_ = driver->h;
}

Positions Pendulum::positions() const {
  const auto n = static_cast<Eigen::Index>(links_.mass.size());
  Positions x(3, n + 1);
  x.col(0).setZero();
  for (Eigen::Index i = 0; i < n; ++i)
    x.col(i + 1) =
        x.col(i) + links_.length[i] * Eigen::Vector3d(std::cos(state_[i]), std::sin(state_[i]), 0);
  return x;
}

double Pendulum::energy() const {
  const std::size_t n = links_.mass.size();
  double energy = 0, y = 0, vx = 0, vy = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double theta = state_[i], omega = state_[n + i], l = links_.length[i];
    y += l * std::sin(theta);
    vx -= l * omega * std::sin(theta);
    vy += l * omega * std::cos(theta);
    energy += links_.mass[i] * (0.5 * (vx * vx + vy * vy) + links_.gravity * y);
  }
  return energy;
}

}  // namespace harness
