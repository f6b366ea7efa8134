#include "harness/run/sweep.h"

namespace harness {
namespace {

// Steps between two rungs that halve, by which these are divided: factors of about 1.2, so chosen
// that rates of 25, 50 or 100 steps a second stay whole numbers.
constexpr double refinements[] = {1, 1.2, 1.44, 1.68};

std::vector<double> step_ladder(const SweepSpec& sweep, std::span<const double> divisors) {
  std::vector<double> ladder;
  for (double h = sweep.coarsest; h >= sweep.finest * (1 - 1e-9); h /= 2)
    for (const double divisor : divisors)
      if (h / divisor >= sweep.finest * (1 - 1e-9)) ladder.push_back(h / divisor);
  return ladder;
}

// Adds the rungs that the filters leave; the finer ones only if all that halve are left.
void add_ladder(Search& search, const SweepSpec& sweep, const SweepFilters& filters) {
  const auto kept = [&](std::span<const double> divisors) {
    std::vector<double> ladder = step_ladder(sweep, divisors);
    std::erase_if(ladder, [&](double step) {
      search.base.step = step;
      const std::string id = search.base.id();
      return (filters.include && !filters.include->found_in(id)) ||
             (filters.exclude && filters.exclude->found_in(id));
    });
    return ladder;
  };
  const std::size_t halvings = step_ladder(sweep, {refinements, 1}).size();
  search.ladder = kept({refinements, 1});
  if (search.every_step || !sweep.refine || search.ladder.size() < halvings) return;
  search.ladder = kept(refinements);
  search.stride = std::size(refinements);
}

constexpr double runs_of_a_search = 6;  // as measured, with levels of error down to 1 %
constexpr double runs_of_a_calibration = 6;
// Steps of a search that may be best, at any motion and at levels of error.
constexpr double repeated_of_a_search = 2;
// Over the timed part of a short run: making the solver, and looks at the machine.
constexpr double around_a_run = 1.3;

// Time of a simulated second: the time-out if no step succeeds, 0 if the solver cannot run it.
double seconds_per_second(const Search& search, double step, double timeout) {
  PointSpec spec = search.base;
  spec.step = step;
  const PointResult seen = run_point(spec, {.hopeless = usual_look, .look = true});
  if (seen.status == PointStatus::unsupported) return 0;
  return seen.samples.empty() ? timeout : seen.seconds();
}

}  // namespace

std::vector<Search> plan(const Suite& suite, const SweepFilters& filters) {
  std::vector<Search> searches;
  std::size_t family = 0;
  for (const SweepSpec& sweep : suite.sweeps) {
    const auto type = find_scene(sweep.scene);
    std::vector<double> limits = sweep.limits;
    std::sort(limits.rbegin(), limits.rend());  // loose to tight
    std::vector<int> resolutions = sweep.resolutions;
    std::ranges::sort(resolutions);
    for (const Contestant& contestant : sweep.contestants) {
      if (filters.solver && !matches(*filters.solver, contestant.name)) continue;
      for (const int resolution : resolutions) {
        SceneParameters given = sweep.scene_parameters;
        given[type->resolution] = resolution;
        PointSpec base;
        base.sweep = sweep.sweep;
        base.scene = sweep.scene;
        base.scene_parameters = complete_parameters(*type, given);
        base.resolution = resolution;
        const auto [vertices, constraints] = type->counts(base.scene_parameters);
        base.vertices = vertices;
        base.constraints = constraints;
        base.contestant = contestant.name;
        base.solver = contestant.solver;
        base.seed = suite.seed;
        // Without a limit of its own a solver does the same at all of them.
        const bool limited = find_backend(contestant.solver)->strain_control != StrainControl::none;
        for (const double limit : std::span(limits).first(limited ? limits.size() : 1)) {
          Search search;
          search.base = base;
          search.base.strain_limit = limit;
          search.base.settings = contestant.settings_for(resolution, limit);
          if (const auto options = sweep.solver_options.find(contestant.solver);
              options != sweep.solver_options.end())
            search.base.settings.insert(options->second.begin(), options->second.end());
          search.family = family;
          search.every_step = sweep.every_step || sweep.sweep == "step";
          add_ladder(search, sweep, filters);
          if (!search.ladder.empty()) searches.push_back(std::move(search));
        }
        ++family;
      }
    }
  }
  if (searches.empty())
    throw UsageError("no point is left: the filters exclude every point of the suite");
  return searches;
}

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
    const bool calibrated =
        find_backend(middle.base.solver)->strain_control == StrainControl::stiffness;
    for (const Search* search : members) {
      const auto rungs = static_cast<double>(search->ladder.size());
      const double tried = search->every_step ? rungs : std::min(rungs, runs_of_a_search);
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
