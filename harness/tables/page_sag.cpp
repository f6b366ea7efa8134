// How far marked vertices sag.
#include "harness/analysis/words.h"
#include "harness/base/text.h"
#include "harness/claims/sag.h"
#include "harness/tables/page.h"

namespace harness::tables {

void print_sag(std::ostream& out, const NamedResult& result) {
  const LimitTable table(result.document, "hung_patch");
  if (table.empty()) return;
  const double side = table.any().scene_parameter("side");
  out << "## Sag of the hung patch (`" << result.name << "`)\n\n"
      << "How far the middle of the top row, and that of the lower edge, hang below where they "
         "would if nothing stretched, mean over the last third of the run, each solver at its "
         "best step; in brackets how fast it still moves. A top row that "
         "uses up its strain and bears an even load is a parabola, which sags by ";
  bool first = true;
  for (const double limit : table.limits()) {
    out << (first ? "" : ", ") << plain(1e3 * claims::parabola_sag(side, limit), 3) << " mm at "
        << percent(limit);
    first = false;
  }
  out << ".\n\n";
  table.print(
      out, [](double limit) { return percent(limit) + ", mm (m/s)"; },
      [](const Point& p) {
        const nlohmann::json& sag = p.document().at("sag");
        return plain(1e3 * sag.at("top_row").get<double>(), 3) + ", " +
               plain(1e3 * sag.at("lower_edge").get<double>(), 3) + " (" +
               plain(p.number("rest_speed"), 2) + ")";
      });
}

}  // namespace harness::tables
