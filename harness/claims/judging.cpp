#include "harness/claims/judging.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "harness/analysis/plane.h"
#include "harness/base/text.h"

namespace harness::claims {
Answer above(const Ratio& ratio, double threshold) {
  if (ratio.above(threshold)) return Answer::yes;
  return ratio.below(threshold) ? Answer::no : Answer::open;
}

Answer above(const Slope& slope, double threshold) {
  if (slope.low() > threshold) return Answer::yes;
  return slope.high() < threshold ? Answer::no : Answer::open;
}

Answer below(const Slope& slope, double threshold) {
  const Answer answer = above(slope, threshold);
  return answer == Answer::open ? answer : answer == Answer::yes ? Answer::no : Answer::yes;
}

Answer all_of(const std::vector<Answer>& answers) {
  const auto has = [&](Answer one) {
    return std::find(answers.begin(), answers.end(), one) != answers.end();
  };
  return has(Answer::no) ? Answer::no : has(Answer::open) ? Answer::open : Answer::yes;
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
  std::string common = not_measured;
  bool open = false;
  for (const std::string& verdict : verdicts) {
    if (verdict == not_measured) continue;
    open = open || verdict == undecided;
    if (common == not_measured) common = verdict;
    if (common != verdict) common = changed;
  }
  return open ? undecided : common;
}

std::string text(double value, int digits) { return number_text(value, digits); }

std::string text(const Slope& slope) {
  return text(slope.value, 2) +
         (std::isfinite(slope.half_width) ? " ± " + text(slope.half_width, 1) : "");
}

using nlohmann::json;

Points::Points(const std::vector<json>& results) {
  // Ids do not name the order of passes.
  using Key = std::tuple<std::string, std::string, std::string, bool>;
  std::set<Key> seen;
  for (const json& result : results) {
    roles_.add(ContestantRoles(result));
    if (result.value("schema", "") == "inextensible-stability/1") {
      for (const json& cell : result.at("matrix")) matrix_.push_back(&cell);
      for (const json& mesh : result.at("degrees_of_freedom")) freedom_.push_back(&mesh);
      if (const auto frames = result.find("same_frame"); frames != result.end()) {
        for (const json& frame : *frames) same_frame_.push_back(&frame);
      }
      continue;
    }
    std::set<Key> here;
    for (const json& p : result.at("points")) {
      const Point point(p, pair_noise_of(result));
      if (point.flag("adaptive")) continue;
      const Key key(point.id(), point.contestant(), point.text("sweep"), point.collides_last());
      repeated_ = repeated_ || seen.contains(key);
      if (seen.contains(key)) continue;
      here.insert(key);
      all_.push_back(point);
    }
    seen.merge(here);
  }
  for (const Point& p : all_)
    sizes_[{p.text("scene"), p.text("sweep")}].insert(p.number("vertices"));
}

std::vector<Point> Points::where(const Filter& wanted) const {
  std::vector<Point> chosen;
  std::copy_if(all_.begin(), all_.end(), std::back_inserter(chosen), wanted);
  return chosen;
}

const json* Points::cell(const std::string& hard_case, const std::string& solver) const {
  const auto place = std::find_if(matrix_.begin(), matrix_.end(), [&](const json* c) {
    return c->at("case") == hard_case && c->at("solver") == solver;
  });
  return place == matrix_.end() ? nullptr : *place;
}

namespace {

void keep_faster(Curve& curve, double x, const Point& point) {
  const auto [place, added] = curve.try_emplace(x, point);
  if (!added && point.seconds() < place->second.seconds()) place->second = point;
}

}  // namespace

Curve Points::best(const std::string& scene, const std::string& sweep,
                   const std::string& contestant, double level,
                   std::optional<double> vertices) const {
  const char* axis = sweep == "strain" ? "strain_limit" : "vertices";
  std::map<std::pair<double, std::string>, std::vector<const Point*>> places;
  for (const Point& p : all_) {
    if (of(p, scene, sweep, vertices) && roles_.at_any_settings(p.contestant()) == contestant)
      places[{p.number(axis), p.contestant()}].push_back(&p);
  }
  Curve curve;
  for (const auto& [place, points] : places) {
    if (const Point* answer = fastest_of(points, level)) keep_faster(curve, place.first, *answer);
  }
  return curve;
}

Curve Points::best_at_errors(const std::string& scene, const std::string& contestant) const {
  Curve curve;
  for (const Point& p : where([&](const Point& q) {
         return of(q, scene, "step") && roles_.at_any_settings(q.contestant()) == contestant &&
                q.ok() && q.timed();
       })) {
    for (const double level : error_levels) {
      if (p.within_error(level)) keep_faster(curve, level, p);
    }
  }
  return curve;
}

std::vector<Role> Points::ranked(const std::string& scene, const std::string& sweep,
                                 std::optional<double> vertices) const {
  std::vector<Role> all;
  std::set<std::string> seen;
  for (const Point& p : where([&](const Point& q) { return of(q, scene, sweep, vertices); })) {
    if (!seen.insert(p.contestant()).second) continue;
    if (const Role one = about(p.contestant()); one.ranked()) all.push_back(one);
  }
  return all;
}

std::vector<double> Points::sizes(const std::string& scene, const std::string& sweep) const {
  const auto known = sizes_.find({scene, sweep});
  if (known == sizes_.end()) return {};
  return {known->second.begin(), known->second.end()};
}

// Strain and step sweeps of several sizes may come together: unless one is named, the largest
// counts.
bool Points::of(const Point& point, const std::string& scene, const std::string& sweep,
                std::optional<double> vertices) const {
  if (!point.is("scene", scene) || !point.is("sweep", sweep)) return false;
  return sweep == "resolution" ||
         point.number("vertices") == vertices.value_or(*sizes_.at({scene, sweep}).begin());
}

Slope slope_of(const Curve& curve) {
  std::vector<double> x, y;
  for (const auto& [at, point] : curve) {
    x.push_back(at);
    y.push_back(point.seconds());
  }
  return log_log_slope(x, y);
}

Slope slope_of_ratio(const Curve& a, const Curve& b) {
  std::vector<double> x, y, half_widths;
  for (const auto& [place, point] : a) {
    const auto other = at(b, place);
    if (!other) continue;
    const Ratio over = ratio(point, *other);
    x.push_back(place);
    y.push_back(over.value);
    half_widths.push_back(over.known() ? 0.5 * std::log(over.high / over.low) : 0);
  }
  Slope slope = log_log_slope(x, y);
  double mean = 0, squares = 0, spread = 0;
  for (const double at : x) mean += std::log(at) / static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double distance = std::log(x[i]) - mean;
    squares += distance * distance;
    spread += distance * distance * half_widths[i] * half_widths[i];
  }
  if (squares > 0) slope.half_width = std::max(slope.half_width, std::sqrt(spread) / squares);
  return slope;
}

