// C1 to C3, C5, C6, C11 and C15: which method is fast, how its time grows, and what its steps take.
#include "harness/claims/claims.h"

namespace harness::claims {
namespace {

std::string count_of(double n) { return text(n, 6); }
std::string vertices_of(double n) { return count_of(n) + " vertices"; }

Answer below(const Slope& slope, double threshold) {
  return above(Slope{-slope.value, slope.half_width, slope.points}, -threshold);
}

Slope slope_of(const Curve& curve) {
  std::vector<double> x, y;
  for (const auto& [at, point] : curve) {
    x.push_back(at);
    y.push_back(point.seconds());
  }
  return log_log_slope(x, y);
}

// Ratios of a's seconds to b's by the value on the axis, where both have a point.
std::vector<std::pair<double, Ratio>> ratios_of(const Curve& a, const Curve& b) {
  std::vector<std::pair<double, Ratio>> ratios;
  for (const auto& [place, point] : a)
    if (const auto other = at(b, place)) ratios.emplace_back(place, ratio(point, *other));
  return ratios;
}

// The slope's interval is the wider of the scatter's and that of the ratios' own intervals.
Slope slope_of(const std::vector<std::pair<double, Ratio>>& ratios) {
  std::vector<double> x, y;
  double mean = 0, squares = 0, spread = 0;
  for (const auto& [place, ratio] : ratios) {
    x.push_back(place);
    y.push_back(ratio.value);
    mean += std::log(place) / static_cast<double>(ratios.size());
  }
  for (const auto& [place, ratio] : ratios) {
    const double distance = std::log(place) - mean;
    const double half_width = ratio.known() ? 0.5 * std::log(ratio.high / ratio.low) : 0;
    squares += distance * distance;
    spread += distance * distance * half_width * half_width;
  }
  Slope slope = log_log_slope(x, y);
  if (squares > 0) slope.half_width = std::max(slope.half_width, std::sqrt(spread) / squares);
  return slope;
}

Verdict growth(const Points& points, const char* sweep,
               Answer (*fast_is_better)(const Slope&, double), std::string (*place)(double)) {
  return at_questions([=, &points](const Question& asked) -> Verdict {
    const Curve springs = points.best("chain", sweep, implicit_springs.name, asked),
                fast = points.best("chain", sweep, fast_projection.name, asked);
    const auto ratios = ratios_of(springs, fast);
    const Slope slope = slope_of(ratios);
    if (slope.points < 3) return {};
    Verdict found{verdict_of(fast_is_better(slope, 0)),
                  "slope of springs' time over fast projection's " + text(slope),
                  ids_of({springs, fast})};
    for (const auto& [x, ratio] : {ratios.front(), ratios.back()})
      found.measured += ", ratio " + text(ratio) + " at " + place(x);
    return found;
  });
}

std::string effort(const Point& p) {
  const auto iterations = static_cast<double>(p.result().work.iterations);
  return text(p.duration() / p.step(), 5) + " steps of " +
         text(iterations / static_cast<double>(p.result().work.steps), 2) + " iterations of " +
         text(1e6 * p.seconds() * p.duration() / iterations, 3) + " us";
}

// "3 of 6 (1 the other way, 2 undecided)".
std::string tally(const std::vector<Answer>& answers) {
  const auto count = [&](Answer one) { return std::to_string(std::ranges::count(answers, one)); };
  return count(Answer::yes) + " of " + std::to_string(answers.size()) +
         (all_of(answers) == Answer::yes ? ""
                                         : " (" + count(Answer::no) + " the other way, " +
                                               count(Answer::open) + " undecided)");
}

// C5 at one size. Strain limiting that was stopped far behind may have no slope at a large size.
Verdict drape_over_strain(const Points& points, const Question& asked, double vertices) {
  const auto curve_of = [&](const PaperMethod& method) {
    return points.best("drape", "strain", method.name, asked, vertices);
  };
  const Curve fast = curve_of(fast_projection);
  const std::vector<Curve> limiting{curve_of(jacobi), curve_of(gauss_seidel)};
  std::vector<Curve> evidence = limiting;
  std::vector<Answer> flatter, fastest;
  std::string slopes;
  for (const PaperMethod& method : {shake, icd, fast_projection}) {
    const Curve curve = curve_of(method);
    if (curve.size() >= 3) {
      append(slopes, std::string(method.words) + " " + text(slope_of(curve)));
      evidence.push_back(curve);
      for (const Curve& other : limiting) {
        const Slope slope = slope_of(ratios_of(other, curve));
        if (slope.points >= 3) flatter.push_back(below(slope, 0));
      }
    }
    if (method.name == fast_projection.name) continue;
    for (const auto& [limit, point] : curve) {
      const auto here = at(fast, limit);
      fastest.push_back(here ? above(ratio(point, *here), 1) : Answer::no);
    }
  }
  if (fast.size() < 3 || flatter.empty() || fastest.empty()) return {};
  return {verdict_of(all_of(flatter), all_of(fastest)),
          vertices_of(vertices) + ": flatter in " + tally(flatter) + " pairs (slopes: " + slopes +
              "), fast projection fastest in " + tally(fastest) + " comparisons",
          ids_of(evidence)};
}

// The steps whose times are too close to the best one's to rank.
struct Steps {
  double best, smallest, largest;  // s

