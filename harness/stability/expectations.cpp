// How hard cases should end, and where methods are known to end otherwise: configs/hard_cases.json.
#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/paths.h"
#include "harness/stability/hard_case.h"

namespace harness {
namespace {

using inextensible::Backend;
using inextensible::Direction;
using nlohmann::json;

constexpr std::pair<const char*, Direction> directions[] = {
    {"start", Direction::start}, {"end", Direction::end},         {"current", Direction::current},
    {"local", Direction::local}, {"springs", Direction::springs},
};

// Whether one of the words of an expectation is about the method.
bool is_about(const std::string& word, const Backend& backend) {
  for (const auto& [name, direction] : directions) {
    if (word == name) return backend.direction == direction;
  }
  if (word == "no collider")
    return !backend.takes_collider && inextensible::is_built_in(backend.name);
  return word == backend.name || word == backend.method ||
         word == std::string("@") + backend.stepper;
}

constexpr const char* cases_file = "configs/hard_cases.json";

const json& cases_document() {
  static const json document =
      parse_commented(read_file(source_path(cases_file), "file of hard cases"), cases_file);
  return document;
}

Outcome outcome_of(const json& name) {
  Outcome outcome{};
  FieldCodec<Outcome>::read(name, outcome, false);
  return outcome;
}

// The list under a case's name, or else under its row; a text names the case whose list applies.
const json& entries_about(const HardCase& hard_case) {
  const json& all = cases_document().at("expectations");
  const json* found = &all.at(all.contains(hard_case.name) ? hard_case.name : hard_case.row);
  while (found->is_string()) found = &all.at(found->get<std::string>());
  return *found;
}

}  // namespace

bool Expectation::about(const Backend& backend) const {
  return solvers.empty() || std::ranges::any_of(solvers, [&](const std::string& word) {
           return is_about(word, backend);
         });
}

void add_expectations(std::vector<HardCase>& cases) {
  for (HardCase& c : cases) {
    for (const json& entry : entries_about(c)) {
      JsonReader reader(entry, cases_file);
      const double above = reader.number("above", -HUGE_VAL, {}),
                   below = reader.number("below", HUGE_VAL, {});
      Expectation expected{{}, outcome_of(entry.at("outcome")), entry.at("why")};
      if (const json* of = reader.find("of"))
        expected.solvers = of->is_array() ? of->get<std::vector<std::string>>()
                                          : std::vector{of->get<std::string>()};
      if (const json* other = reader.find("or"))
        expected.other = Expectation::Other{outcome_of(*other), entry.at("because")};
      for (const char* key : {"outcome", "why", "because"}) reader.find(key);
      reader.finish();
      if (!(c.value <= above || c.value >= below)) c.expectations.push_back(std::move(expected));
    }
  }
}

Expectation HardCase::expectation(const std::string& solver) const {
  const Backend* backend = inextensible::find_backend(solver);
  Expectation expected = *std::ranges::find_if(expectations, [&](const Expectation& e) {
    return backend ? e.about(*backend) : e.solvers.empty();
  });
  if (backend && backend->strain_control == inextensible::StrainControl::time_step &&
      expected.outcome == Outcome::refused && !expected.other)
    expected.other = {Outcome::survived, "no limit is promised, so that it need not be noticed"};
  return expected;
}

const std::vector<KnownDifference>& known_differences() {
  static const std::vector<KnownDifference> differences = [] {
    std::vector<KnownDifference> list;
    for (const json& entry : cases_document().at("known_differences")) {
      const json& cause = cases_document().at("causes").at(entry.at("cause").get<std::string>());
      list.push_back({entry.at("solver"), outcome_of(entry.at("fixed")),
                      outcome_of(entry.at("outcome")), cause.at("reason"), cause.at("remedy"),
                      entry.at("cases")});
    }
    return list;
  }();
  return differences;
}

const KnownDifference* known_difference(const std::string& hard_case, const std::string& solver,
                                        const TrialResult& result) {
  // With smaller steps, after a refusal; which of them it is may be up to the clock.
  const auto harmless = [](Outcome outcome) {
    return outcome == Outcome::refused || outcome == Outcome::survived_smaller ||
           outcome == Outcome::timeout;
  };
  const auto known = std::ranges::find_if(known_differences(), [&](const KnownDifference& one) {
    return solver == one.solver && result.fixed == one.fixed &&
           (result.outcome == one.outcome || (harmless(result.outcome) && harmless(one.outcome))) &&
           std::ranges::count(one.hard_cases, hard_case) > 0;
  });
  return known == known_differences().end() ? nullptr : &*known;
}

}  // namespace harness
