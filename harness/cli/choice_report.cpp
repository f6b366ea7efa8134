#include "harness/cli/choice_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/analysis/words.h"
#include "harness/base/text.h"
#include "harness/points/point_json.h"

namespace harness {
namespace {

using nlohmann::json;

std::string ms(double seconds) { return number_text(1e3 * seconds, 3); }

std::string error_text(double error) {
  return std::isnan(error) ? "error unknown" : "error " + analysis::percent(error);
}

std::string pick_text(const Pick& pick, double rate) {
  const PointSpec& spec = pick.point->spec;
  return spec.name() + " at " + step_text(spec.step) + " s (" +
         std::to_string(std::lround(1 / (rate * spec.step))) +
         " a frame): " + ms(pick.frame.median) + " ms a frame, 99 % below " + ms(pick.frame.slow) +
         ", worst " + ms(pick.frame.worst) + "; strain " +
         analysis::percent(pick.point->measures.max_strain) + ", " + error_text(pick.error);
}

json pick_json(const std::optional<Pick>& pick) {
  if (!pick) return nullptr;
  const PointSpec& spec = pick->point->spec;
  return {
      {"solver", spec.solver},
      {"settings", to_json(spec.settings)},
      {"step", spec.step},
      {"frame_seconds",
       {{"median", pick->frame.median}, {"p99", pick->frame.slow}, {"worst", pick->frame.worst}}},
      {"seconds_per_simulated_second", pick->point->seconds()},
      {"max_strain", number(pick->point->measures.max_strain)},
      {"error", number(pick->error)}};
}

// s of computing time a frame: the one that was given, or what the best run takes.
double budget_of(const Wish& wish, const Recommendation& found) {
  return wish.budget > 0 ? wish.budget : found.best ? found.best->frame.slow : 0;
}

// Contestants without a run to take, and why.
std::map<std::string, std::string> all_why_not(const ChoiceReport& report) {
  std::map<std::string, std::string> all;
  for (const PointResult& screened : report.trials.screened) {
    const std::string& name = screened.spec.name();
    if (std::string why = why_not(name, report.trials, report.wish); !why.empty())
      all.emplace(name, std::move(why));
  }
  return all;
}

void print_scene(std::ostream& out, const ChoiceReport& report) {
  const auto& [sweep, wish, trials, seconds, reference] = report;
  std::set<std::string> tried;
  for (const PointResult& point : trials.points) tried.insert(point.spec.name());
  out << analysis::scene_words(sweep.scene) << ", " << trials.screened.front().spec.vertices
      << " vertices, " << analysis::percent(sweep.limits.front()) << " strain, "
      << (std::isfinite(wish.error) ? "motion error at most " + analysis::percent(wish.error)
                                    : std::string("any motion"))
      << ": " << tried.size() << " of " << trials.screened.size() << " solvers tried in "
      << duration_text(seconds) << '\n';
}

void print_nothing_found(std::ostream& out, const Trials& trials) {
  const bool ended = std::any_of(trials.points.begin(), trials.points.end(),
                                 [](const PointResult& p) { return p.ok(); });
  if (trials.complete) {
    out << "no solver meets limit and error: a larger --error or --limit may be met\n";
  } else if (ended) {
    out << "no run that ended in this time meets limit and error: give more --seconds, or a larger "
           "--error\n";
  } else {
    out << "no run ended within its strain limit in this time: give more --seconds, or a smaller "
           "--n\n";
  }
}

void print_found(std::ostream& out, const Recommendation& found, const Wish& wish) {
  const std::string budget = "the budget of " + ms(wish.budget) + " ms";
  if (!found.to_be_taken())
    out << "no solver that was tried keeps " << budget << "; the fastest within limit and error:\n";
  out << (found.to_be_taken() ? "take  " : "best  ") << pick_text(*found.best, wish.rate) << '\n';
  if (found.budget == Kept::half)
    out << "1 % of its frames or more take longer than " << budget << '\n';
  if (!found.next) return;
  const Ratio ratio = ratio_of_times(found.next->point->samples, found.best->point->samples);
  out << "next  " << pick_text(*found.next, wish.rate) << "; "
      << (ratio.above(1)   ? analysis::text(ratio) + " times as long"
          : ratio.below(1) ? "faster, with slower frames"
                           : "too close to rank")
      << '\n';
}

void print_other_budgets(std::ostream& out, const std::vector<PointResult>& points,
                         const Wish& wish, double budget) {
  const auto with = [&](double seconds) {
    const auto pick = most_accurate(points, wish, seconds);
    return ms(seconds) + " ms a frame: " +
           (pick ? pick->point->spec.name() + " at " + step_text(pick->point->spec.step) + " s, " +
                       error_text(pick->error)
                 : std::string("none that was tried"));
  };
  out << "with  " << with(budget / 2) << "; with " << with(budget * 2) << '\n';
}

}  // namespace

void print(std::ostream& out, const ChoiceReport& report) {
  const auto& [sweep, wish, trials, seconds, reference] = report;
  print_scene(out, report);
  const Recommendation found = recommend(trials.points, wish);
  if (found.best) {
    print_found(out, found, wish);
    print_other_budgets(out, trials.points, wish, budget_of(wish, found));
  } else {
    print_nothing_found(out, trials);
  }
  for (const auto& [name, why] : all_why_not(report))
    out << "not   " << name << ": " << why << '\n';
}

json to_json(const ChoiceReport& report) {
  const auto& [sweep, wish, trials, seconds, reference] = report;
  const Recommendation found = recommend(trials.points, wish);
  const double budget = budget_of(wish, found);
  return {{"scene", sweep.scene},
          {"scene_parameters", sweep.scene_parameters},
          {"strain_limit", sweep.limits.front()},
          {"error", number(wish.error)},
          {"frame", 1 / wish.rate},
          {"budget", budget},
          {"budget_kept", found.all_is_well()},
          {"take", pick_json(found.to_be_taken() ? found.best : std::nullopt)},
          {"fastest", pick_json(found.best)},
          {"runner_up", pick_json(found.next)},
          {"half_budget", pick_json(most_accurate(trials.points, wish, budget / 2))},
          {"double_budget", pick_json(most_accurate(trials.points, wish, budget * 2))},
          {"without_result", all_why_not(report)},
          {"reference", reference.empty() ? json() : json(reference)},
          {"measured_seconds", seconds}};
}

}  // namespace harness
