#include "harness/run/calibration.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "harness/base/text.h"

namespace harness {
namespace {

constexpr double close_enough = 0.85;  // of the limit
// Between it and the limit, from the permitted side.
const double aim = 0.5 * std::log(close_enough);
// In decades; where a run was cut short, its strain would have been more.
constexpr double least_stride_from_cut_short = 0.4;
constexpr double stride_from_failure = 0.3;  // in decades

// Runs that came to their end. What else they did wrong is said of the measured run.
bool strain_counts(PointStatus status) {
  return status == PointStatus::ok || status == PointStatus::strain_missed ||
         status == PointStatus::energy_gained || status == PointStatus::motion_lost;
}

}  // namespace

std::optional<double> Calibration::find(double guess) {
  std::optional<double> soft, stiff;  // logarithms: too soft, stiff enough
  double at = std::log10(guess);
  for (int strides = 0; alive() && !best_close();) {
    const int failures = failures_;
    const double f = excess(at);
    if (failures_ > failures && !soft && !stiff) {  // both sides in turn, softer springs first
      const int pair = (failures_ + 1) / 2;
      at = std::log10(guess) + (failures_ % 2 ? -1 : 1) * stride_from_failure * pair;
      continue;
    }
    (f > 0 ? soft : stiff) = at;
    if (soft && stiff) break;
    ++strides;
    double stride = strides * std::abs(f - aim) / std::log(10);
    if (f >= std::log(cut_short)) stride = std::max(stride, strides * least_stride_from_cut_short);
    at += f > 0 ? stride : -stride;
  }
  if (alive() && !best_close() && soft && stiff) brent(*soft, *stiff);
  return timed_out_ ? std::nullopt : best_;
}

bool Calibration::best_close() const { return best_ && best_excess_ >= std::log(close_enough); }

// log(max strain / limit). Of a run that failed, its strain up to there tells the side, not how
// far.
double Calibration::excess(double log_stiffness) {
  const auto [known, fresh] = known_.try_emplace(log_stiffness, 0.0);
  if (fresh) known->second = evaluate(log_stiffness);
  return known->second;
}

double Calibration::evaluate(double log_stiffness) {
  const double stiffness = std::pow(10, log_stiffness);
  ++runs_;
  const Trial trial = run_(stiffness);
  if (trial.status == PointStatus::timeout) {
    timed_out_ = true;
    status_ = PointStatus::skipped;
    detail_ = "timed out while calibrating: run " + std::to_string(runs_) + ", stiffness " +
              number_text(stiffness) + " N, strain so far " + number_text(trial.strain) + ", " +
              number_text(trial.seconds) + " s of stepping; " + trial.detail;
    return std::log(cut_short);
  }
  if (!strain_counts(trial.status)) {
    status_ = trial.status;
    detail_ = "calibration, " + trial.detail;
    ++failures_;
    return trial.strain <= limit_ ? -std::log(cut_short) : std::log(cut_short);
  }
  const double f = std::log(std::max(trial.strain, 1e-300) / limit_);
  if (f <= 0 && (!best_ || stiffness < *best_)) {
    best_ = stiffness;
    best_excess_ = f;
  }
  return f;
}

void Calibration::brent(double soft, double stiff) {
  gsl_set_error_handler_off();
  const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  gsl_function function{
      [](double x, void* self) { return static_cast<Calibration*>(self)->excess(x) - aim; }, this};
  if (gsl_root_fsolver_set(solver.get(), &function, soft, stiff) != GSL_SUCCESS) return;
  while (alive() && !best_close()) {
    if (gsl_root_fsolver_iterate(solver.get()) != GSL_SUCCESS) return;
    if (gsl_root_fsolver_x_upper(solver.get()) - gsl_root_fsolver_x_lower(solver.get()) < 1e-3)
      return;
  }
}

}  // namespace harness
