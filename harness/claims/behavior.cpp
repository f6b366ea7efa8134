// C4, C7 to C10, C12 to C14 and C16: what works at all, residuals, shapes and strains.
#include "harness/claims/claims.h"

namespace harness::claims {
namespace {

// Over sampled steps with a second iteration; in others the first residual is the last one, too.
struct Residuals {
  int samples = 0;
  double first = 0, last = 0, change = 0;  // means, m
};

Residuals iterated(const Point& p) {
  Residuals sums;
  for (const auto& [time, first, last] : p.measures().residuals) {
    if (!std::isfinite(first) || !std::isfinite(last) || last == first) continue;
    ++sums.samples;
    sums.first += first;
    sums.last += last;
    sums.change += std::abs(last - first);
  }
  const double n = std::max(1, sums.samples);
  return {sums.samples, sums.first / n, sums.last / n, sums.change / n};
}

// A viewer sees no difference below it: root mean square distance over the cloth's size.
constexpr double alike = 0.02;

struct Frames {
  double before = 0;  // largest distance of any vertex up to first contact
  double after = 0;   // largest root mean square distance after it
};

// None if a run stopped or had no contact.
std::optional<Frames> frames_of(const json& entry) {
  if (!entry.value("stopped", "").empty() || !entry.at("first_contact").is_number()) return {};
  const double contact = entry.at("first_contact");
  const auto times = entry.at("times").get<std::vector<double>>();
  const auto rms = entry.at("icd").at("rms").get<std::vector<double>>(),
             largest = entry.at("icd").at("largest").get<std::vector<double>>();
  if (rms.size() != times.size() || largest.size() != times.size())
    throw UsageError("same_frame: times and distances differ in number");
  Frames frames;
  for (std::size_t i = 0; i < times.size(); ++i) {
    double& most = times[i] < contact ? frames.before : frames.after;
    most = std::max(most, times[i] < contact ? largest[i] : rms[i]);
  }
  return frames;
}

// Judges a method by its best points at all the limits.
using OfMethod = std::pair<bool, std::string>(const std::vector<Point>&, const char* words);

Verdict by_method(const Points& points, const char* scene, const std::vector<double>& limits,
                  OfMethod* judge, const char* before, const char* separator) {
  Verdict found;
  std::vector<std::string> verdicts;
  for (const PaperMethod& method : all_paper_methods) {
    const Curve best = points.best(scene, "strain", method.name);
    for (const std::string& id : ids_of({best})) found.points.push_back(id);
    std::vector<Point> here;
    for (const double limit : limits)
      if (const auto point = at(best, limit)) here.push_back(*point);
    if (here.size() < limits.size()) continue;
    const auto [so, words] = judge(here, method.words);
    verdicts.push_back(verdict_of(yes_if(so)));
    found.measured += (found.measured.empty() ? before : separator) + words;
  }
  found.verdict = verdict_of_all(verdicts);
  return found;
}

// The tension of a calibrated point, EA x strain, over the weight that hangs on a strand: all of a
// chain's, and a square cloth's divided by its numbers of rows and columns.
double tension_over_weight(const Point& p) {
  const double strands = p.scene() == "chain" ? 1 : 2 * std::sqrt(p.vertices());
  return p.stiffness() * p.measures().max_strain * strands /
         (p.scene_parameter("mass") * p.scene_parameter("gravity"));
}

constexpr double calibration_tolerance = 0.85;  // of the limit, the least strain that meets it

bool calibrated(const Point& p) {
  return p.contestant() == implicit_springs.name && p.ok() && p.sweep() == "strain" &&
         std::isfinite(p.stiffness()) && std::isfinite(tension_over_weight(p)) &&
         p.measures().max_strain >= 0.999 * calibration_tolerance * p.strain_limit();
}

}  // namespace

Verdict residual_order(const Points& points) {
  Verdict found;
  std::vector<Answer> order, later;
  constexpr int enough = 10;  // samples of a run
  for (const char* scene : {"chain", "drape"}) {
    std::map<double, std::map<double, Point>> by_limit;
    for (const Point& p : points.all)
      if (p.scene() == scene && p.sweep() == "step" && p.ok() &&
          p.contestant() == fast_projection.name && iterated(p).samples >= enough)
        by_limit[p.strain_limit()].try_emplace(p.step(), p);
    const auto tightest =
        std::ranges::find_if(by_limit, [](const auto& entry) { return entry.second.size() >= 4; });
    if (tightest == by_limit.end()) continue;
    std::vector<double> h, first, change;
    double largest = 0;
    for (const auto& [step, p] : tightest->second) {
      const Residuals here = iterated(p);
      h.push_back(step);
      first.push_back(here.first);
      change.push_back(here.change / here.first);
      largest = std::max(largest, here.last / here.first);
      found.points.push_back(p.id());
    }
    const Slope of_first = log_log_slope(h, first), of_change = log_log_slope(h, change);
    order.push_back(above(of_first, 1.5));
    later.push_back(above(of_change, 0));
    append(found.measured,
           std::string(scene) + " at " + percent(tightest->first) + ": slope of the first " +
               text(of_first) + ", of the change over the first " + text(of_change) +
               ", last over first at most " + text(largest, 2),
           "; ");
  }
  if (!order.empty()) found.verdict = verdict_of(all_of(order), all_of(later));
  return found;
}

Verdict same_frame(const Points& points) {
  Verdict found;
  std::vector<Answer> before, after;
  for (const json* entry : points.same_frame) {
    const std::string scene = entry->at("scene");
    if (!scene.starts_with("drape")) continue;
    const auto frames = frames_of(*entry);
    if (!frames) continue;
    before.push_back(yes_if(frames->before < alike / 2));
    const bool open = frames->after >= alike && frames->after <= 2 * alike;
    after.push_back(open ? Answer::open : yes_if(frames->after < alike));
    append(found.measured,
           scene + ": before contact no vertex more than " + percent(frames->before) +
               " apart, after it " + percent(frames->after) + " in the root mean square",
           "; ");
    found.points.push_back("same_frame/" + scene);
  }
  if (!before.empty()) found.verdict = verdict_of(all_of(before), all_of(after));
  return found;
}

Verdict strain_after_collision(const Points& points) {
  Verdict found;
  int all = 0, kept = 0;
  std::map<std::string, std::vector<double>> over_limit;  // by method
  for (const Point& p : points.all) {
    const std::string row = points.roles.of(p.contestant()).row();
    const auto method = std::ranges::find(all_paper_methods, row, &PaperMethod::name);
    if (p.scene() != "drape" || !p.collides_last() || !p.ok() || !p.result().best ||
        method == all_paper_methods.end() || !std::isfinite(p.delivered_strain()))
      continue;
    const double over = p.delivered_strain() / p.strain_limit();
    over_limit[method->words].push_back(over);
    found.points.push_back(p.id());
    if (row != fast_projection.name) continue;
    ++all;
    kept += over <= 1.5 ? 1 : 0;
  }
  if (all == 0) return {};
  for (const auto& [name, list] : over_limit) {
    const auto [least, most] = std::ranges::minmax(list);
    append(found.measured, name + " " + text(least) + (most > least ? " to " + text(most) : ""));
  }
  found.measured = "so at " + std::to_string(kept) + " of " + std::to_string(all) +
                   " points; largest strain after collision over its limit: " + found.measured;
  found.verdict = verdict_of_counts(kept, all - kept, all);
  return found;
}

Slip slip_of(const Point& point) {
  const auto& sag = point.measures().sag;
  const double drop = point.scene_parameter("drop");
  const double rim = sag.at("rim"), across = sag.at("rim_across");
  return {std::min(rim, across) / drop, std::max(rim, across) / drop};
}

Verdict patch_sag(const Points& points) {
  return by_method(
      points, "hung_patch", {0.1, 0.01, 0.001},
      [](const std::vector<Point>& at, const char* words) {
        constexpr double visible = 0.01;  // of the patch's side
        const auto hangs = [&](std::size_t i) {
          return at[i].measures().sag.at("lower_edge") / at[i].scene_parameter("side");
        };
        const double first = hangs(0) - hangs(1), second = hangs(1) - hangs(2);
        return std::pair(first >= visible && second >= visible,
                         percent(first) + " and " + percent(second) + " of the side with " + words);
      },
      "lower by ", ", ");
}

Verdict garment_slip(const Points& points) {
  return by_method(
      points, "garment", {0.1, 0.01},
      [](const std::vector<Point>& at, const char* words) {
        const Slip slides = slip_of(at[0]), stays = slip_of(at[1]);
        return std::pair(stays.most < 1 && slides.least > 1,
                         std::string(words) + " " + percent(stays.most) + " at 1 %, " +
                             percent(slides.least) + " at 10 %");
      },
      "rim below the waist, of the way to the hips: ", "; ");
}

Verdict springs_stiffness(const Points& points) {
  Verdict found;
  std::map<double, std::vector<Point>> by_step;
  for (const Point& p : points.contests)
    if (calibrated(p)) by_step[p.step()].push_back(p);
  if (by_step.empty()) return {};
  const auto most_of = [](const auto& groups) {
    return *std::ranges::max_element(groups, {}, [](const auto& g) { return g.second.size(); });
  };
  const auto [step, runs] = most_of(by_step);
  if (runs.size() < 3) return {};
  std::map<std::pair<std::string, double>, std::vector<double>> places;  // scene and vertices
  for (const Point& p : runs) {
    places[{p.scene(), p.vertices()}].push_back(tension_over_weight(p));
    found.points.push_back(p.id());
  }
  // The place with the most calibrations at one step must predict the others.
  const auto [known, there] = most_of(places);
  double log_sum = 0;
  for (const double tension : there) log_sum += std::log(tension);
  const double expected = std::exp(log_sum / static_cast<double>(there.size()));
  double factor = 1;
  std::string details;
  for (const auto& [place, here] : places) {
    const auto [least, largest] = std::ranges::minmax(here);
    const double low = least / expected, high = largest / expected;
    factor = std::max({factor, high, 1 / low});
    append(details, place.first + " of " + text(place.second, 6) + " " + text(low, 2) +
                        (high > low ? " to " + text(high, 2) : ""));
  }
  found.measured = "at a step of " + step_text(step) + " s, calibrated on " + known.first + " of " +
                   text(known.second, 6) + " vertices: the strain over its limit is " + details +
                   "; off by a factor of " + text(factor, 2) + " at most";
  found.verdict = verdict_of(
      above(Ratio{factor, factor * calibration_tolerance, factor / calibration_tolerance}, 2));
  return found;
}

Verdict failure_configurations(const Points& points) {
  Verdict found;
  bool shake_always = true, shake_sometimes = false, others = true;
  std::string details;
  for (const std::string q : {"Q1", "Q2", "Q3", "Q4"})
    for (const std::string solver : {shake.name, fast_projection.name, icd.name}) {
      const auto cell = std::ranges::find_if(points.matrix, [&](const json* c) {
        return c->at("case") == q && c->at("solver") == solver;
      });
      if (cell == points.matrix.end()) return {};
      const std::string fixed = (*cell)->at("at_fixed_step"), outcome = (*cell)->at("outcome");
      const bool smaller = outcome == "survived_smaller";
      found.points.push_back(q + "/" + solver);
      if (solver != shake.name) {
        others = others && (fixed == "survived" || (q == "Q3" && smaller));
        continue;
      }
      append(details, q + " " + fixed + (smaller ? " (but survived with smaller steps)" : ""));
      shake_always = shake_always && (q == "Q3" || outcome == "refused");
      shake_sometimes = shake_sometimes || (q != "Q3" && fixed == "refused");
    }
  found.measured =
      "SHAKE: " + details + "; fast projection and ICD: " +
      (others ? "all four survived, Q3 at least with smaller steps" : "not all survived");
  found.verdict = !others || !shake_sometimes ? not_reproduced
                  : shake_always              ? reproduced
                                              : changed;
  return found;
}

Verdict no_drift(const Points& points) {
  Verdict found;
  std::vector<Answer> answers;
  std::vector<double> growths;
  std::string failed;
  const auto last_second = [](const json& cell) {
    return cell.value("strain_last_second", json());
  };
  for (const json* cell : points.matrix) {
    const std::string solver = cell->at("solver"), hard_case = cell->at("case"),
                      outcome = cell->at("outcome"), family = points.roles.of(solver).family;
    if (family != points.roles.of(icd.name).family &&
        family != points.roles.of(fast_projection.name).family)
      continue;
    const json first = cell->value("strain_first_second", json()), last = last_second(*cell);
    const bool survived = outcome.starts_with("survived");
    if (survived && first.is_number() && last.is_number()) {
      // Below 1e-9 strain is rounding, which may do as it likes.
      const double growth =
          std::max(last.get<double>(), 1e-9) / std::max(first.get<double>(), 1e-9);
      growths.push_back(growth);
      answers.push_back(growth <= 1.5 ? Answer::yes : growth <= 3 ? Answer::open : Answer::no);
    } else if (!survived && std::ranges::any_of(points.matrix, [&](const json* other) {
                 return other->at("case") == hard_case && last_second(*other).is_number();
               })) {  // the case lasts long enough
      failed += "; " + solver + " ends as " + outcome + " in " + hard_case;
    } else {
      continue;
    }
    found.points.push_back(hard_case + "/" + solver);
  }
  if (answers.empty()) return {};
  const auto [least, most] = std::ranges::minmax(growths);
  found.measured = "strain of the last second over that of the first from " + text(least) + " to " +
                   text(most) + " in " + std::to_string(answers.size()) + " runs" + failed;
  const Answer all = all_of(answers);
  found.verdict = all == Answer::yes && !failed.empty() ? changed : verdict_of(all);
  return found;
}

Verdict degrees_of_freedom_left(const Points& points) {
  std::map<std::string, double> left;  // a vertex, by mesh
  int largest = 0;
  for (const json* mesh : points.freedom) {
    const int n = mesh->at("vertices");
    if (n < largest) continue;
    largest = n;
    left[mesh->at("mesh")] = mesh->at("degrees_of_freedom").get<double>() / n;
  }
  if (!left.contains("quads") || !left.contains("triangles")) return {};
  const double quads = left["quads"], triangles = left["triangles"];
  std::string measured = std::to_string(largest) + " vertices: " + text(quads) +
                         " a vertex with quads, " + text(triangles) + " with triangles";
  if (left.contains("midpoints"))
    measured += ", " + text(left["midpoints"]) + " with midpoints of triangles' edges";
  return {verdict_of(yes_if(std::abs(quads - 1) < 0.25 && triangles < 0.2 * quads)), measured, {}};
}

}  // namespace harness::claims
