#include "harness/analysis/plane.h"

#include "harness/points/suite.h"

namespace harness::analysis {
namespace {

bool may_answer(const Point& p) {
  return p.ok() && p.timed() && p.spec().step <= longest_step * (1 + 1e-9);
}

std::string stepper_of(const std::string& row) { return row.substr(method_of(row).size()); }

bool is_of_paper(const std::string& method) {
  return std::ranges::any_of(all_paper_methods,
                             [&](const PaperMethod& known) { return method == known.name; });
}

// Why a cell has no entry: the first reason that applies to all runs.
std::string why_empty(const std::vector<Point>& here, double level, double known_until) {
  const auto any = [&](auto has) { return std::ranges::any_of(here, has); };
  if (!any(may_answer)) return "no run keeps the strain limit";
  if (known_until > 0)
    return "no run that was tried has a motion error of at most " + percent(level);
  if (!any([](const Point& p) { return !p.measures().reference.empty(); }))
    return "there is no reference";
  return any([](const Point& p) { return !levels_of_series(p.measures()).empty(); })
             ? "the reference is not known to within " + percent(level)
             : "the file has no errors";
}

// Keeps each contestant's fastest entry. Of several in one row only the fastest counts.
void rank(std::vector<Entry>& entries) {
  std::ranges::stable_sort(entries, {}, [](const Entry& e) { return e.point.seconds(); });
  std::vector<Entry> ranked;
  for (Entry& entry : entries) {
    const auto any = [&](auto is) { return std::ranges::any_of(ranked, is); };
    if (any([&](const Entry& e) { return e.role.name == entry.role.name; })) continue;
    entry.counts = entry.role.competes && !entry.role.again &&
                   !any([&](const Entry& e) { return e.counts && e.row == entry.row; });
    ranked.push_back(std::move(entry));
  }
  entries = std::move(ranked);
}

Cell cell_of(const std::vector<Point>& here, double limit, double level,
             const ContestantRoles& roles) {
  Cell cell{limit, level, {}, 0, ""};
  for (const Point& p : here) {
    const ErrorAtLevel error = p.error_at(level);
    if (error.samples > 0 && std::isfinite(error.until))
      cell.known_until = std::max(cell.known_until, error.until);
  }
  for (const auto& [name, own] : grouped(here, &Point::contestant)) {
    const Role role = roles.of(name);
    if (const auto entry = fastest_of(own, level))
      cell.entries.push_back({role, role.row(), false, *entry, entry->error_at(level).distance});
  }
  rank(cell.entries);
  if (!cell.first()) cell.empty_because = why_empty(here, level, cell.known_until);
  return cell;
}

Plane plane_of(const std::vector<Point>& points, const Runs& runs) {
  const PointSpec& one = points.front().spec();
  Plane plane{one.scene,      one.sweep,    one.scene_parameters,
              one.resolution, one.vertices, {},
              runs.levels,    {},           points};
  auto by_limit = grouped(points, &Point::strain_limit);
  std::ranges::sort(by_limit, std::greater(), [](const auto& group) { return group.first; });
  for (const auto& [limit, here] : by_limit) {
    plane.limits.push_back(limit);
    for (const double level : plane.levels)
      plane.cells.push_back(cell_of(here, limit, level, runs.roles));
  }
  // A run that keeps a tighter limit keeps a looser one as well: each contestant's fastest run at
  // the cell's limit or a tighter one counts. Cells go from loose to tight limits, then by level.
  for (std::size_t i = plane.cells.size(), levels = plane.levels.size(); i-- > levels;) {
    const Cell& tight = plane.cells[i];
    Cell& loose = plane.cells[i - levels];
    loose.entries.insert(loose.entries.end(), tight.entries.begin(), tight.entries.end());
    rank(loose.entries);
    if (loose.first()) loose.empty_because.clear();
  }
  return plane;
}

}  // namespace

std::optional<Point> fastest_of(const std::vector<Point>& points, double level) {
  std::optional<Point> best;
  for (const bool marked : {true, false}) {
    for (const Point& p : points) {
      const PointResult& r = p.result();
      const bool is_marked =
          level == any_motion ? r.best : std::ranges::count(r.best_at_errors, level) > 0;
      if (!may_answer(p) || (marked && !is_marked)) continue;
      if (best && p.seconds() >= best->seconds()) continue;
      if (p.within_error(level)) best = p;
    }
    if (best) return best;
  }
  return best;
}

const Entry* Cell::counting(std::size_t place) const {
  for (const Entry& entry : entries)
    if (entry.counts && place-- == 0) return &entry;
  return nullptr;
}

const std::array<RivalInfo, 5> rival_infos{
    RivalInfo{"next_family", "lead_over_next_family",
              [](const Entry& first, const Entry& other) {
                return other.role.family != first.role.family;
              }},
    {"paper_best", "lead_over_paper_best",
     [](const Entry&, const Entry& other) { return is_of_paper(other.row); }},
    {"first_as_published", "lead_by_stepper",
     [](const Entry& first, const Entry& other) { return other.row == method_of(first.row); }},
    {"rival_in_stepper", "lead_by_method",
     [](const Entry& first, const Entry& other) {
       return stepper_of(other.row) == stepper_of(first.row) &&
              method_of(other.row) != method_of(first.row);
     }},
    {"paper_in_any_stepper", "lead_over_paper_in_any_stepper",
     [](const Entry&, const Entry& other) { return is_of_paper(method_of(other.row)); }}};

const Entry* Cell::rival(Rival which) const {
  const RivalInfo& info = rival_infos[static_cast<std::size_t>(which)];
  const auto place = std::ranges::find_if(
      entries, [&](const Entry& e) { return e.counts && info.is(*first(), e); });
  return place == entries.end() ? nullptr : &*place;
}

bool Cell::clear() const {
  return counting(1) && std::ranges::all_of(entries, [&](const Entry& entry) {
           const auto lead = lead_over(&entry);
           return !entry.counts || !lead || lead->above(1);
         });
}

std::optional<Ratio> Cell::lead_over(const Entry* other) const {
  const Entry* best = first();
  if (!best || !other || other == best) return std::nullopt;
  return ratio(other->point, best->point);
}

const Cell& Plane::cell(double limit, double level) const {
  for (const Cell& cell : cells)
    if (cell.strain_limit == limit && cell.level == level) return cell;
  throw std::out_of_range("no such cell");
}

std::vector<Plane> planes_of(const Runs& runs) {
  const auto place_of = [](const Point& p) {
    return std::tuple(p.spec().scene, p.spec().sweep, p.spec().scene_parameters, p.spec().vertices);
  };
  std::vector<Plane> planes;
  for (const auto& [place, here] : grouped(runs.points, place_of))
    planes.push_back(plane_of(here, runs));
  return planes;
}

}  // namespace harness::analysis
