#include "harness/run/calibration.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace harness {
namespace {

constexpr double close_enough = 0.85;  // of the limit
constexpr int run_limit = 16;

bool done(double f) { return f <= 0 && f >= std::log(close_enough); }

}  // namespace

std::optional<double> Calibration::find(double guess) {
  double soft = std::log10(guess), f_soft = excess(soft);
  double stiff = soft, f_stiff = f_soft;
  const double stride = 0.4;
  for (int i = 0; f_soft <= 0 && i < 12 && !done(f_soft) && alive(); ++i) {
    stiff = soft;
    f_stiff = f_soft;
    soft -= stride * (i + 1);
    f_soft = excess(soft);
  }
  for (int i = 0; f_stiff > 0 && i < 12 && alive(); ++i) {
    soft = stiff;
    f_soft = f_stiff;
    stiff += stride * (i + 1);
    f_stiff = excess(stiff);
  }
  if (alive() && !best_close() && f_soft > 0 && f_stiff <= 0) brent(soft, stiff);
  return best_;
}

bool Calibration::best_close() const { return best_ && best_excess_ >= std::log(close_enough); }

bool Calibration::alive() const { return runs_ < run_limit && !runner_.out_of_time(); }

// log(max strain / limit); a run that fails counts as far above.
double Calibration::excess(double log_stiffness) {
  const auto [known, fresh] = known_.try_emplace(log_stiffness, 0.0);
  if (fresh) known->second = evaluate(log_stiffness);
  return known->second;
}

double Calibration::evaluate(double log_stiffness) {
  const double limit = runner_.spec().strain_limit;
  inextensible::Settings settings = runner_.spec().settings;
  settings["stiffness"] = std::pow(10, log_stiffness);
  ++runs_;
  const Run run = runner_.run(settings, true, 2 * limit);
  const bool finished = run.status == PointStatus::ok || run.status == PointStatus::strain_missed;
  if (!finished) {
    status_ = run.status;
    detail_ = "calibration, " + run.detail;
    return std::log(2.0);
  }
  const double f = std::log(std::max(run.measures.max_strain, 1e-300) / limit);
  if (f <= 0 && (!best_ || log_stiffness < std::log10(*best_))) {
    best_ = std::pow(10, log_stiffness);
    best_excess_ = f;
  }
  return f;
}

void Calibration::brent(double soft, double stiff) {
  gsl_set_error_handler_off();
  const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  // Aims at the middle of the band that is close enough, from the permitted side.
  gsl_function function{[](double x, void* self) {
                          return static_cast<Calibration*>(self)->excess(x) -
                                 0.5 * std::log(close_enough);
                        },
                        this};
  if (gsl_root_fsolver_set(solver.get(), &function, soft, stiff) != GSL_SUCCESS) return;
  while (alive() && !best_close()) {
    if (gsl_root_fsolver_iterate(solver.get()) != GSL_SUCCESS) return;
    if (gsl_root_fsolver_x_upper(solver.get()) - gsl_root_fsolver_x_lower(solver.get()) < 1e-3)
      return;
  }
}

}  // namespace harness
