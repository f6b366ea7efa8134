// The search for the stiffness of springs that keeps a strain limit.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "harness/points/status.h"
#include "harness/scenes/scene.h"

namespace harness {

// Finds the stiffness EA at which the run's own maximum strain just meets the limit. Strain is
// tension over stiffness, and tension hardly depends on stiffness: that law leads from a guess to a
// bracket, and Brent's method (GSL) on log strain / limit over log EA does the rest.
class Calibration {
 public:
  struct Trial {
    PointStatus status = PointStatus::ok;  // strain_missed: beyond the limit
    double strain = 0;                     // the largest, up to where the run ended
    double seconds = 0;
    std::string detail;
  };
  // A run with this stiffness, N. It may be cut short at cut_short times the limit.
  using Run = std::function<Trial(double stiffness)>;
  static constexpr double cut_short = 2;
  static constexpr int run_limit = 16;
  static constexpr int failure_limit = 6;

  Calibration(double strain_limit, Run run) : limit_(strain_limit), run_(std::move(run)) {}

  // The softest stiffness tried that met the limit; none if there is none (status() then says why).
  // A run that times out says nothing of its strain: it ends the search, without a stiffness and
  // with the status `skipped`. A run that fails otherwise is never the answer; springs may be too
  // stiff for Newton's iteration, or too soft, and both are tried. guess: EA, N.
  std::optional<double> find(double guess);

  int runs() const { return runs_; }
  PointStatus status() const { return status_; }
  const std::string& detail() const { return detail_; }

 private:
  bool best_close() const;
  bool alive() const { return runs_ < run_limit && failures_ < failure_limit && !timed_out_; }
  double excess(double log_stiffness);
  double evaluate(double log_stiffness);
  void brent(double soft, double stiff);

  double limit_;
  Run run_;
  int runs_ = 0, failures_ = 0;
  bool timed_out_ = false;
  std::map<double, double> known_;  // Brent's method asks for the bracket's ends again
  std::optional<double> best_;
  double best_excess_ = 0;
  PointStatus status_ = PointStatus::strain_missed;
  std::string detail_ = "no stiffness keeps the strain within the limit";
};

// s: how long work that springs have counted takes on a usual machine, within a factor of two. It
// is the same each time, as the clock's time is not.
double nominal_seconds(const inextensible::WorkCounters& work, int edges);

// N: where a search may begin without a neighbour's stiffness to go by.
double first_stiffness(const Scene& scene, double strain_limit);

}  // namespace harness
