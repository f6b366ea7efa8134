// The tables of docs/results.md, one file a family: what they share, and what each prints.
#pragma once

#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "harness/claims/curves.h"
#include "harness/claims/results_page.h"

namespace harness::claims {

// ---- shared (page.cpp) ----
void print_row(std::ostream& out, const std::vector<std::string>& cells);
void print_head(std::ostream& out, const std::vector<std::string>& cells);
std::string quoted(const std::string& name);
std::string bold(const std::string& text);
// As number_text(), but never with a power of ten where the number has more digits.
std::string plain(double value, int digits);
// What a phase, or contact within the phases, takes of one run's time; not-a-number: it was not
// measured.
double part_of_time(const Point& p, const char* phase);
bool is_stability(const nlohmann::json& document);

// Points of one scene and kind of sweep of one file, in the file's order; of strain and step sweeps
// of one size too.
struct ScenePoints {
  std::string title;  // "drape, 441 vertices"
  std::vector<Point> points;
  Cast cast;

  bool has_collider() const;
  // In the files' order, without the second of an A/A pair; hollow ones after all others.
  std::vector<Role> contestants() const;
  std::vector<Role> ranked() const;  // those that are not hollow
  bool untuned(const Point& p) const { return cast.of(p.contestant()).hollow; }
};
std::vector<ScenePoints> scenes_of(const nlohmann::json& document, const std::string& sweep,
                                   bool sizes_apart);

// A table with a row for each contestant and a column for each place of an axis.
class PlaceTable {
 public:
  explicit PlaceTable(std::vector<Role> contestants) : contestants_(std::move(contestants)) {}

  // Of several points the fastest one stays. `row`: whose it is, if not the point's contestant's.
  void add(double place, const Point& point, const std::string& row = {});
  bool empty() const { return places_.empty(); }
  const std::vector<double>& places() const { return places_; }
  const std::vector<Role>& contestants() const { return contestants_; }
  void loose_to_tight();  // places from large to small; else from small to large
  // Leaves out places whose points are all those of the next one.
  void drop_repeated_places();

  const Point* find(const std::string& contestant, double place) const;
  // The ranked contestant that is faster than each other there beyond the noise; null: none is.
  const Point* clear_best(double place) const;

  using Cell = std::function<std::string(const Point&, double place)>;
  void print(std::ostream& out, const std::function<std::string(double)>& head,
             const Cell& cell) const;

 private:
  std::vector<Role> contestants_;
  std::vector<double> places_;  // sorted
  std::map<std::pair<std::string, double>, Point> cells_;
};

// The best points over the strain limit, loose to tight, of a scene of that name; empty of another
// scene. `scene`: of strain sweeps.
PlaceTable best_over_limits(const ScenePoints& scene, const char* name);

// ---- families of tables ----
void print_planes(std::ostream& out, const NamedResult& result);
// sweep: "strain" or "resolution".
void print_best_points(std::ostream& out, const NamedResult& result, const std::string& sweep);
// Beside a ranking of best points: strains, time of the filter, energy, failures, what tuning did.
// `own`: of each contestant its own best points, where `best` has those of any of its settings.
void print_beside(std::ostream& out, const ScenePoints& scene, const PlaceTable& best,
                  const PlaceTable& own, const std::function<std::string(double)>& place);
void print_delivered(std::ostream& out, const NamedResult& result);
void print_sag(std::ostream& out, const NamedResult& result);
void print_survival(std::ostream& out, const std::vector<NamedResult>& results);
void print_slip(std::ostream& out, const NamedResult& result);
void print_time_to_error(std::ostream& out, const NamedResult& result);
void print_growth(std::ostream& out, const NamedResult& result);
void print_answers(std::ostream& out, const NamedResult& result);
void print_hard_cases(std::ostream& out, const NamedResult& result);
void print_tuned(std::ostream& out, const std::vector<NamedResult>& results);
void print_sources(std::ostream& out, const std::vector<NamedResult>& results);

}  // namespace harness::claims
