#include "harness/stability/conformance.h"

#include <algorithm>

#include "harness/base/small_runs.h"
#include "harness/base/text.h"
#include "harness/stability/checks.h"

namespace harness {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, grade, check, measured, advice)

std::vector<Finding> examine(const std::string& solver, const ConformanceOptions& options) {
  const Examinee examinee{*inextensible::find_backend(solver), options};
  std::vector<Finding> findings;
  for (const Check& check : checks()) {
    // In a process of its own: the solver may crash, hang or end the program.
    const Findings found = in_child(
        {check.timeout, 0, options.interrupted},
        [&](Heartbeat& /*heartbeat*/) -> nlohmann::json {
          try {
            return check.run(examinee);
          } catch (const NotTaken& reason) {  // a scene that is not taken is none to examine it on
            return Findings{{Finding::Grade::not_applicable, check.name,
                             std::string("not taken: ") + reason.what(), ""}};
          }
        },
        [](const nlohmann::json& list) { return list.get<Findings>(); },
        [&](const ChildOutcome& child) {
          const std::string how = child.end == ChildOutcome::End::timed_out
                                      ? "did not end within " + number_text(check.timeout) + " s"
                                      : ending(child);
          return Findings{{Finding::Grade::fail, check.name, how,
                           "run it alone under a debugger: the checks are in "
                           "harness/stability/checks.cpp"}};
        });
    for (const Finding& finding : found) {
      findings.push_back(finding);
      options.finding(finding);
    }
  }
  return findings;
}

bool conforms(const std::vector<Finding>& findings) {
  return std::ranges::count(findings, Finding::Grade::fail, &Finding::grade) == 0;
}

}  // namespace harness
