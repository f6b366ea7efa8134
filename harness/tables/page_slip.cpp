// Where the rim of a garment ends up.
#include "harness/analysis/words.h"
#include "harness/base/text.h"
#include "harness/claims/slip.h"
#include "harness/tables/page.h"

namespace harness::tables {
namespace {

constexpr double frame = 1.0 / 30;  // s

}  // namespace

void print_slip(std::ostream& out, const NamedResult& result) {
  const LimitTable table(result.document, "garment");
  if (table.empty()) return;
  out << "## Slip of the garment (`" << result.name
      << "`)\n\nHow far the garment's rim is below the waist, where it began, mean over the last "
         "third of the run, of the way to the hips: above 100 % it has slipped past them. In "
         "brackets the time of computation for a frame of 1/30 s. Each solver at its best "
         "step.\n\n";
  table.print(
      out, [](double limit) { return percent(limit) + ", % (s)"; },
      [](const Point& p) {
        const claims::Slip slip = claims::slip_of(p);
        return plain(50 * (slip.least + slip.most), 3) + " (" + plain(frame * p.seconds(), 2) + ")";
      });
}

}  // namespace harness::tables
