#include "harness/analysis/plane.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "harness/analysis/words.h"
#include "harness/base/in_order.h"
#include "harness/base/text.h"
#include "harness/points/suite.h"

namespace harness::analysis {

using nlohmann::json;

namespace {

bool may_answer(const Point& p) {
  return p.ok() && p.timed() && p.number("step") <= longest_step * (1 + 1e-9);
}

bool is_of_paper(const std::string& method) {
  return std::any_of(all_paper_methods.begin(), all_paper_methods.end(),
                     [&](const PaperMethod& known) { return method == known.name; });
}

std::string level_text(double level) { return number_text(100 * level) + " %"; }

// Why there is no entry: the first of the reasons that holds of all.
std::string why_empty(const std::vector<const Point*>& here, double level, double known_until) {
  const auto any = [&](auto has) { return std::any_of(here.begin(), here.end(), has); };
  if (!any([](const Point* p) { return may_answer(*p); })) return "no run keeps the strain limit";
  if (known_until > 0)
    return "no run that was tried has a motion error of at most " + level_text(level);
  const auto has = [&](const char* key) {
    return any([key](const Point* p) {
      const auto place = p->document().at("error").find(key);
      return place != p->document().at("error").end() && !place->empty();  // null is empty
    });
  };
  if (!has("reference")) return "there is no reference";
  return has("error_series") ? "the reference is not sure to " + level_text(level)
                             : "the file has no errors";
}

// An unranked contestant and its solver are one row, of which the fastest counts.
void rank(std::vector<Entry>& entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.point.seconds() < b.point.seconds();
  });
  std::vector<std::string> rows;
  for (Entry& entry : entries) {
    if (entry.role.again || !entry.role.competes) continue;
    entry.counts = std::find(rows.begin(), rows.end(), entry.row) == rows.end();
    rows.push_back(entry.row);
  }
}

Cell cell_of(const std::vector<const Point*>& here, double limit, double level,
             const ContestantRoles& roles) {
  Cell cell;
  cell.strain_limit = limit;
  cell.level = level;
  for (const Point* p : here) {
    const ErrorAtLevel error = p->error_at(level);
    if (error.samples > 0 && std::isfinite(error.until))
      cell.known_until = std::max(cell.known_until, error.until);
  }
  for (const std::string& name : in_order(here, [](const Point* p) { return p->contestant(); })) {
    std::vector<const Point*> own;
    for (const Point* p : here) {
      if (p->contestant() == name) own.push_back(p);
    }
    const Point* entry = fastest_of(own, level);
    if (!entry) continue;
    cell.entries.push_back({roles.of(name), roles.at_any_settings(name), false, *entry,
                            entry->error_at(level).distance});
  }
  rank(cell.entries);
  if (!cell.first()) cell.empty_because = why_empty(here, level, cell.known_until);
  return cell;
}

// A run that keeps a tighter limit keeps this one: each contestant's fastest run at the cell's
// limit or a tighter one stands for it. cells: of one scene and size, by limit from loose to tight,
// then by level.
void take_tighter_runs(std::vector<Cell>& cells, std::size_t levels) {
  for (std::size_t i = cells.size(); i-- > levels;) {
    const Cell& tight = cells[i];
    Cell& loose = cells[i - levels];
    for (const Entry& entry : tight.entries) {
      const auto own = std::find_if(
          loose.entries.begin(), loose.entries.end(),
          [&](const Entry& other) { return other.point.contestant() == entry.point.contestant(); });
      if (own == loose.entries.end()) {
        loose.entries.push_back(entry);
      } else if (entry.point.seconds() < own->point.seconds()) {
        *own = entry;
      }
    }
    rank(loose.entries);
    if (loose.first()) loose.empty_because.clear();
  }
}

// Down to the finest one that the file's sweep went on for.
std::vector<double> levels_in(const json& document) {
  const json suite = document.value("context", json::object()).value("suite", json::object());
  const double finest = suite.value("finest_error", answer_levels.back());
  std::vector<double> levels{any_motion};
  for (const double level : answer_levels) {
    if (level >= finest) levels.push_back(level);
  }
  return levels;
}

