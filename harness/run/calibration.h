// The search for the stiffness of springs that keeps a strain limit.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "harness/run/point_runner.h"

namespace harness {

// Finds the stiffness EA at which the run's own maximum strain just meets the limit: Brent's method
// (GSL) on log strain / limit over log EA, bracketed from a guess. Runs far above the limit are cut
// short at twice the limit.
class Calibration {
 public:
  explicit Calibration(const PointRunner& runner) : runner_(runner) {}

  // The softest stiffness tried that met the limit; none if there is none (status() then says why).
  // guess: EA, N. Throws Interrupted.
  std::optional<double> find(double guess);

  int runs() const { return runs_; }
  PointStatus status() const { return status_; }
  const std::string& detail() const { return detail_; }

 private:
  bool best_close() const;
  bool alive() const;
  double excess(double log_stiffness);
  double evaluate(double log_stiffness);
  void brent(double soft, double stiff);

  const PointRunner& runner_;
  int runs_ = 0;
  std::map<double, double> known_;  // Brent's method asks for the bracket's ends again
  std::optional<double> best_;
  double best_excess_ = 0;
  PointStatus status_ = PointStatus::strain_missed;
  std::string detail_ = "no stiffness keeps the strain within the limit";
};

}  // namespace harness