void cite(ClaimVerdict& claim, const Curve& curve) {
  for (const auto& [at, point] : curve) claim.points.push_back(point.id());
}

std::optional<Point> at(const Curve& curve, double x) {
  for (const auto& [key, point] : curve) {
    if (std::abs(key / x - 1) < 1e-9) return point;
  }
  return {};
}

void Ways::add(const std::string& words, const std::string& verdict, const std::string& measured,
               const std::vector<Curve>& evidence) {
  claim_.measured += (verdicts_.empty() ? "" : "; ") + words + ": " + verdict +
                     (measured.empty() ? "" : ", " + measured);
  verdicts_.push_back(verdict);
  if (verdict == not_measured) return;
  for (const Curve& curve : evidence) {
    for (const auto& entry : curve) {
      const std::string id = entry.second.id();
      if (std::find(claim_.points.begin(), claim_.points.end(), id) == claim_.points.end())
        claim_.points.push_back(id);
    }
  }
}

Ways::~Ways() {
  const bool none = std::all_of(verdicts_.begin(), verdicts_.end(),
                                [](const std::string& verdict) { return verdict == not_measured; });
  if (none) claim_.measured.clear();
  if (!verdicts_.empty()) claim_.verdict = verdicts_.front();
}

}  // namespace harness::claims
