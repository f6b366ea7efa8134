// What analysis works on: the runs and contestants of a result file; and numbers in words.
#pragma once

#include "harness/base/statistics.h"
#include "harness/points/point.h"

namespace harness::analysis {

// A run of a result file. Copies share their data.
class Point {
 public:
  // noise: of the file's A/A pair, see ratio_of_times. scatter: between its occasions, see
  // ratio_on_another_day.
  explicit Point(const json& document, double noise = std::nan(""), double scatter = std::nan(""));

  const PointResult& result() const { return *result_; }
  const PointSpec& spec() const { return result_->spec; }
  const Measures& measures() const { return result_->measures; }
  const std::string& id() const { return id_; }
  const std::string& contestant() const { return spec().contestant; }  // a solver with its settings
  bool ok() const { return result_->ok(); }
  bool timed() const { return !result_->samples.empty(); }

  const std::string& scene() const { return spec().scene; }
  const std::string& sweep() const { return spec().sweep; }
  double vertices() const { return spec().vertices; }
  double strain_limit() const { return spec().strain_limit; }
  double step() const { return spec().step; }                      // s
  double duration() const { return scene_parameter("duration"); }  // s
  double scene_parameter(const char* name) const;                  // not-a-number: none
  double stiffness() const;  // EA, N, as given or found; not-a-number: none

  double seconds() const { return result_->seconds(); }  // not-a-number where nothing was timed
  double noise() const { return noise_; }
  double scatter() const { return scatter_; }
  // The largest strain that a user gets, hence after the collision filter.
  double delivered_strain() const;
  // In the paper's order the obstacle pushes vertices out after the solve (contact 0).
  bool collides_last() const { return scene_parameter("contact") == 0; }
  // Distance to the reference at a level (points/measures.h); any_motion: at the headline's.
  ErrorAtLevel error_at(double level) const;
  // Whether that distance is known to be within the level; any_motion: always.
  bool within_error(double level) const { return harness::within_error(measures(), level); }

 private:
  std::shared_ptr<const PointResult> result_;
  std::string id_;
  double noise_, scatter_;
};

// The ratio of a's time to b's. Where both were timed on several occasions, the interval is that of
// another day; otherwise it is that of their samples.
Ratio ratio(const Point& a, const Point& b);

// How well intervals hold on another day. Every occasion is compared with the interval that the
// others give, which takes three.
struct Coverage {
  int ratios = 0, outside = 0;
  int occasions = 0;  // most of any point
};
struct Runs;
// It counts all pairs of best points in one place.
Coverage coverage_of(const Runs& runs);
// A sentence, "" for a single occasion.
std::string text(const Coverage& coverage);

struct Role {
  std::string name, family, solver;
  bool competes = true;
  bool unranked = false;  // shown beside its tuned self, not ranked
  bool again = false;     // the second of an A/A pair
  bool ranked() const { return competes && !unranked && !again; }
  // The row of its points where any settings may be chosen: an unranked one's is its solver's,
  // except for the second of an A/A pair, which would give the first a second chance.
  const std::string& row() const { return unranked && !again ? solver : name; }
};

// From a file's legend and A/A pair. A contestant that it does not name is its own family.
struct ContestantRoles {
  std::map<std::string, Role> known;

  ContestantRoles() = default;
  explicit ContestantRoles(const json& document);
  Role of(const std::string& contestant) const;
};

// A result file of schema inextensible-bench/1.
struct Runs {
  std::vector<Point> points;  // in the file's order
  ContestantRoles roles;
  std::vector<double> levels;  // any_motion, then loose to tight, down to the sweep's finest one

  Runs(const json& document);
};

// The items by their key, in the order in which keys first appear.
template <class Items, class Key>
auto grouped(const Items& items, Key key) {
  using Item = std::decay_t<decltype(*items.begin())>;
  using Value = std::decay_t<std::invoke_result_t<Key, const Item&>>;
  std::vector<std::pair<Value, std::vector<Item>>> groups;
  for (const Item& item : items) {
    Value value = std::invoke(key, item);
    auto group = groups.begin();
    while (group != groups.end() && group->first != value) ++group;
    if (group == groups.end()) group = groups.insert(group, {std::move(value), {}});
    group->second.push_back(item);
  }
  return groups;
}

// A scene made of files goes by the first one's name and four digits of the hash of them all:
// "shirt.obj (1c3f)" for "mesh:clothes/shirt.obj,pins=y>1.2,content=1c3f...".
std::string scene_words(const std::string& scene);
std::string percent(double fraction);    // "1.2 %"
std::string time_words(double seconds);  // "1.23 s", "41.3 ms", "0.51 ms"
// "3.5 (3.3-3.8)" with its 95 % interval; "3.5 (?)": it is not known.
std::string text(const Ratio& ratio);

struct PaperMethod {
  const char* name;  // of the contestant in result files, and of the solver
  const char* words;
};

inline constexpr PaperMethod implicit_springs{"implicit_springs", "implicit springs"},
    jacobi{"jacobi", "Jacobi"}, gauss_seidel{"gauss_seidel", "Gauss-Seidel"},
    shake{"shake", "SHAKE"}, icd{"icd", "ICD"},
    fast_projection{"fast_projection", "fast projection"};
inline constexpr std::array all_paper_methods{implicit_springs, jacobi, gauss_seidel, shake, icd,
                                              fast_projection};

}  // namespace harness::analysis
