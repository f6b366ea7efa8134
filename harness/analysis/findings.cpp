// The answers of a result file in words and as JSON.
#include "harness/analysis/plane.h"
#include "harness/base/table.h"
#include "harness/points/point_json.h"

namespace harness::analysis {
namespace {

constexpr double headline_limit = 0.01;  // strain

std::string name_words(const Entry& entry) {
  return entry.row + (entry.role.unranked ? " with other settings" : "");
}

// "a", "a and b", "a, b, c and 2 more".
std::string joined(const std::vector<const Entry*>& entries) {
  constexpr std::size_t most = 3;
  const std::size_t named = std::min(most, entries.size());
  std::string words;
  for (std::size_t i = 0; i < named; ++i) {
    const bool last = i + 1 == entries.size();
    words += (i == 0 ? "" : last ? " and " : ", ") + name_words(*entries[i]);
  }
  const std::size_t rest = entries.size() - named;
  return words + (rest > 0 ? " and " + std::to_string(rest) + " more" : "");
}

// The first, and counting entries with an interval that are too close to it to rank.
std::vector<const Entry*> equals_in(const Cell& cell) {
  std::vector<const Entry*> list;
  for (const Entry& entry : cell.entries) {
    const auto lead = cell.lead_over(&entry);
    if (entry.counts && (!lead || (lead->known() && !lead->above(1)))) list.push_back(&entry);
  }
  return list;
}

std::string leader_words(const Cell& cell, const std::vector<const Entry*>& equals) {
  const std::string first = name_words(*cell.first());
  if (!cell.counting(1)) return "only " + first + " has a run";
  if (equals.size() > 1) return joined(equals) + " are the fastest, too close to rank";
  if (cell.clear()) return first + " is the fastest";
  return first + " is fastest so far, with too few samples to rank";
}

std::string rival_words(const Cell& cell, const std::vector<const Entry*>& equals) {
  const auto slower = [&](const Entry* entry) {
    return entry && std::ranges::find(equals, entry) == equals.end();
  };
  const Entry* rival = cell.rival(Rival::paper_best);
  const bool of_paper = slower(rival);
  for (std::size_t place = 1; !slower(rival); ++place) {
    rival = cell.counting(place);
    if (!rival) return "";
  }
  return "; " + name_words(*rival) +
         (of_paper ? ", the best of the paper's six, takes " : ", the next, takes ") +
         text(*cell.lead_over(rival)) + " times as long";
}

const Cell* answered(const Plane& plane, double limit, double level) {
  const Cell& cell = plane.cell(limit, level);
  return cell.first() ? &cell : nullptr;
}

// The answer at the tightest limit below the headline's; else at any motion, if another method is
// first there.
const Cell* second_of(const Plane& plane, const Cell& headline) {
  for (auto limit = plane.limits.rbegin(); limit != plane.limits.rend(); ++limit) {
    if (*limit >= headline.strain_limit) break;
    if (const Cell* cell = answered(plane, *limit, headline.level)) return cell;
  }
  const Cell* any = answered(plane, headline.strain_limit, any_motion);
  return any && any->first()->row != headline.first()->row ? any : nullptr;
}

}  // namespace

std::string sentence_of(const Cell& cell) {
  const std::string place =
      "At " + percent(cell.strain_limit) + " strain, " +
      (cell.level == any_motion ? std::string("whatever the motion")
                                : "motion error at most " + percent(cell.level));
  const Entry* first = cell.first();
  if (!first) return place + ", there is no answer: " + cell.empty_because + ".";
  const auto equals = equals_in(cell);
  const std::string error = std::isfinite(first->error)
                                ? " and an error of " + number_text(100 * first->error, 2) + " %"
                                : "";
  return place + ", " + leader_words(cell, equals) + ": " + time_words(first->point.seconds()) +
         " a simulated second with steps of " + step_text(first->point.spec().step) + " s" + error +
         rival_words(cell, equals) + ".";
}

const Cell& headline_of(const Plane& plane) {
  const double limit = std::ranges::min(
      plane.limits, {}, [](double x) { return std::abs(std::log(x / headline_limit)); });
  const Cell* found = &plane.cell(limit, any_motion);
  for (const double level : plane.levels) {  // any motion, then loose to tight
    const Cell* cell = answered(plane, limit, level);
    if (cell && level >= headline_error) found = cell;
  }
  return *found;
}

bool is_largest(const Plane& plane, const std::vector<Plane>& planes) {
  return plane.sweep != "resolution" || std::ranges::none_of(planes, [&](const Plane& other) {
           return other.scene == plane.scene && other.sweep == plane.sweep &&
                  other.vertices > plane.vertices;
         });
}

std::vector<Finding> findings_of(const std::vector<Plane>& planes) {
  std::vector<Finding> findings;
  for (const Plane& plane : planes) {
    if (!is_largest(plane, planes)) continue;
    Finding finding{
        plane.scene,
        plane.sweep,
        plane.vertices,
        scene_words(plane.scene) + " of " + std::to_string(plane.vertices) + " vertices",
        {}};
    const Cell& headline = headline_of(plane);
    finding.sentences.push_back(sentence_of(headline));
    if (const Cell* second = headline.first() ? second_of(plane, headline) : nullptr)
      finding.sentences.push_back(sentence_of(*second));
    findings.push_back(std::move(finding));
  }
  return findings;
}

std::string title_of(const Plane& plane) {
  return plane.sweep == "resolution"
             ? scene_words(plane.scene) + " over resolution, " + percent(plane.limits.front()) +
                   " strain"
             : scene_words(plane.scene) + ", " + std::to_string(plane.vertices) +
                   " vertices, over " + plane.sweep;
}

// ---- As JSON ----

static json ratio_json(const std::optional<Ratio>& ratio) {
  if (!ratio) return nullptr;
  const bool known = ratio->known();
  return {{"value", number(ratio->value)},
          {"low", known ? json(ratio->low) : json()},
          {"high", known ? json(ratio->high) : json()}};
}

static json name_of(const Entry* entry) { return entry ? json(entry->row) : json(); }

// The library finds these by the type of what is put into a document, or a list of it.

static void to_json(json& to, const Entry& entry) {
  to = {{"contestant", entry.role.name},
        {"row", entry.row},
        {"unranked", entry.role.unranked},
        {"counts", entry.counts},
        {"id", entry.point.id()},
        {"seconds", number(entry.point.seconds())},
        {"step", number(entry.point.step())},
        {"error", number(entry.error)},
        {"delivered_strain", number(entry.point.delivered_strain())}};
}

static void to_json(json& to, const Cell& cell) {
  to = {{"strain_limit", cell.strain_limit},
        {"error_level", number(cell.level)},  // null: any motion
        {"known_until", cell.known_until},
        {"empty_because", cell.empty_because},
        {"first", name_of(cell.first())},
        {"clear", cell.clear()},
        {"entries", cell.entries}};
  for (std::size_t i = 0; i < rival_infos.size(); ++i) {
    const Entry* rival = cell.rival(static_cast<Rival>(i));
    to[rival_infos[i].name] = name_of(rival);
    to[rival_infos[i].lead] = ratio_json(cell.lead_over(rival));
  }
}

static void to_json(json& to, const Plane& plane) {
  // Rows that figures show first: methods that are first in a cell, then the paper's six.
  std::vector<std::string> leaders;
  for (const Cell& cell : plane.cells)
    if (cell.first()) leaders.push_back(cell.first()->row);
  for (const PaperMethod& method : all_paper_methods) leaders.emplace_back(method.name);
  to = {{"scene", plane.scene},
        {"sweep", plane.sweep},
        {"scene_parameters", plane.scene_parameters},
        {"resolution", plane.resolution},
        {"vertices", plane.vertices},
        {"strain_limits", plane.limits},
        {"error_levels", plane.levels},  // any motion, which is infinite, is written as null
        {"leaders", in_order(leaders, std::identity())},
        {"cells", plane.cells}};
}

namespace {

// The least sample, and the median of three or more: between them lies what disturbed the runs.
// Null: not timed.
json time_json(const std::vector<double>& samples) {
  const double least = time_of(samples);
  if (!(least > 0)) return nullptr;
  return {least, samples.size() < 3 ? least : quantile(samples, 0.5)};
}

// Why none of a contestant's runs counts: the letters of their statuses, from the coarsest step to
// the finest. "": one does count, perhaps at a tighter limit. runs: of one plane, coarsest first.
std::string failure_letters(const std::vector<Point>& runs, double limit, double level) {
  std::string found;
  for (const Point& run : runs) {
    const double kept = run.spec().strain_limit;
    if (kept > limit) continue;
    if (run.ok() && !(run.measures().trajectory > level)) return "";
    const std::string letter =
        run.ok() ? "X" : point_statuses[static_cast<std::size_t>(run.result().status)].letter;
    if (kept == limit && found.find(letter) == found.npos) found += letter;
  }
  return found;
}

// A figure for each scene and sweep, and for what the sweep leaves fixed: vertices, or the limit.
json curves_of(const ContestantRoles& roles, const std::vector<Plane>& planes) {
  std::map<std::tuple<std::string, std::string, double>, json> figures;
  for (const Plane& plane : planes) {
    const bool sizes = plane.sweep == "resolution";
    if (!sizes && plane.sweep != "strain") continue;
    std::vector<Point> points = plane.points;
    std::erase_if(points, [&](const Point& p) { return roles.of(p.contestant()).again; });
    std::ranges::stable_sort(points, std::greater(), &Point::step);
    const auto own_runs = grouped(points, &Point::contestant);
    for (const double limit : plane.limits) {
      const double fixed = sizes ? limit : plane.vertices, x = sizes ? plane.vertices : limit;
      json& figure = figures[{plane.scene, plane.sweep, fixed}];
      for (const auto& [panel, level] :
           {std::pair("any", any_motion), {"within", headline_error}}) {
        json& curves = figure[panel];
        for (const Entry& entry : plane.cell(limit, level).entries) {
          if (entry.role.again) continue;
          const PointResult& p = entry.point.result();
          curves[entry.role.name]["best"].push_back({{"x", x},
                                                     {"time", time_json(p.samples)},
                                                     {"filter", time_json(p.filter_samples)},
                                                     {"step", number(p.spec.step)},
                                                     {"ladder_end", p.at_ladder_end}});
        }
        for (const auto& [name, own] : own_runs) {
          const std::string why = failure_letters(own, limit, level);
          if (!why.empty()) curves[name]["failures"].push_back({x, why});
        }
      }
    }
  }
  json list = json::array();
  for (auto& [place, figure] : figures) {
    std::tie(figure["scene"], figure["sweep"], figure["fixed"]) = place;
    list.push_back(std::move(figure));
  }
  return list;
}

}  // namespace

json analysis_of(const Runs& runs) {
  const std::vector<Plane> planes = planes_of(runs);
  return {{"schema", "inextensible-analysis/1"},
          {"headline_error", headline_error},
          {"findings", findings_of(planes)},
          {"planes", planes},
          {"curves", curves_of(runs.roles, planes)}};
}

}  // namespace harness::analysis
