// C7, C8, C12, C13 and C16: residuals, shapes and strains.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/analysis/words.h"
#include "harness/base/errors.h"
#include "harness/claims/judging.h"

namespace harness::claims {
namespace {

// Sampled steps that took a second iteration; in the others the last is the first.
struct Residuals {
  int samples = 0;
  double first = 0, last = 0, change = 0;  // means, m
};

Residuals iterated(const Point& p) {
  Residuals sums;
  const auto& error = p.document().at("error");
  const auto series = error.find("residuals");
  if (series == error.end() || !series->is_array()) return sums;
  for (const auto& sample : *series) {
    if (!sample.at(1).is_number() || !sample.at(2).is_number()) continue;
    const double first = sample.at(1), last = sample.at(2);
    if (last == first) continue;
    ++sums.samples;
    sums.first += first;
    sums.last += last;
    sums.change += std::abs(last - first);
  }
  const double n = std::max(1, sums.samples);
  return {sums.samples, sums.first / n, sums.last / n, sums.change / n};
}

// Over the step, at the tightest limit that has four steps with enough samples.
struct Orders {
  Slope first, change_over_first;
  double largest = 0;  // last over first
  std::string limit;
  std::vector<std::string> ids;
};

std::optional<Orders> orders_of(const Points& points, const char* scene) {
  constexpr int enough = 10;  // samples of a run
  std::map<double, std::map<double, Point>> by_limit;
  for (const Point& p : points.where([&](const Point& q) {
         return q.is("scene", scene) && q.is("sweep", "step") &&
                q.contestant() == fast_projection.name && q.ok() && iterated(q).samples >= enough;
       }))
    by_limit[p.number("strain_limit")].try_emplace(p.number("step"), p);
  for (const auto& [limit, by_step] : by_limit) {
    if (by_step.size() < 4) continue;
    std::vector<double> h, first, change;
    Orders orders;
    for (const auto& [step, p] : by_step) {
      const Residuals here = iterated(p);
      h.push_back(step);
      first.push_back(here.first);
      change.push_back(here.change / here.first);
      orders.largest = std::max(orders.largest, here.last / here.first);
      orders.ids.push_back(p.id());
    }
    orders.first = log_log_slope(h, first);
    orders.change_over_first = log_log_slope(h, change);
    orders.limit = percent(limit);
    return orders;
  }
  return {};
}

}  // namespace

void residual_order(const Points& points, ClaimVerdict& c) {
  c.rule =
      "sampled steps of step sweeps that took two iterations or more, at the tightest limit with "
      "four steps that have ten of them each; (a) the residual after the first iteration is of "
      "second order: its log-log slope over h lies above 1.5, (b) what later iterations change is "
      "of higher order: its slope is larger than the first's; each with its whole 95 % interval "
      "and "
      "in every scene that has them; both: reproduced, one: changed, none: not reproduced, "
      "undecided if an interval holds a bound";
  std::vector<Answer> order, later;
  for (const char* scene : {"chain", "drape"}) {
    const auto found = orders_of(points, scene);
    if (!found) continue;
    order.push_back(above(found->first, 1.5));
    later.push_back(above(found->change_over_first, 0));
    c.measured += (c.measured.empty() ? "" : "; ") + std::string(scene) + " at " + found->limit +
                  ": slope of the first " + text(found->first) + ", of the change over the first " +
                  text(found->change_over_first) + ", last over first at most " +
                  text(found->largest, 2);
    c.points.insert(c.points.end(), found->ids.begin(), found->ids.end());
  }
  if (!order.empty()) c.verdict = verdict_of(all_of(order), all_of(later));
}

namespace {

constexpr double alike = 0.01;  // of the cloth's size: a viewer sees no difference

// A run of an ensemble may be three standard deviations off its mean, and the difference of two
// runs has sqrt(2) times the deviation of one.
const double deviations_of_a_difference = 3 * std::sqrt(2);

// One scene of the stability sweep's frame-by-frame comparison.
struct Frames {
  double before = 0;  // largest distance of a vertex up to first contact
  double beyond = 0;  // after it: difference of a shape statistic beyond the ensemble's, largest
  std::string which;  // statistic and time of that
  Answer together() const {
    return beyond < alike ? Answer::yes : beyond > 2 * alike ? Answer::no : Answer::open;
  }
};

// None where a run stopped, without contact, and without an ensemble to tell how far runs come
// apart that are all right.
std::optional<Frames> frames_of(const nlohmann::json& entry) {
  if (!entry.value("stopped", "").empty() || !entry.at("first_contact").is_number()) return {};
  const nlohmann::json deviations = entry.value("ensemble_deviation", nlohmann::json::object());
  const nlohmann::json& differences = entry.at("icd");
  const double contact = entry.at("first_contact");
  const auto times = entry.at("times").get<std::vector<double>>();
  const auto check_length = [&times](const nlohmann::json& list) {
    if (list.size() != times.size())
      throw UsageError("same_frame: " + std::to_string(times.size()) + " times, but " +
                       std::to_string(list.size()) + " distances");
  };
  Frames frames;
  check_length(differences.at("largest"));
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] < contact)
      frames.before = std::max(frames.before, differences.at("largest")[i].get<double>());
  }
  bool known = false;
  for (const auto& [statistic, list] : deviations.items()) {
    check_length(list);
    check_length(differences.at(statistic));
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] < contact || !list[i].is_number()) continue;
      known = true;
      const double beyond = differences.at(statistic)[i].get<double>() -
                            deviations_of_a_difference * list[i].get<double>();
      if (beyond <= frames.beyond) continue;
      frames.beyond = beyond;
      frames.which = statistic + " at " + text(times[i], 3) + " s";
    }
  }
  return known ? std::optional(frames) : std::nullopt;
}

}  // namespace

