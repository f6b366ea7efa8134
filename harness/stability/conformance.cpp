#include "harness/stability/conformance.h"

#include <algorithm>

#include "harness/base/child_process.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"
#include "harness/stability/checks.h"

namespace harness {
namespace {

using nlohmann::json;

struct Check {
  const char* name;
  Findings (*run)(const Examinee&);
  double timeout = 120;  // s
};

constexpr Check checks[] = {
    {"ordinary runs", check_ordinary_runs},
    {"momentum", check_momentum},
    {"refusal", check_refusal},
    {"permissible candidate", check_permissible_candidate},
    {"determinism", check_determinism},
    {"consistency", check_consistency},
    {"hard cases", check_hard_cases, 3600},
};

json to_json(const Findings& findings) {
  json list = json::array();
  for (const Finding& f : findings)
    list.push_back({static_cast<int>(f.grade), f.check, f.measured, f.advice});
  return list;
}

Findings findings_of(const json& list) {
  Findings findings;
  for (const json& f : list)
    findings.push_back(
        {static_cast<Finding::Grade>(f.at(0).get<int>()), f.at(1), f.at(2), f.at(3)});
  return findings;
}

// A scene that the solver does not take is none to examine it on.
Findings of_what_is_taken(const Check& check, const Examinee& examinee) {
  try {
    return check.run(examinee);
  } catch (const NotTaken& reason) {
    return {not_applicable(check.name, std::string("not taken: ") + reason.what())};
  }
}

// In a process of its own: the solver may crash, hang or end the program.
Findings isolated(const Check& check, const Examinee& examinee) {
  ChildOutcome outcome =
      run_in_child([&](Heartbeat&) { return compact(to_json(of_what_is_taken(check, examinee))); },
                   {check.timeout, 0, examinee.options.interrupted});
  if (outcome.end == ChildOutcome::End::interrupted) throw Interrupted();
  if (auto findings = answer(outcome, findings_of)) return *findings;
  const std::string how = outcome.end == ChildOutcome::End::timed_out
                              ? "did not end within " + number_text(check.timeout) + " s"
                              : ending(outcome);
  return {judged(false, check.name, how,
                 "run it alone under a debugger: the check is harness/stability/check_*.cpp")};
}

}  // namespace

std::vector<Finding> examine(const std::string& solver, const ConformanceOptions& options) {
  const Examinee examinee{*inextensible::find_backend(solver), options};
  std::vector<Finding> findings;
  for (const Check& check : checks) {
    for (const Finding& finding : isolated(check, examinee)) {
      findings.push_back(finding);
      options.finding(finding);
    }
  }
  return findings;
}

bool conforms(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& f) { return f.grade == Finding::Grade::fail; });
}

}  // namespace harness
