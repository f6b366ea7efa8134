#include "harness/claims/claims.h"

#include <iterator>
#include <set>

#include "harness/analysis/plane.h"
#include "harness/base/files.h"
#include "harness/points/result_file.h"

namespace harness::claims {

Answer above(const Ratio& ratio, double threshold) {
  if (ratio.above(threshold)) return Answer::yes;
  return ratio.below(threshold) ? Answer::no : Answer::open;
}

Answer above(const Slope& slope, double threshold) {
  if (slope.low() > threshold) return Answer::yes;
  return slope.high() < threshold ? Answer::no : Answer::open;
}

Answer all_of(const std::vector<Answer>& answers) {
  for (const Answer one : {Answer::no, Answer::open})
    if (std::ranges::count(answers, one) > 0) return one;
  return Answer::yes;
}

std::string verdict_of(Answer answer) {
  return answer == Answer::yes ? reproduced : answer == Answer::no ? not_reproduced : undecided;
}

std::string verdict_of(Answer one, Answer other) {
  return verdict_of_all({verdict_of(one), verdict_of(other)});
}

std::string verdict_of_counts(int yes, int no, int all) {
  if (yes == all) return reproduced;
  if (2 * no > all) return not_reproduced;
  return no > 0 && 2 * yes > all ? changed : undecided;
}

std::string verdict_of_all(const std::vector<std::string>& verdicts) {
  std::set<std::string> different(verdicts.begin(), verdicts.end());
  different.erase(not_measured);
  if (different.empty()) return not_measured;
  if (different.contains(undecided)) return undecided;
  return different.size() == 1 ? *different.begin() : changed;
}

std::string text(double value, int digits) { return number_text(value, digits); }

std::string text(const Slope& slope) {
  return text(slope.value, 2) +
         (std::isfinite(slope.half_width) ? " ± " + text(slope.half_width, 1) : "");
}

Points::Points(const std::vector<json>& results) {
  // Ids do not name the order of passes.
  using Key = std::tuple<std::string, std::string, std::string, bool>;
  std::set<Key> seen;
  for (const json& result : results) {
    roles.known.merge(ContestantRoles(result).known);  // what is known already stays
    if (result.value("schema", "") == "inextensible-stability/1") {
      for (const json& cell : result.at("matrix")) matrix.push_back(&cell);
      for (const json& mesh : result.at("degrees_of_freedom")) freedom.push_back(&mesh);
      for (const json& frame : result.at("same_frame")) same_frame.push_back(&frame);
      continue;
    }
    const Runs runs(result);
    std::set<Key> here;
    for (const Point& point : runs.points) {
      const Key key(point.id(), point.contestant(), point.sweep(), point.collides_last());
      repeated = repeated || seen.contains(key);
      if (seen.contains(key)) continue;
      here.insert(key);
      all.push_back(point);
      if (!point.collides_last()) contests.push_back(point);
    }
    seen.merge(here);
  }
}

Curve Points::best(const std::string& scene, const std::string& sweep, const std::string& method,
                   const Question& question, std::optional<double> vertices) const {
  const bool strain = sweep == "strain";
  std::vector<Point> chosen;
  std::ranges::copy_if(contests, std::back_inserter(chosen),
                       [&](const Point& p) { return p.scene() == scene && p.sweep() == sweep; });
  if (sweep != "resolution" && !chosen.empty()) {
    const double size =
        vertices ? *vertices : std::ranges::max(chosen, {}, &Point::vertices).vertices();
    std::erase_if(chosen, [size](const Point& p) { return p.vertices() != size; });
  }
  std::map<double, std::map<std::string, std::vector<Point>>> places;  // tight to loose, or by size
  for (const Point& p : chosen) {
    const std::string row = roles.of(p.contestant()).row();
    auto& place = places[strain ? p.strain_limit() : p.vertices()];
    if (row == method || (question.any_stepper && row.starts_with(method + "@")))
      place[p.contestant()].push_back(p);
  }
  Curve curve;
  std::optional<Point> best;
  for (const auto& [place, contestants] : places) {
    if (!strain || !question.tighter) best.reset();
    for (const auto& [unused, here] : contestants) {
      const auto answer = fastest_of(here, question.level);
      if (answer && (!best || answer->seconds() < best->seconds())) best = answer;
    }
    if (best) curve.emplace(place, *best);
  }
  return curve;
}

std::optional<Point> at(const Curve& curve, double x) {
  for (const auto& [key, point] : curve)
    if (std::abs(key / x - 1) < 1e-9) return point;
  return {};
}

std::vector<std::string> ids_of(const std::vector<Curve>& curves) {
  std::vector<std::string> ids;
  for (const Curve& curve : curves)
    for (const auto& [at, point] : curve) ids.push_back(point.id());
  return ids;
}

Verdict at_questions(const std::function<Verdict(const Question&)>& judge) {
  const std::pair<std::string, Verdict> ways[]{
      {"by strain alone", judge({.tighter = true})},
      {"at an error of at most 2 %", judge({.level = headline_error, .tighter = true})},
      {"the same, each method in its best stepper",
       judge({.level = headline_error, .any_stepper = true, .tighter = true})}};
  Verdict all{ways[0].second.verdict, "", {}};
  bool any = false;
  for (const auto& [words, way] : ways) {
    any = any || way.verdict != not_measured;
    append(all.measured,
           words + ": " + way.verdict + (way.measured.empty() ? "" : ", " + way.measured), "; ");
    for (const std::string& id : way.points)
      if (std::ranges::count(all.points, id) == 0) all.points.push_back(id);
  }
  if (!any) all.measured.clear();
  return all;
}

}  // namespace harness::claims