void same_frame(const Points& points, ClaimVerdict& c) {
  c.rule =
      "fast projection and ICD side by side at one step and limit (stability sweep), the drape "
      "alone; (a) before the cloth touches the sphere no vertex is 1 % of the cloth's size or more "
      "apart, (b) afterwards potential energy, kinetic energy, corner height and shadow differ by "
      "less than 1 % beyond what two runs of the reference's ensemble may (three standard "
      "deviations of a difference; not so: by more than 2 %; between: open); both: reproduced, "
      "one: changed, none: not reproduced, undecided if open";
  std::vector<Answer> before, after;
  for (const nlohmann::json* entry : points.same_frame()) {
    const std::string scene = entry->at("scene");
    if (!scene.starts_with("drape")) continue;
    const auto frames = frames_of(*entry);
    if (!frames) continue;
    before.push_back(frames->before < alike ? Answer::yes : Answer::no);
    after.push_back(frames->together());
    c.measured += (c.measured.empty() ? "" : "; ") + scene + ": before contact at most " +
                  percent(frames->before) + " apart, after it " +
                  (frames->which.empty() ? "nowhere beyond the ensemble's spread"
                                         : frames->which + " by " + percent(frames->beyond) +
                                               " beyond the ensemble's spread");
    c.points.push_back("same_frame/" + scene);
  }
  if (!before.empty()) c.verdict = verdict_of(all_of(before), all_of(after));
}