  std::string words() const {
    return step_text(best) + " s" +
           (smallest < largest ? " (" + step_text(smallest) + " to " + step_text(largest) + ")"
                               : "");
  }
};

Steps steps_of(const Points& points, const Point& best, double level) {
  const double step = best.step();
  Steps steps{step, step, step};
  for (const Point& p : points.contests) {
    if (!p.ok() || !p.timed() || p.contestant() != best.contestant() || p.scene() != best.scene() ||
        p.sweep() != best.sweep() || p.vertices() != best.vertices() ||
        p.strain_limit() != best.strain_limit() || !p.within_error(level) ||
        (p.id() != best.id() && above(ratio(p, best), 1) == Answer::yes))
      continue;
    steps.smallest = std::min(steps.smallest, p.step());
    steps.largest = std::max(steps.largest, p.step());
  }
  return steps;
}

Answer smaller(const Steps& a, const Steps& b) {
  if (a.largest < b.smallest) return Answer::yes;
  return a.smallest >= b.largest ? Answer::no : Answer::open;
}

}  // namespace

Verdict chain_time_over_strain(const Points& points) {
  return growth(points, "strain", below, percent);
}

Verdict chain_time_over_resolution(const Points& points) {
  return growth(points, "resolution", above, vertices_of);
}

Verdict chain_speed(const Points& points) {
  return at_questions([&](const Question& asked) -> Verdict {
    const auto at_one_percent = [&](const PaperMethod& method) {
      return at(points.best("chain", "strain", method.name, asked), 0.01);
    };
    const auto springs = at_one_percent(implicit_springs), fast = at_one_percent(fast_projection);
    if (!springs || !fast || springs->vertices() != 80) return {};  // the paper's chain
    const Ratio slower = ratio(*springs, *fast);
    const auto inside = [&](double low, double high) {
      return slower.above(low) && slower.below(high);
    };
    return {inside(12.5, 50)                      ? reproduced
            : inside(1, 12.5) || slower.above(50) ? changed
            : slower.below(1)                     ? not_reproduced
                                                  : undecided,
            "ratio " + text(slower) + ": implicit springs " + effort(*springs) +
                ", fast projection " + effort(*fast) +
                " (the search for a stiffness is not charged)",
            {springs->id(), fast->id()}};
  });
}

Verdict drape_time_over_strain(const Points& points) {
  std::map<double, int, std::greater<>> sizes;
  for (const Point& p : points.contests)
    if (p.scene() == "drape" && p.sweep() == "strain") ++sizes[p.vertices()];
  return at_questions([&](const Question& asked) {
    Verdict found;
    for (const auto& size : sizes)
      if (found.verdict == not_measured) found = drape_over_strain(points, asked, size.first);
    return found;
  });
}

Verdict drape_time_over_resolution(const Points& points) {
  return at_questions([&](const Question& asked) -> Verdict {
    const Curve fast = points.best("drape", "resolution", fast_projection.name, asked);
    std::map<std::string, Curve> others;
    for (const PaperMethod& method : all_paper_methods)
      if (method.name != fast_projection.name)
        others[method.words] = points.best("drape", "resolution", method.name, asked);
    std::string details;
    std::vector<Answer> sizes;
    for (const auto& [vertices, point] : fast) {
      std::vector<Answer> here;
      std::map<double, std::string> rivals;  // by their time over fast projection's
      for (const auto& [words, curve] : others) {
        const auto other = at(curve, vertices);
        if (!other) continue;
        const Ratio slower = ratio(*other, point);
        here.push_back(above(slower, 1));
        rivals.try_emplace(slower.value, words + " takes " + text(slower));
      }
      if (here.empty()) continue;
      sizes.push_back(all_of(here));
      const char* word = sizes.back() == Answer::yes  ? "fastest"
                         : sizes.back() == Answer::no ? "not fastest"
                                                      : "undecided";
      append(details,
             count_of(vertices) + ": " + word + ", " + rivals.begin()->second + " of its time");
    }
    if (fast.size() < 2 || sizes.empty()) return {};
    const Answer all = all_of(sizes), largest = sizes.back();
    return {largest == Answer::yes && all == Answer::no ? changed
            : largest == Answer::yes                    ? verdict_of(all)
                                                        : verdict_of(largest),
            details, ids_of({fast})};
  });
}

Verdict matrix_sizes(const Points& points) {
  Verdict found;
  std::map<double, std::map<std::string, double>> nonzeros;  // by vertices and method
  for (const Point& p : points.all) {
    if (p.scene() != "drape" || !p.ok() || !(p.result().work.factor_nonzeros > 0) ||
        p.result().linear_solver == "projected_cg" ||
        (p.contestant() != fast_projection.name && p.contestant() != icd.name))
      continue;
    double& place = nonzeros[p.vertices()][p.contestant()];
    if (place == 0) found.points.push_back(p.id());
    place = p.result().work.factor_nonzeros;
  }
  bool all = true;
  for (const auto& [vertices, of] : nonzeros) {
    if (of.size() < 2) continue;
    const double ratio = of.at(icd.name) / of.at(fast_projection.name);
    append(found.measured, text(ratio, 2) + " at " + vertices_of(vertices));
    all = all && ratio > 1;
  }
  if (found.measured.empty()) return {};
  found.measured = "nonzeros of ICD's factor over fast projection's: " + found.measured;
  found.verdict = verdict_of(yes_if(all));
  return found;
}

Verdict shake_small_steps(const Points& points) {
  return at_questions([&](const Question& asked) -> Verdict {
    std::vector<Answer> answers;
    std::string details;
    std::vector<std::string> evidence;
    for (const char* sweep : {"strain", "resolution"}) {
      const Curve icd_curve = points.best("drape", sweep, icd.name, asked);
      for (const auto& [place, p] : points.best("drape", sweep, shake.name, asked)) {
        const auto other = at(icd_curve, place);
        if (!other || std::isnan(p.measures().energy_gain) ||
            std::isnan(other->measures().energy_gain))
          continue;
        const Steps steps = steps_of(points, p, asked.level),
                    larger = steps_of(points, *other, asked.level);
        const Ratio times = ratio(*other, p);
        const double by = other->step() / p.step();
        const Ratio costlier{times.value * by, times.low * by, times.high * by};
        answers.push_back(all_of({smaller(steps, larger), above(costlier, 1)}));
        details += "; " + vertices_of(p.vertices()) + " at " + percent(p.strain_limit()) +
                   ": SHAKE " + steps.words() + ", ICD " + larger.words() + ", whose step takes " +
                   text(costlier) + " times as long";
        evidence.insert(evidence.end(), {p.id(), other->id()});
      }
    }
    if (answers.empty()) return {};
    const auto all = static_cast<int>(answers.size()),
               yes = static_cast<int>(std::ranges::count(answers, Answer::yes)),
               no = static_cast<int>(std::ranges::count(answers, Answer::no));
    return {verdict_of_counts(yes, no, all),
            "so at " + std::to_string(yes) + " of " + std::to_string(all) + " places, not so at " +
                std::to_string(no) + details,
            evidence};
  });
}

}  // namespace harness::claims
