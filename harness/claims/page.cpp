#include "harness/claims/page.h"

#include <algorithm>
#include <cmath>

#include "harness/base/text.h"

namespace harness::claims {

using nlohmann::json;

void print_row(std::ostream& out, const std::vector<std::string>& cells) {
  out << '|';
  for (const std::string& cell : cells) out << ' ' << cell << " |";
  out << '\n';
}

void print_head(std::ostream& out, const std::vector<std::string>& cells) {
  print_row(out, cells);
  out << '|';
  for (std::size_t i = 0; i < cells.size(); ++i) out << "---|";
  out << '\n';
}

std::string quoted(const std::string& name) { return '`' + name + '`'; }

std::string bold(const std::string& words) { return "**" + words + "**"; }

std::string plain(double value, int digits) {
  const bool large = value >= 1 && std::isfinite(value);
  const int whole = large ? static_cast<int>(std::log10(value)) + 1 : 1;
  return number_text(value, std::max(digits, whole));
}

double part_of_time(const Point& p, const char* phase) {
  const auto phases = p.document().find("phases");
  if (phases == p.document().end() || !phases->contains(phase)) return std::nan("");
  double all = 0;  // contact is within these
  for (const char* key : {"unconstrained", "filter", "collision"}) all += phases->value(key, 0.0);
  return phases->value(phase, 0.0) / all;
}

bool is_stability(const json& document) { return document.contains("matrix"); }

bool ScenePoints::has_collider() const {
  return std::any_of(points.begin(), points.end(), [](const Point& p) {
    return std::isfinite(p.number("max_strain_after_collision"));
  });
}

std::vector<Role> ScenePoints::contestants() const {
  std::vector<Role> tuned, hollow;
  for (const Point& p : points) {
    const Role role = cast.of(p.contestant());
    const auto known = [&](const Role& other) { return other.name == role.name; };
    std::vector<Role>& list = role.hollow ? hollow : tuned;
    if (!role.again && std::none_of(list.begin(), list.end(), known)) list.push_back(role);
  }
  tuned.insert(tuned.end(), hollow.begin(), hollow.end());
  return tuned;
}

std::vector<Role> ScenePoints::ranked() const {
  std::vector<Role> list = contestants();
  std::erase_if(list, [](const Role& role) { return role.hollow; });
  return list;
}

std::vector<ScenePoints> scenes_of(const json& document, const std::string& sweep,
                                   bool sizes_apart) {
  std::map<std::string, ScenePoints> scenes;
  if (is_stability(document)) return {};
  const Cast cast(document);
  const double noise = pair_noise_of(document);
  for (const json& p : document.at("points")) {
    if (p.at("sweep") != sweep || p.value("adaptive", false)) continue;
    std::string title = p.at("scene").get<std::string>();
    if (sizes_apart) title += ", " + std::to_string(p.at("vertices").get<int>()) + " vertices";
    ScenePoints& scene = scenes[title];
    scene.title = title;
    scene.cast = cast;
    scene.points.emplace_back(p, noise);
  }
  std::vector<ScenePoints> list;
  list.reserve(scenes.size());
  for (auto& [title, scene] : scenes) list.push_back(std::move(scene));
  return list;
}

void PlaceTable::add(double place, const Point& point, const std::string& row) {
  const std::string name = row.empty() ? point.contestant() : row;
  if (!point.timed() || std::none_of(contestants_.begin(), contestants_.end(),
                                     [&](const Role& role) { return role.name == name; }))
    return;
  const auto [cell, added] = cells_.try_emplace({name, place}, point);
  if (!added && point.seconds() < cell->second.seconds()) cell->second = point;
  const auto here = std::lower_bound(places_.begin(), places_.end(), place);
  if (here == places_.end() || *here != place) places_.insert(here, place);
}

void PlaceTable::loose_to_tight() { std::reverse(places_.begin(), places_.end()); }

void PlaceTable::drop_repeated_places() {
  const auto same = [&](double a, double b) {
    return std::all_of(contestants_.begin(), contestants_.end(), [&](const Role& role) {
      const Point *one = find(role.name, a), *other = find(role.name, b);
      return (one ? &one->document() : nullptr) == (other ? &other->document() : nullptr);
    });
  };
  std::vector<double> kept;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (i + 1 == places_.size() || !same(places_[i], places_[i + 1])) kept.push_back(places_[i]);
  }
  places_ = std::move(kept);
}

const Point* PlaceTable::find(const std::string& contestant, double place) const {
  const auto cell = cells_.find({contestant, place});
  return cell == cells_.end() ? nullptr : &cell->second;
}

const Point* PlaceTable::clear_best(double place) const {
  const Point* best = nullptr;
  std::vector<const Point*> all;
  for (const Role& role : contestants_) {
    const Point* p = role.ranked() ? find(role.name, place) : nullptr;
    if (!p) continue;
    all.push_back(p);
    if (!best || p->seconds() < best->seconds()) best = p;
  }
  if (!best) return nullptr;
  const bool clear = std::all_of(all.begin(), all.end(), [&](const Point* p) {
    return p == best || ratio(*p, *best).above(1);
  });
  return clear && all.size() > 1 ? best : nullptr;
}

void PlaceTable::print(std::ostream& out, const std::function<std::string(double)>& head,
                       const Cell& cell) const {
  std::vector<std::string> row{"solver"};
  for (const double place : places_) row.push_back(head(place));
  print_head(out, row);
  for (const Role& role : contestants_) {
    row = {quoted(role.name)};
    bool any = false;
    for (const double place : places_) {
      const Point* point = find(role.name, place);
      any = any || point;
      row.push_back(point ? cell(*point, place) : "-");
    }
    if (any || !role.hollow) print_row(out, row);
  }
  out << '\n';
}

PlaceTable best_over_limits(const ScenePoints& scene, const char* name) {
  PlaceTable best(scene.contestants());
  for (const Point& p : scene.points) {
    if (p.is("scene", name) && p.flag("best") && p.ok()) best.add(p.number("strain_limit"), p);
  }
  best.loose_to_tight();
  return best;
}

}  // namespace harness::claims
