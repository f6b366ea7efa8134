// The question of plane.h the other way round: what strain and what error does a method reach
// within a frame budget?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/analysis/measured_point.h"

namespace harness::analysis {

inline constexpr double frame_rate = 60;  // frames a second

// The run that a method reaches the most with: the tightest strain limit whose motion is right to
// the headline's error, and of these runs the one of least error; without such a run, the one of
// least error at the loosest limit.
struct Reach {
  double strain_limit, error;  // error: not-a-number if it is not known
  double frame_seconds;        // 99 % of frames take at most that
  bool right;                  // to the headline's error
  Point point;
};

struct Budgeted {
  std::string row;  // an unranked contestant's is its solver's
  std::string family;
  std::vector<Reach> stairs;  // runs that reach more than every run with shorter frames
  std::vector<std::optional<Reach>> reached;  // one for each budget; none: no run is that fast
};

// One scene and size. Rows: tightest strain at the largest budget first.
struct BudgetTable {
  std::string scene;
  int resolution = 0, vertices = 0;
  std::vector<double> budgets;  // s a frame
  std::vector<Budgeted> rows;
};

// Runs with a step controller do not take part.
std::vector<BudgetTable> budget_tables(const Runs& runs, const std::vector<double>& budgets);

}  // namespace harness::analysis
