// The claims C1 to C16 of Goldenthal et al. 2007, each decided from result files by a stated rule.
#pragma once

#include <ostream>

#include "harness/analysis/measured_point.h"

namespace harness::claims {

using namespace analysis;  // claims speak of what was analysed

constexpr const char* reproduced = "reproduced";
constexpr const char* not_reproduced = "not reproduced";
constexpr const char* changed = "changed";      // in part, or by another amount
constexpr const char* undecided = "undecided";  // an interval has values on both sides
constexpr const char* not_measured = "not yet measured";

struct Verdict {
  std::string verdict = not_measured;
  std::string measured;             // one or two sentences
  std::vector<std::string> points;  // ids behind it
};

// Whether a statement holds over an interval; open: on a part of it.
enum class Answer { yes, no, open };

inline Answer yes_if(bool so) { return so ? Answer::yes : Answer::no; }
Answer above(const Ratio& ratio, double threshold);
Answer above(const Slope& slope, double threshold);
Answer all_of(const std::vector<Answer>& answers);  // no if one is no

std::string verdict_of(Answer answer);
// On a claim in two parts: one yes and one no is `changed`.
std::string verdict_of(Answer one, Answer other);
// By places: all yes: reproduced; over half no: not reproduced; over half yes, some no: changed.
std::string verdict_of_counts(int yes, int no, int all);
// On a claim judged in several ways; those not measured do not count.
std::string verdict_of_all(const std::vector<std::string>& verdicts);

using analysis::text;
std::string text(double value, int digits = 3);
std::string text(const Slope& slope);  // "-0.5 ± 0.1", with its 95 % interval

// The conditions of a comparison. The paper compares by strain alone, in the methods' own stepper.
struct Question {
  double level = any_motion;  // of error
  bool any_stepper = false;   // each method in the stepper that is best for it
  bool tighter = false;       // a run at a tighter strain limit counts, too
};

using Curve = std::map<double, Point>;  // by the value on the axis: a strain limit or vertices

// The points of some result files, which must outlive this. Points in several files count once;
// runs with a step controller do not count.
struct Points {
  explicit Points(const std::vector<json>& results);

  std::vector<Point> all;
  std::vector<Point> contests;  // those with contact inside the solve; others are evidence only
  bool repeated = false;        // two files have a point
  ContestantRoles roles;
  std::vector<const json*> matrix, freedom, same_frame;  // of stability sweeps

  // The best points of a method in contests over the axis of a sweep ("strain" or "resolution").
  // The faster of tuned and default settings counts, so that tuning harms nobody. A strain sweep
  // counts at its largest size unless `vertices` are given.
  Curve best(const std::string& scene, const std::string& sweep, const std::string& method,
             const Question& question = {}, std::optional<double> vertices = {}) const;
};

std::optional<Point> at(const Curve& curve, double x);
std::vector<std::string> ids_of(const std::vector<Curve>& curves);

// The paper's question decides. The answers at an error of at most 2 %, and in the best stepper of
// each method, are given beside it. Runs at tighter limits count in all.
Verdict at_questions(const std::function<Verdict(const Question&)>& judge);

// One function per claim; not_measured where measurements are missing.
using Judge = Verdict(const Points& points);
Judge chain_time_over_strain, chain_time_over_resolution, chain_speed, springs_stiffness;
Judge drape_time_over_strain, drape_time_over_resolution, residual_order, same_frame;
Judge failure_configurations, no_drift, matrix_sizes, patch_sag, strain_after_collision;
Judge degrees_of_freedom_left, shake_small_steps, garment_slip;

// How far both ends of a garment's rim have slipped from the waist, over the way to the hips.
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
void check_timed(const json& result, const std::string& name = "a result");

// results: documents of schemas inextensible-bench/1 and inextensible-stability/1. Where several
// have a point, the first one's counts; a verdict that the last one's would change is undecided.
// Throws UsageError for incomplete documents.
std::vector<ClaimVerdict> judge_claims(const std::vector<json>& results);

void print_claims(std::ostream& out, const std::vector<ClaimVerdict>& claims);
void print_claims_markdown(std::ostream& out, const std::vector<ClaimVerdict>& claims);

}  // namespace harness
