// The question of docs/measuring.md, answered from a result file: which method is fastest such that
// no edge is strained by more than a limit and the motion error is within a level.
#pragma once

#include "harness/analysis/measured_point.h"

namespace harness::analysis {

// A contestant's best run within a level of error: the one that its sweep marked, or the fastest in
// files without marks. Only runs that kept their limit count, with steps of at most a frame.
// points: of one contestant, scene, size and limit.
std::optional<Point> fastest_of(const std::vector<Point>& points, double level);

// A contestant's fastest run at a cell's strain limit or a tighter one.
struct Entry {
  Role role;
  std::string row;      // role.row()
  bool counts = false;  // fastest of its row, and not the second of an A/A pair
  Point point;
  double error = unknown;  // at the cell's level; of any motion at the headline's
};

// With whom the first of a cell is compared: the fastest counting entry of each kind.
enum class Rival {
  next_family,         // of another family
  paper_best,          // one of the paper's six as published
  first_as_published,  // the first's own method in its published stepper
  rival_in_stepper,    // another method in the first's stepper
  paper_in_any_stepper
};
struct RivalInfo {
  const char *name, *lead;  // in JSON: the rival, and its time over the first's
  bool (*is)(const Entry& first, const Entry& other);
};
extern const std::array<RivalInfo, 5> rival_infos;  // in the order of Rival

// One strain limit and error level.
struct Cell {
  double strain_limit = 0, level = any_motion;
  std::vector<Entry> entries;  // fastest first
  double known_until = 0;      // s: the last sample time of the level; 0: errors are not known
  std::string empty_because;   // why there is no entry; "" if there is one

  // Below, null: there is none.
  const Entry* first() const { return counting(0); }
  const Entry* counting(std::size_t place) const;  // 0: the fastest of those that count
  const Entry* rival(Rival which) const;
  // Whether the first has rivals, and is faster than each of them beyond the noise.
  bool clear() const;
  // Times over the first's.
  std::optional<Ratio> lead_over(const Entry* other) const;
};

// One scene and size in one kind of sweep.
struct Plane {
  std::string scene, sweep;
  SceneParameters scene_parameters;
  int resolution = 0, vertices = 0;
  std::vector<double> limits;  // loose to tight
  std::vector<double> levels;  // any_motion, then loose to tight
  std::vector<Cell> cells;     // by limit, then by level
  std::vector<Point> points;   // in the file's order

  const Cell& cell(double limit, double level) const;
};

// In the order of runs.
std::vector<Plane> planes_of(const Runs& runs);

// The cell at the limit next to 1 % and the tightest level, down to the headline's, that has an
// answer; at any motion if none has.
const Cell& headline_of(const Plane& plane);
// Whether it is the largest of its resolution sweep; other sweeps have one size.
bool is_largest(const Plane& plane, const std::vector<Plane>& planes);

// ---- The answers in words, as the terminal, pages and figures print them ----

// On one plane; for a resolution sweep on the largest one.
struct Finding {
  std::string scene, sweep;
  int vertices = 0;
  std::string subject;  // "drape of 5041 vertices"
  // The headline's answer; then what a tighter limit, or any motion, changes.
  std::vector<std::string> sentences;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, scene, sweep, vertices, subject, sentences)

// "At 1 % strain, motion error at most 2 %, x is the fastest: 41.3 ms a simulated second with steps
// of 1/200 s and an error of 1.4 %; y, the best of the paper's six, takes 2.1 (1.9-2.3) times ..."
std::string sentence_of(const Cell& cell);
std::vector<Finding> findings_of(const std::vector<Plane>& planes);

// "chain, 80 vertices, over strain". Planes of one title, as of a resolution sweep, share a table.
std::string title_of(const Plane& plane);

// JSON of schema inextensible-analysis/1, for `bench show --json` and figures.
json analysis_of(const Runs& runs);

}  // namespace harness::analysis
