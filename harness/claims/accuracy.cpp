#include "harness/claims/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/analysis/paper_methods.h"
#include "harness/base/errors.h"

namespace harness::claims {

namespace {

// Of a run's sampled steps that took a second iteration: in the others the last is the first.
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

// Of one scene of the stability sweep's direct comparison.
struct Frames {
  bool touched = false;           // there is a contact; else all of the run is after it
  double before = 0;              // largest distance of a vertex up to first contact
  Answer together = Answer::yes;  // after it
  double rms = 0, spread = 0;     // the largest RMS distance above `alike`, and how far equal runs
                                  // are apart then
};

std::optional<Frames> frames_of(const nlohmann::json& entry) {
  const auto numbers = [](const nlohmann::json& list) { return list.get<std::vector<double>>(); };
  if (!entry.value("stopped", "").empty()) return {};
  const bool touched = entry.at("first_contact").is_number();
  const double contact = touched ? entry.at("first_contact").get<double>() : 0;
  const auto times = numbers(entry.at("times"));
  const auto rms = numbers(entry.at("icd").at("rms")),
             largest = numbers(entry.at("icd").at("largest")),
             moved = numbers(entry.at("moved_start").at("rms"));
  for (const auto* list : {&rms, &largest, &moved}) {
    if (list->size() != times.size())
      throw UsageError("same_frame: " + std::to_string(times.size()) + " times, but " +
                       std::to_string(list->size()) + " distances");
  }
  Frames frames;
  frames.touched = touched;
  double spread = 0;  // paths that have parted do not find together again: the largest so far
  for (std::size_t i = 0; i < times.size(); ++i) {
    spread = std::max(spread, moved[i]);
    if (times[i] < contact) {
      frames.before = std::max(frames.before, largest[i]);
    } else if (rms[i] > alike && rms[i] > 2 * spread) {
      const bool far = rms[i] > 2 * alike && rms[i] > 4 * spread;
      if (far || frames.together == Answer::yes) frames.together = far ? Answer::no : Answer::open;
      if (rms[i] > frames.rms) {
        frames.rms = rms[i];
        frames.spread = spread;
      }
    }
  }
  return frames;
}

}  // namespace

void same_frame(const Points& points, ClaimVerdict& c) {
  c.rule =
      "fast projection and ICD side by side at one step and limit (stability sweep); (a) before "
      "the cloth touches the sphere no vertex is 1 % of the cloth's size or more apart, (b) "
      "afterwards the RMS distance stays below 1 %, or below twice what fast projection is away "
      "from itself after its start was moved by 1e-10 (not so: above 2 % and four times; between: "
      "open); the drape alone: both reproduced, one changed, none not reproduced; undecided if "
      "open";
  std::vector<Answer> before, after;
  for (const nlohmann::json* entry : points.same_frame()) {
    const auto frames = frames_of(*entry);
    if (!frames || !entry->at("scene").get<std::string>().starts_with("drape")) continue;
    if (frames->touched) before.push_back(frames->before < alike ? Answer::yes : Answer::no);
    after.push_back(frames->together);
    const std::string scene = entry->at("scene");
    c.measured +=
        (c.measured.empty() ? "" : "; ") + scene + ": " +
        (frames->touched ? "before contact at most " + percent(frames->before) + " apart, after it "
                         : "without contact ") +
        (frames->together == Answer::yes
             ? "as close as the rule asks"
             : "RMS up to " + percent(frames->rms) + ", where equal runs are " +
                   percent(frames->spread) + " apart");
    c.points.push_back("same_frame/" + scene);
  }
  if (!before.empty()) c.verdict = verdict_of(all_of(before), all_of(after));
}

void strain_after_collision(const Points& points, ClaimVerdict& c) {
  c.rule =
      "best points of the drape's strain sweep, every tuned contestant at every limit: its largest "
      "strain after the collision filter is at most 1.5 times the limit; reproduced if so of all, "
      "changed if of half of them or more, else not reproduced (strains repeat exactly, without "
      "noise)";
  int all = 0, kept = 0;
  for (const Role& one : points.ranked("drape", "strain")) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const auto& [limit, p] : points.best("drape", "strain", one.name)) {
      const double after = p.delivered_strain();
      if (!std::isfinite(after)) continue;
      least = std::min(least, after);
      most = std::max(most, after);
      ++all;
      kept += after <= 1.5 * limit ? 1 : 0;
      c.points.push_back(p.id());
    }
    if (most == 0) continue;
    c.measured += (c.measured.empty() ? "" : ", ") + one.name + " " + percent(least) +
                  (most > least ? " to " + percent(most) : "");
  }
  if (all == 0) return;
  c.measured = "so at " + std::to_string(kept) + " of " + std::to_string(all) +
               " points; largest strain after collision, over all limits: " + c.measured;
  c.verdict = kept == all ? reproduced : 2 * kept >= all ? changed : not_reproduced;
}

}  // namespace harness::claims
