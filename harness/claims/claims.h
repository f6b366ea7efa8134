// The claims C1 to C16 of Goldenthal et al. 2007, each decided from result files by a stated rule,
// and what they are judged with: verdicts from numbers with intervals, points of result files, and
// curves of each contestant's best points.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "harness/analysis/measured_point.h"
#include "harness/base/statistics.h"

namespace harness::claims {

using namespace analysis;  // claims speak of what was analysed

constexpr const char* reproduced = "reproduced";
constexpr const char* not_reproduced = "not reproduced";
constexpr const char* changed = "changed";      // in part, or by another amount
constexpr const char* undecided = "undecided";  // an interval has values on both sides
constexpr const char* not_measured = "not yet measured";

struct Verdict {
  std::string verdict = not_measured;
  std::string measured;             // one or two sentences with figures
  std::vector<std::string> points;  // ids behind it
};

// What an interval says of a statement; open: it has values on both sides.
enum class Answer { yes, no, open };

inline Answer yes_if(bool so) { return so ? Answer::yes : Answer::no; }
Answer above(const Ratio& ratio, double threshold);
Answer above(const Slope& slope, double threshold);
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
// `more` at the end of a list, after a separator unless it is the first.
void append(std::string& list, const std::string& more, const char* separator = ", ");

using Curve = std::map<double, Point>;  // by the value on the axis: a strain limit or vertices

// The points of some result files, which must outlive this. Points that two files have count once,
// those of runs with a step controller not at all.
struct Points {
  explicit Points(const std::vector<nlohmann::json>& results);

  std::vector<Point> all;
  bool repeated = false;  // two files have a point
  ContestantRoles roles;
  std::vector<const nlohmann::json*> matrix, freedom, same_frame;  // of stability sweeps

  // Over the axis of a sweep ("strain" or "resolution"): what one contestant, or "" the fastest of
  // all, answers within a level of error (analysis/plane.h), with tuned or untuned settings. One
  // tuned setting serves all places of a scene; where the method's own default is faster, that
  // counts, so that tuning harms nobody. Of strain sweeps of several sizes the largest counts,
  // unless one is named.
  Curve best(const std::string& scene, const std::string& sweep, const std::string& contestant,
             double level = any_motion, std::optional<double> vertices = {}) const;
  // Over error levels: the fastest point of step sweeps of the largest size within each, at any
  // step and limit, with tuned or untuned settings.
  Curve best_at_errors(const std::string& scene, const std::string& contestant) const;
};

std::optional<Point> at(const Curve& curve, double x);
std::vector<std::string> ids_of(const std::vector<Curve>& curves);

// A claim looked at in several ways, each with its words, of which the first decides: the project's
// question, an error of at most 2 %, and beside it the paper's own, any motion, and `more`.
using Ways = std::vector<std::pair<std::string, Verdict>>;
Verdict at_levels(const std::function<Verdict(double level)>& judge, const Ways& more = {});

// ---- One function a claim; without a verdict where measurements are missing ----

using Judge = Verdict(const Points& points);
Judge chain_time_over_strain, chain_time_over_resolution, chain_speed, springs_stiffness;
Judge drape_time_over_strain, drape_time_over_resolution, residual_order, same_frame;
Judge failure_configurations, no_drift, matrix_sizes, patch_sag, strain_after_collision;
Judge degrees_of_freedom_left, shake_small_steps, garment_slip;

// The sag of a yarn under a load that is even along the line between its ends, which are `length`
// (m) apart: a parabola whose arc is longer than that by `strain`.
double parabola_sag(double length, double strain);

// How far a garment's rim is below the waist where it began, over the way from there to the hips;
// of the end that is higher and of the one that is lower.
struct Slip {
  double least, most;
};
Slip slip_of(const Point& point);

}  // namespace harness::claims

namespace harness {

struct ClaimVerdict : claims::Verdict {
  std::string id, where, statement;
  std::string rule;  // how the verdict follows from what was measured
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ClaimVerdict, id, statement, verdict, measured, rule)

// Throws UsageError for a result of --untimed, whose times say nothing.
void check_timed(const nlohmann::json& result);

// results: documents of schema inextensible-bench/1 and inextensible-stability/1; their points are
// taken together. Where several documents have a point, the first one's counts, and a verdict that
// the last one's would change is undecided. Throws UsageError for documents that lack what a claim
// looks at.
std::vector<ClaimVerdict> judge_claims(const std::vector<nlohmann::json>& results);

void print_claims(std::ostream& out, const std::vector<ClaimVerdict>& claims);
void print_claims_markdown(std::ostream& out, const std::vector<ClaimVerdict>& claims);

}  // namespace harness