namespace harness {
namespace {

// configs/claims.json has their words and rules.
const std::map<std::string, claims::Judge*> judges{{"C1", claims::chain_time_over_strain},
                                                   {"C2", claims::chain_time_over_resolution},
                                                   {"C3", claims::chain_speed},
                                                   {"C4", claims::springs_stiffness},
                                                   {"C5", claims::drape_time_over_strain},
                                                   {"C6", claims::drape_time_over_resolution},
                                                   {"C7", claims::residual_order},
                                                   {"C8", claims::same_frame},
                                                   {"C9", claims::failure_configurations},
                                                   {"C10", claims::no_drift},
                                                   {"C11", claims::matrix_sizes},
                                                   {"C12", claims::patch_sag},
                                                   {"C13", claims::strain_after_collision},
                                                   {"C14", claims::degrees_of_freedom_left},
                                                   {"C15", claims::shake_small_steps},
                                                   {"C16", claims::garment_slip}};

std::vector<ClaimVerdict> judge_points(const claims::Points& points) {
  const std::string path = source_path("configs/claims.json");
  static const json texts = parse_document(read_file(path, "file of claims"), path);
  std::vector<ClaimVerdict> all;
  for (const json& claim : texts) {
    all.push_back({judges.at(claim.at("id"))(points), claim.at("id"), claim.at("where"),
                   claim.at("statement"), claim.at("rule")});
    if (all.back().verdict == claims::not_measured) all.back().points.clear();
  }
  return all;
}

}  // namespace

void check_timed(const json& result, const std::string& name) {
  if (!is_timed(result))
    throw UsageError(name + " was made with --untimed, so its times are meaningless; leave it out");
}

std::vector<ClaimVerdict> judge_claims(const std::vector<json>& results) try {
  for (const json& result : results) check_timed(result);
  const claims::Points points(results);
  std::vector<ClaimVerdict> all = judge_points(points);
  if (points.repeated) {
    const std::vector<json> reversed(results.rbegin(), results.rend());
    const std::vector<ClaimVerdict> again = judge_points(claims::Points(reversed));
    for (std::size_t i = 0; i < all.size(); ++i) {
      ClaimVerdict& claim = all[i];
      if (claim.verdict == again[i].verdict) continue;
      claim.measured = claim.verdict + " by the first measurement of each run, " +
                       again[i].verdict + " by the last; " + claim.measured;
      claim.verdict = claims::undecided;
    }
  }
  return all;
} catch (const json::exception& error) {
  throw UsageError(std::string("a result file is incomplete: ") + error.what());
}

void print_claims(std::ostream& out, const std::vector<ClaimVerdict>& claims) {
  out << "The paper compares times by strain alone, and so do verdicts; beside them is what holds "
         "at an error of at most 2 %. A 95 %\ninterval that holds a bound leaves a claim "
         "undecided. Of two parts (a) and (b), both: reproduced, one: changed, none: "
         "not\nreproduced.\n\n";
  for (const auto& c : claims) {
    out << c.id << " (" << c.where << "): " << c.statement << "\n  " << c.verdict;
    if (!c.measured.empty()) out << ": " << c.measured;
    out << '\n';
    if (!c.rule.empty()) out << "  rule: " << c.rule << '\n';
    constexpr std::size_t shown = 4;
    for (std::size_t i = 0; i < std::min(shown, c.points.size()); ++i)
      out << (i == 0 ? "  points: " : "          ") << c.points[i] << '\n';
    if (c.points.size() > shown) out << "          and " << c.points.size() - shown << " more\n";
    out << '\n';
  }
}

void print_claims_markdown(std::ostream& out, const std::vector<ClaimVerdict>& claims) {
  out << "| | claim | verdict | measured |\n|---|---|---|---|\n";
  for (const auto& c : claims)
    out << "| " << c.id << ", " << c.where << " | " << c.statement << " | " << c.verdict << " | "
        << c.measured << " |\n";
}

}  // namespace harness
