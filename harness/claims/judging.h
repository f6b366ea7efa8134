// What the claims are judged with: verdicts from numbers with intervals, points of result files,
// and curves of each contestant's best points.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/analysis/measured_point.h"
#include "harness/analysis/words.h"
#include "harness/base/statistics.h"
#include "harness/claims/claims.h"

namespace harness::claims {

using namespace analysis;  // claims speak of what was analysed

// Verdicts.
constexpr const char* reproduced = "reproduced";
constexpr const char* not_reproduced = "not reproduced";
constexpr const char* changed = "changed";      // in part, or by another amount
constexpr const char* undecided = "undecided";  // an interval has values on both sides
constexpr const char* not_measured = "not yet measured";

// What an interval says of a statement; open: it has values on both sides.
enum class Answer { yes, no, open };

Answer above(const Ratio& ratio, double threshold);
Answer above(const Slope& slope, double threshold);
Answer below(const Slope& slope, double threshold);
Answer all_of(const std::vector<Answer>& answers);  // no if one is no

std::string verdict_of(Answer answer);
// Verdict on a claim in two parts: one yes and one no is `changed`.
std::string verdict_of(Answer one, Answer other);
// Counts of places: not reproduced if not so at most, changed if so at most, undecided if at half.
std::string verdict_of_counts(int yes, int no, int all);
// Verdict on a claim judged in several ways; a way that was not measured does not count.
std::string verdict_of_all(const std::vector<std::string>& verdicts);

using analysis::text;
std::string text(double value, int digits = 3);
std::string text(const Slope& slope);  // "-0.5 ± 0.1", with its 95 % interval

using Filter = std::function<bool(const Point&)>;
using Curve = std::map<double, Point>;  // by the value on the axis: a strain limit or vertices

// Errors over the scene's size that contests of least time are held at.
inline constexpr std::array error_levels{0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001};

// All points of some result files, which must outlive this. Points that two files have count once,
// those of runs with a step controller not at all.
class Points {
 public:
  explicit Points(const std::vector<nlohmann::json>& results);

  std::vector<Point> where(const Filter& wanted) const;
  bool repeated() const { return repeated_; }  // two files have a point

  // The cell of a stability sweep; null if there is none.
  const nlohmann::json* cell(const std::string& hard_case, const std::string& solver) const;
  const std::vector<const nlohmann::json*>& matrix() const { return matrix_; }
  const std::vector<const nlohmann::json*>& freedom() const { return freedom_; }
  const std::vector<const nlohmann::json*>& same_frame() const { return same_frame_; }

  // Over the axis of a sweep ("strain" or "resolution"): what one contestant answers within a level
  // of error (analysis/plane.h), with tuned or untuned settings. One tuned setting serves all
  // places of a scene; where the method's own default is faster, that counts, so that tuning harms
  // nobody.
  // vertices: of a strain sweep; none: the largest.
  Curve best(const std::string& scene, const std::string& sweep, const std::string& contestant,
             double level = any_motion, std::optional<double> vertices = {}) const;
  // Vertices of a scene's points in a sweep, large to small.
  std::vector<double> sizes(const std::string& scene, const std::string& sweep) const;
  // Over error levels: the fastest point within each, at any step and limit, with tuned or untuned
  // settings, of the largest size in step sweeps.
  Curve best_at_errors(const std::string& scene, const std::string& contestant) const;

  Role about(const std::string& contestant) const { return roles_.of(contestant); }
  // Those with points in a sweep of a scene that are ranked, in the files' order.
  std::vector<Role> ranked(const std::string& scene, const std::string& sweep,
                           std::optional<double> vertices = {}) const;
  bool same_family(const std::string& a, const std::string& b) const {
    return roles_.of(a).family == roles_.of(b).family;
  }

 private:
  bool of(const Point& point, const std::string& scene, const std::string& sweep,
          std::optional<double> vertices = {}) const;

  std::vector<Point> all_;
  bool repeated_ = false;
  ContestantRoles roles_;
  // Vertices, by scene and sweep.
  std::map<std::pair<std::string, std::string>, std::set<double, std::greater<>>> sizes_;
  std::vector<const nlohmann::json*> matrix_, freedom_, same_frame_;
};

// Slope of seconds over the axis, both logarithmic.
Slope slope_of(const Curve& curve);
// Ratio of a's seconds to b's, where both have a point: its interval is the wider one of what the
// scatter about the line and what the ratios' own intervals give.
Slope slope_of_ratio(const Curve& a, const Curve& b);
// Notes the curve's points as evidence.
void cite(ClaimVerdict& claim, const Curve& curve);
std::optional<Point> at(const Curve& curve, double x);

// A level of error that a claim is looked at, and how the text says it. The first decides: the
// project's question. The second, the paper's own, stands beside it.
struct Level {
  double error;
  const char* words;
};
inline constexpr std::array claim_levels{Level{headline_error, "at an error of at most 2 %"},
                                         Level{any_motion, "at any motion"}};

// Collects what each way says; the claim's verdict is the first one's.
class Ways {
 public:
  explicit Ways(ClaimVerdict& claim) : claim_(claim) {}
  Ways(const Ways&) = delete;
  Ways& operator=(const Ways&) = delete;
  ~Ways();

  void add(const std::string& words, const std::string& verdict, const std::string& measured,
           const std::vector<Curve>& evidence = {});

 private:
  ClaimVerdict& claim_;
  std::vector<std::string> verdicts_;
};

// ---- One function a claim ----
// Each fills in the rule, the evidence, what was measured and the verdict; leaves the verdict alone
// where measurements are missing.

void chain_time_over_strain(const Points& points, ClaimVerdict& claim);      // C1
void chain_time_over_resolution(const Points& points, ClaimVerdict& claim);  // C2
void chain_speed(const Points& points, ClaimVerdict& claim);                 // C3
void springs_stiffness(const Points& points, ClaimVerdict& claim);           // C4
void drape_time_over_strain(const Points& points, ClaimVerdict& claim);      // C5
void drape_time_over_resolution(const Points& points, ClaimVerdict& claim);  // C6
void residual_order(const Points& points, ClaimVerdict& claim);              // C7
void same_frame(const Points& points, ClaimVerdict& claim);                  // C8
void failure_configurations(const Points& points, ClaimVerdict& claim);      // C9
void no_drift(const Points& points, ClaimVerdict& claim);                    // C10
void matrix_sizes(const Points& points, ClaimVerdict& claim);                // C11
void patch_sag(const Points& points, ClaimVerdict& claim);                   // C12
void strain_after_collision(const Points& points, ClaimVerdict& claim);      // C13
void degrees_of_freedom_left(const Points& points, ClaimVerdict& claim);     // C14
void shake_small_steps(const Points& points, ClaimVerdict& claim);           // C15
void garment_slip(const Points& points, ClaimVerdict& claim);                // C16

// The sag of a yarn under a load that is even along the line between its ends, which are `length`
// (m) apart: a parabola whose arc is longer than that by `strain`.
double parabola_sag(double length, double strain);

// How far a garment's rim is below the waist where it began, over the way from there to the hips;
// of the end that is higher and of the one that is lower.
struct Slip {
  double least, most;
  bool held() const { return most < 1; }
  bool past() const { return least > 1; }
};
Slip slip_of(const Point& point);

}  // namespace harness::claims
