// What a ranking of best points does not say by itself: what the runs deliver, where their time
// goes, how the other runs ended, and what tuning did.
#include <algorithm>
#include <array>
#include <cmath>

#include "harness/base/text.h"
#include "harness/claims/page.h"
#include "harness/points/status.h"

namespace harness::claims {
namespace {

using Head = std::function<std::string(double)>;

// "31, 2.1, <0.001": in per cent, "-" for what is not known.
std::string strains(const Point& p, const std::array<const char*, 3>& keys) {
  std::string cell;
  for (const char* key : keys) {
    const double strain = p.number(key);
    cell += (cell.empty() ? "" : ", ") + (!std::isfinite(strain) ? "-"
                                          : strain < 1e-5        ? "<0.001"
                                                                 : plain(100 * strain, 2));
  }
  return cell;
}

void print_strains(std::ostream& out, const ScenePoints& scene, const PlaceTable& best,
                   const Head& place) {
  const bool collider = scene.has_collider();
  const auto head = [&](double at) { return place(at) + ": strain in %"; };
  out << "Strain of these runs: maximum, 99th percentile, root mean square"
      << (collider ? ", before the collision filter" : "") << ":\n\n";
  best.print(out, head, [](const Point& p, double) {
    return strains(p, {"max_strain", "p99_strain", "rms_strain"});
  });
  if (!collider) return;
  out << "The same after the collision filter, which is what a user gets:\n\n";
  best.print(out, head, [](const Point& p, double) {
    const bool named = std::isfinite(p.number("delivered_max_strain"));
    return strains(p, {named ? "delivered_max_strain" : "max_strain_after_collision",
                       "delivered_strain_p99", "delivered_strain_rms"});
  });
}

// Of one run's time; not-a-number for methods without a filter.
double filter_part(const Point& p) {
  const double part = part_of_time(p, "filter");
  return part > 0 ? part : std::nan("");
}

void print_filter_time(std::ostream& out, const ScenePoints& scene, const PlaceTable& best,
                       const Head& place) {
  if (!scene.has_collider()) return;
  out << "The inextensibility filter alone, without collisions and the unconstrained step: seconds "
         "for one simulated second where they were measured, and its part of one run's time:\n\n";
  best.print(
      out, [&](double at) { return place(at) + ", s"; },
      [](const Point& p, double) {
        const double seconds = p.filter_seconds(), part = filter_part(p);
        if (std::isnan(part)) return std::string("-");
        return (std::isfinite(seconds) ? plain(seconds, 3) + ", " : "") + plain(100 * part, 2) +
               " %";
      });
}

void print_energy(std::ostream& out, const PlaceTable& best, const Head& place) {
  const auto known = [&] {
    for (const Role& role : best.contestants()) {
      for (const double at : best.places()) {
        const Point* p = best.find(role.name, at);
        if (p && std::isfinite(p->error("energy_gain"))) return true;
      }
    }
    return false;
  };
  if (!known()) return;
  out << "Their gain of energy, over weight times size (negative: energy was lost throughout):\n\n";
  best.print(
      out, [&](double at) { return place(at) + ", gain"; },
      [](const Point& p, double) {
        const double gain = p.error("energy_gain");
        return std::isfinite(gain) ? number_text(gain, 2) : std::string("-");
      });
}

void print_failures(std::ostream& out, const ScenePoints& scene, const PlaceTable& best) {
  std::map<std::string, std::map<std::string, int>> counts;
  for (const Point& p : scene.points) ++counts[p.contestant()][p.text("status")];
  std::vector<std::string> statuses;
  for (const PointStatusInfo& row : point_statuses) {
    const bool seen = std::any_of(counts.begin(), counts.end(), [&](const auto& count) {
      return count.second.contains(row.name);
    });
    if (seen) statuses.push_back(row.name);
  }
  if (statuses == std::vector<std::string>{to_string(PointStatus::ok)}) return;
  out << "How all runs of this sweep ended, at every step that was tried:\n\n";
  std::vector<std::string> row{"solver"};
  for (const std::string& status : statuses) row.push_back(quoted(status) + ", runs");
  print_head(out, row);
  for (const Role& role : best.contestants()) {
    row = {quoted(role.name)};
    for (const std::string& status : statuses) {
      const auto& here = counts[role.name];
      const auto count = here.find(status);
      row.push_back(count == here.end() ? "0" : std::to_string(count->second));
    }
    print_row(out, row);
  }
  out << '\n';
}

void print_untuned(std::ostream& out, const PlaceTable& own, const Head& place) {
  std::vector<std::vector<std::string>> rows;
  for (const Role& role : own.contestants()) {
    if (!role.hollow) continue;
    std::vector<std::string> row{quoted(role.name), quoted(role.solver)};
    for (const double at : own.places()) {
      const Point *untuned = own.find(role.name, at), *tuned = own.find(role.solver, at);
      row.push_back(untuned && tuned ? text(ratio(*untuned, *tuned)) : "-");
    }
    rows.push_back(row);
  }
  if (rows.empty()) return;
  out << "What tuning did: untuned contestants, over the time of the tuned ones (below 1: the "
         "tuned settings, one for all limits, are the slower ones here):\n\n";
  std::vector<std::string> head{"untuned", "tuned"};
  for (const double at : own.places()) head.push_back(place(at) + ", ratio");
  print_head(out, head);
  for (const auto& row : rows) print_row(out, row);
  out << '\n';
}

}  // namespace

void print_beside(std::ostream& out, const ScenePoints& scene, const PlaceTable& best,
                  const PlaceTable& own, const Head& place) {
  print_strains(out, scene, best, place);
  print_filter_time(out, scene, best, place);
  print_energy(out, best, place);
  print_failures(out, scene, own);
  print_untuned(out, own, place);
}

}  // namespace harness::claims