void strain_after_collision(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the drape in the paper's order, the collision filter last (contact 0): of every ranked "
      "contestant the best point of each limit and size. Its largest strain after that filter is "
      "at most 1.5 times the limit; reproduced if so of all, changed if of most, not reproduced if "
      "not of most, undecided if of half of them (strains repeat exactly, without noise)";
  int all = 0, kept = 0;
  std::map<std::string, std::pair<double, double>> over_limit;  // least and most, by contestant
  for (const Point& p : points.where([&](const Point& q) {
         return q.is("scene", "drape") && q.collides_last() && q.ok() && q.flag("best") &&
                points.about(q.contestant()).ranked();
       })) {
    const double after = p.delivered_strain();
    if (!std::isfinite(after)) continue;
    const double over = after / p.number("strain_limit");
    const auto place = over_limit.try_emplace(p.contestant(), over, over).first;
    place->second.first = std::min(place->second.first, over);
    place->second.second = std::max(place->second.second, over);
    ++all;
    kept += over <= 1.5 ? 1 : 0;
    c.points.push_back(p.id());
  }
  if (all == 0) return;
  for (const auto& [name, range] : over_limit)
    c.measured += (c.measured.empty() ? "" : ", ") + name + " " + text(range.first) +
                  (range.second > range.first ? " to " + text(range.second) : "");
  c.measured = "so at " + std::to_string(kept) + " of " + std::to_string(all) +
               " points; largest strain after collision over its limit: " + c.measured;
  c.verdict = verdict_of_counts(kept, all - kept, all);
}

namespace {

constexpr double visible = 0.01;  // of the patch's side

}  // namespace

double parabola_sag(double length, double strain) {
  // Over the length, with a = 4 sag / length: (sqrt(1 + a^2) + asinh(a) / a) / 2.
  const auto arc = [](double a) {
    return a > 0 ? 0.5 * (std::sqrt(1 + a * a) + std::asinh(a) / a) : 1;
  };
  double low = 0, high = 4 * (1 + strain);  // the arc is longer than a / 2
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (arc(middle) < 1 + strain ? low : high) = middle;
  }
  return 0.25 * length * low;
}

void patch_sag(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the hung patch, each of the paper's methods at its best step, mean over the last of three "
      "seconds: how much lower the middle of its lower edge hangs at 10 % than at 1 %, and there "
      "than at 0.1 %; reproduced if both are at least 1 % of the side for every method that has "
      "all three, not reproduced if for none, else changed";
  const auto hangs = [](const Point& p) {
    return p.document().at("sag").at("lower_edge").get<double>() / p.scene_parameter("side");
  };
  std::vector<std::string> verdicts;
  for (const PaperMethod& method : all_paper_methods) {
    const Curve best = points.best("hung_patch", "strain", method.name);
    cite(c, best);
    const auto loose = at(best, 0.1), middle = at(best, 0.01), tight = at(best, 0.001);
    if (!loose || !middle || !tight) continue;
    const double first = hangs(*loose) - hangs(*middle), second = hangs(*middle) - hangs(*tight);
    verdicts.push_back(first >= visible && second >= visible ? reproduced : not_reproduced);
    c.measured += (c.measured.empty() ? "lower by " : ", ") + percent(first) + " and " +
                  percent(second) + " of the side with " + method.words;
  }
  c.verdict = verdict_of_all(verdicts);
}

Slip slip_of(const Point& point) {
  const nlohmann::json& sag = point.document().at("sag");
  const double drop = point.scene_parameter("drop");
  const double rim = sag.at("rim").get<double>(), across = sag.at("rim_across").get<double>();
  return {std::min(rim, across) / drop, std::max(rim, across) / drop};
}

void garment_slip(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the garment, each of the paper's methods at its best step, mean over the last third of the "
      "run: its rim is to stay above the body's hips at 1 %, and to be below them at 10 %; "
      "reproduced if so with every method that has both, not reproduced if with none, else changed";
  std::vector<std::string> verdicts;
  for (const PaperMethod& method : all_paper_methods) {
    const Curve best = points.best("garment", "strain", method.name);
    cite(c, best);
    const auto loose = at(best, 0.1), tight = at(best, 0.01);
    if (!loose || !tight) continue;
    const Slip slides = slip_of(*loose), stays = slip_of(*tight);
    verdicts.push_back(stays.held() && slides.past() ? reproduced : not_reproduced);
    c.measured += (c.measured.empty() ? "rim below the waist, of the way to the hips: " : "; ") +
                  std::string(method.words) + " " + percent(stays.most) + " at 1 %, " +
                  percent(slides.least) + " at 10 %";
  }
  c.verdict = verdict_of_all(verdicts);
}

}  // namespace harness::claims