Plane plane_of(const std::vector<const Point*>& points, const json& document,
               const ContestantRoles& roles) {
  const Point& one = *points.front();
  Plane plane;
  plane.scene = one.text("scene");
  plane.sweep = one.text("sweep");
  plane.scene_parameters = one.document().value("scene_parameters", json::object());
  plane.resolution = static_cast<int>(one.number("resolution"));
  plane.vertices = static_cast<int>(one.number("vertices"));
  plane.limits = in_order(points, [](const Point* p) { return p->number("strain_limit"); });
  std::sort(plane.limits.rbegin(), plane.limits.rend());
  plane.levels = levels_in(document);
  for (const double limit : plane.limits) {
    std::vector<const Point*> here;
    for (const Point* p : points) {
      if (p->number("strain_limit") == limit) here.push_back(p);
    }
    for (const double level : plane.levels)
      plane.cells.push_back(cell_of(here, limit, level, roles));
  }
  take_tighter_runs(plane.cells, plane.levels.size());
  return plane;
}

}  // namespace

const Point* fastest_of(const std::vector<const Point*>& points, double level) {
  const Point* best = nullptr;
  for (const bool marked : {true, false}) {
    for (const Point* p : points) {
      if (!may_answer(*p) || (marked && !p->marked_best(level))) continue;
      if (best && p->seconds() >= best->seconds()) continue;
      if (p->within_error(level)) best = p;
    }
    if (best) return best;
  }
  return nullptr;
}

const Entry* Cell::counting(std::size_t place) const {
  for (const Entry& entry : entries) {
    if (entry.counts && place-- == 0) return &entry;
  }
  return nullptr;
}

std::string method_of(const std::string& row) { return row.substr(0, row.find('@')); }

std::string stepper_of(const std::string& row) {
  const std::size_t at = row.find('@');
  return at == row.npos ? "" : row.substr(at + 1);
}

template <class Has>
const Entry* Cell::fastest(Has has) const {
  const auto place = std::find_if(entries.begin(), entries.end(),
                                  [&](const Entry& e) { return e.counts && has(e); });
  return place == entries.end() ? nullptr : &*place;
}

const Entry* Cell::next_family() const {
  const Entry* best = first();
  return best ? fastest([best](const Entry& e) { return e.role.family != best->role.family; })
              : nullptr;
}

const Entry* Cell::paper_best() const {
  return fastest([](const Entry& e) { return is_of_paper(e.row); });
}

const Entry* Cell::paper_in_any_stepper() const {
  return fastest([](const Entry& e) { return is_of_paper(method_of(e.row)); });
}

const Entry* Cell::first_as_published() const {
  const Entry* best = first();
  return best ? fastest([best](const Entry& e) { return e.row == method_of(best->row); }) : nullptr;
}

const Entry* Cell::rival_in_stepper() const {
  const Entry* best = first();
  if (!best) return nullptr;
  return fastest([best](const Entry& e) {
    return stepper_of(e.row) == stepper_of(best->row) && method_of(e.row) != method_of(best->row);
  });
}

std::vector<const Entry*> Cell::equals() const {
  std::vector<const Entry*> list;
  for (const Entry& entry : entries) {
    const auto lead = lead_over(&entry);
    if (entry.counts && (!lead || (lead->known() && !lead->above(1)))) list.push_back(&entry);
  }
  return list;
}

bool Cell::clear() const {
  return counting(1) && std::all_of(entries.begin(), entries.end(), [&](const Entry& entry) {
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
  for (const Cell& cell : cells) {
    if (cell.strain_limit == limit && cell.level == level) return cell;
  }
  throw std::out_of_range("no such cell");
}

std::vector<std::string> Plane::leaders() const {
  std::vector<std::string> rows;
  for (const Cell& cell : cells) {
    if (cell.first()) rows.push_back(cell.first()->row);
  }
  for (const PaperMethod& method : all_paper_methods) rows.emplace_back(method.name);
  return in_order(rows, [](const std::string& row) { return row; });
}

std::vector<Plane> planes_of(const json& document) {
  const ContestantRoles roles(document);
  const double noise = pair_noise_of(document);
  std::vector<Point> points;
  for (const json& p : document.at("points")) {
    if (!p.value("adaptive", false)) points.emplace_back(p, noise);
  }
  const auto place_of = [](const Point& p) {
    return std::tuple(p.text("scene"), p.text("sweep"),
                      p.document().value("scene_parameters", json::object()).dump(),
                      p.number("vertices"));
  };
  std::vector<Plane> planes;
  for (const auto& place : in_order(points, place_of)) {
    std::vector<const Point*> here;
    for (const Point& p : points) {
      if (place_of(p) == place) here.push_back(&p);
    }
    planes.push_back(plane_of(here, document, roles));
  }
  return planes;
}

}  // namespace harness::analysis
