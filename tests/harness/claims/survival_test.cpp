// Who gets through.
#include <gtest/gtest.h>

#include <sstream>

#include "harness/claims/page.h"
#include "invented_points.h"

namespace harness {
namespace {

json run(double step, const char* status, double rise, double contact) {
  json p = point("drape", "step", "icd", 0.01, 441, step, 1);
  p["status"] = status;
  p["error"]["energy_rise"] = rise;
  p["phases"] = {{"unconstrained", 1.0}, {"filter", 2.0}, {"collision", 1.0}, {"contact", contact}};
  p["max_strain_after_collision"] = 0.01;
  return p;
}

TEST(Survival, CountsWhatEndedWellAndWhatCameBack) {
  const NamedResult result{"a.json",
                           document({run(0.02, "not_converged", 0.5, 0), run(0.01, "ok", 0.01, 1),
                                     run(0.005, "ok", 0.03, 2), run(0.0025, "timeout", 0.9, 0)})};
  std::ostringstream out;
  claims::print_survival(out, {result});
  // Two of three: the one that was stopped says nothing, and the one that failed has no rise. Of
  // four seconds contact took one and two: 37.5 % is their median.
  EXPECT_NE(out.str().find("| `icd` | 2 of 3, 0.03, 38 % |"), std::string::npos) << out.str();
}

TEST(Survival, SaysNothingOfFilesThatKnowNothing) {
  std::ostringstream out;
  claims::print_survival(
      out, {{"a.json", document({point("chain", "step", "icd", 0.01, 80, 0.01, 1)})}});
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace harness
