// How hard cases should end, and where methods are known to end otherwise: configs/hard_cases.json.
#include "harness/base/files.h"
#include "harness/points/schema.h"
#include "harness/stability/hard_case.h"

namespace harness {
namespace {

using inextensible::Direction;

constexpr std::pair<const char*, Direction> directions[] = {
    {"start", Direction::start}, {"end", Direction::end},         {"current", Direction::current},
    {"local", Direction::local}, {"springs", Direction::springs},
};

bool is_about(const std::string& word, const Backend& backend) {
  for (const auto& [name, direction] : directions)
    if (word == name) return backend.direction == direction;
  if (word == "no collider")
    return !backend.takes_collider && inextensible::is_built_in(backend.name);
  return word == backend.name || word == backend.method ||
         word == std::string("@") + backend.stepper;
}

// The list under a case's name, or else under its row; a text names the case whose list applies.
const json& entries_about(const HardCase& hard_case) {
  const json& all = hard_cases_document().at("expectations");
  const json* found = &all.at(all.contains(hard_case.name) ? hard_case.name : hard_case.row);
  while (found->is_string()) found = &all.at(found->get<std::string>());
  return *found;
}

}  // namespace

const json& hard_cases_document() {
  static const json document = [] {
    const std::string file = "configs/hard_cases.json";
    json read = parse_document(read_file(source_path(file), "file of hard cases"), file);
    check_schema(read, "hard_cases", file);
    return read;
  }();
  return document;
}

bool Expectation::about(const Backend& backend) const {
  return solvers.empty() || std::ranges::any_of(solvers, [&](const std::string& word) {
           return is_about(word, backend);
         });
}

void add_expectations(std::vector<HardCase>& cases) {
  for (HardCase& c : cases)
    for (const json& entry : entries_about(c)) {
      if (c.value <= entry.value("above", -HUGE_VAL) || c.value >= entry.value("below", HUGE_VAL))
        continue;
      Expectation& expected = c.expectations.emplace_back();
      const json of = entry.value("of", json::array());
      expected.solvers =
          of.is_string() ? std::vector{of.get<std::string>()} : of.get<std::vector<std::string>>();
      expected.outcome = entry.at("outcome");
      expected.why = entry.at("why");
      if (entry.contains("or")) expected.other = {entry.at("or"), entry.at("because")};
    }
}

Expectation HardCase::expectation(const std::string& solver) const {
  const Backend& backend = *find_backend(solver);
  Expectation expected =
      *std::ranges::find_if(expectations, [&](const Expectation& e) { return e.about(backend); });
  if (backend.strain_control == StrainControl::time_step && expected.outcome == Outcome::refused &&
      !expected.other)
    expected.other = {Outcome::survived, "no limit is promised, so that it need not be noticed"};
  return expected;
}

const std::vector<KnownDifference>& known_differences() {
  static const std::vector<KnownDifference> differences = [] {
    std::vector<KnownDifference> list;
    for (const json& entry : hard_cases_document().at("known_differences")) {
      const json& cause =
          hard_cases_document().at("causes").at(entry.at("cause").get<std::string>());
      list.push_back({entry.at("solver"), entry.at("fixed"), entry.at("outcome"),
                      cause.at("reason"), cause.at("remedy"), entry.at("cases")});
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
