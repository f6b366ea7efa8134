#include "harness/run/estimate.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/run/screening.h"
#include "harness/run/sweep.h"

namespace harness {
namespace {

constexpr double runs_of_a_search = 6;  // as measured, with levels of error down to 1 %
constexpr double runs_of_a_calibration = 6;
// Steps whose samples tell which is best, of a search, at any motion and at levels of error.
constexpr double repeated_of_a_search = 2;
// Over the timed part of a short run: making the solver, and looks at the machine.
constexpr double around_a_run = 1.3;

// Time of simulating a second; the time-out where no step is taken, nothing where the solver does
// not take the problem.
double seconds_per_second(const Search& search, double step, double timeout) {
  PointSpec spec = search.base;
  spec.step = step;
  const PointResult seen = screen_point(spec, {.hopeless = usual_look});
  if (seen.status == PointStatus::unsupported) return 0;
  return seen.samples.empty() ? timeout : seen.seconds();
}

}  // namespace

Estimate estimate(const Suite& suite, const std::vector<Search>& searches) {
  std::map<std::size_t, std::vector<const Search*>> families;
  for (const Search& search : searches) families[search.family].push_back(&search);
  Estimate result;
  for (const auto& [family, members] : families) {
    const Search& middle = *members[members.size() / 2];
    const double step = middle.ladder[middle.ladder.size() / 2];
    const double duration = middle.base.scene_parameters.at("duration");
    const double run =
        std::min(duration * seconds_per_second(middle, step, suite.timeout), suite.timeout);
    const auto* backend = inextensible::find_backend(middle.base.solver);
    const bool calibrated =
        backend && backend->strain_control == inextensible::StrainControl::stiffness;
    for (const Search* search : members) {
      const double tried = search->every_step ? static_cast<double>(search->ladder.size())
                                              : std::min(static_cast<double>(search->ladder.size()),
                                                         runs_of_a_search);
      const double repeated = search->base.sweep == "step" ? tried : repeated_of_a_search;
      const double sample = std::max(run, around_a_run * least_sample);
      result.seconds += run * tried * (calibrated ? runs_of_a_calibration : 1) +
                        (run < least_sample ? tried * sample : 0) +
                        repeated * std::min(sample * (suite.reps - 1), repeat_for);
    }
    ++result.timed;
  }
  return result;
}

}  // namespace harness
