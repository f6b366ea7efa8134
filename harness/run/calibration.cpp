#include "harness/run/calibration.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include "harness/judge/mechanics.h"

namespace harness {
namespace {

constexpr double close_enough = 0.85;  // of the limit
// Between it and the limit, from the permitted side.
const double aim = 0.5 * std::log(close_enough);
// In decades; the strain of a run that was cut short would have been larger.
constexpr double least_stride_from_cut_short = 0.4;
constexpr double stride_from_failure = 0.3;  // in decades

// The tension of a strand of springs over its share of the scene's forces; strain = tension / EA.
// In a falling chain the tension is a few times its weight.
constexpr double tension_over_force = 5;

// Runs that reached their end. The measured run reports what else went wrong.
bool strain_counts(PointStatus status) {
  return status == PointStatus::ok || status == PointStatus::strain_missed ||
         status == PointStatus::energy_gained || status == PointStatus::motion_lost ||
         status == PointStatus::body_crossed;
}

class StiffnessSearch {
 public:
  StiffnessSearch(double strain_limit, const std::function<CalibrationTrial(double)>& run)
      : limit_(strain_limit), run_(run) {}

  Calibration find(double guess) {
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
      if (f >= std::log(calibration_cut_short))
        stride = std::max(stride, strides * least_stride_from_cut_short);
      at += f > 0 ? stride : -stride;
    }
    if (alive() && !best_close() && soft && stiff) brent(*soft, *stiff);
    if (timed_out_) found_.stiffness.reset();
    return found_;
  }

 private:
  bool best_close() const { return found_.stiffness && best_excess_ >= std::log(close_enough); }
  bool alive() const {
    return found_.runs < calibration_run_limit && failures_ < calibration_failure_limit &&
           !timed_out_;
  }

  // log(max strain / limit). For a run that failed, only the sign means anything.
  double excess(double log_stiffness) {
    const auto [known, fresh] = known_.try_emplace(log_stiffness, 0.0);
    if (fresh) known->second = evaluate(std::pow(10, log_stiffness));
    return known->second;
  }

  double evaluate(double stiffness) {
    ++found_.runs;
    const CalibrationTrial trial = run_(stiffness);
    if (trial.status == PointStatus::timeout) {
      timed_out_ = true;
      found_.status = PointStatus::skipped;
      found_.detail = concat("timed out while calibrating: run ", found_.runs, ", stiffness ",
                             stiffness, " N, strain so far ", trial.strain, ", ", trial.seconds,
                             " s of stepping; ", trial.detail);
      return std::log(calibration_cut_short);
    }
    if (!strain_counts(trial.status)) {
      found_.status = trial.status;
      found_.detail = "calibration, " + trial.detail;
      ++failures_;
      return std::log(calibration_cut_short) * (trial.strain <= limit_ ? -1 : 1);
    }
    const double f = std::log(std::max(trial.strain, 1e-300) / limit_);
    if (f <= 0 && (!found_.stiffness || stiffness < *found_.stiffness)) {
      found_.stiffness = stiffness;
      best_excess_ = f;
    }
    return f;
  }

  void brent(double soft, double stiff) {
    gsl_set_error_handler_off();
    const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
        gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
    gsl_function function{
        [](double x, void* self) { return static_cast<StiffnessSearch*>(self)->excess(x) - aim; },
        this};
    if (gsl_root_fsolver_set(solver.get(), &function, soft, stiff) != GSL_SUCCESS) return;
    while (alive() && !best_close()) {
      if (gsl_root_fsolver_iterate(solver.get()) != GSL_SUCCESS) return;
      if (gsl_root_fsolver_x_upper(solver.get()) - gsl_root_fsolver_x_lower(solver.get()) < 1e-3)
        return;
    }
  }

  double limit_;
  const std::function<CalibrationTrial(double)>& run_;
  Calibration found_;
  double best_excess_ = 0;
  int failures_ = 0;
  bool timed_out_ = false;
  std::map<double, double> known_;  // Brent's method asks for the bracket's ends again
};

}  // namespace

Calibration calibrate_stiffness(double strain_limit, double guess,
                                const std::function<CalibrationTrial(double)>& run) {
  return StiffnessSearch(strain_limit, run).find(guess);
}

// Measured on a cloth of 15 x 15 and a chain of 80, with both methods that have springs.
double nominal_seconds(const WorkCounters& work, int edges) {
  return 15e-9 * static_cast<double>(work.spring_evaluations) +
         20e-9 * static_cast<double>(work.iterations) * edges +
         0.4e-9 * static_cast<double>(work.factorizations) * work.factor_flops +
         2e-9 * static_cast<double>(work.back_solves) * work.factor_nonzeros;
}

// The scene's force is its weight, or m v^2 / (2 size) of what flies without one. As many strands
// share it as sizes fit into the length of all edges: one in a chain, two a row of a cloth.
double first_stiffness(const Scene& scene, double strain_limit) {
  double length = 0;
  for (const double l : scene.problem->rest_length()) length += l;
  const double strands = std::max(1.0, std::round(length / scene.size));
  const double force_of_a_strand = energy_scale(scene) / scene.size / strands;
  return tension_over_force * force_of_a_strand / strain_limit;
}

}  // namespace harness
