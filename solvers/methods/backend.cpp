#include "solvers/methods/backend.h"

#include <sstream>
#include <stdexcept>

namespace inextensible {
namespace {

// What is wrong with the value, as the end of a sentence; empty: nothing.
std::string fault_of(const SettingInfo& info, const std::variant<double, std::string>& value) {
  const auto* number = std::get_if<double>(&value);
  const auto* word = std::get_if<std::string>(&value);
  if (info.initial.index() != value.index())
    return number ? " must be a word" : " must be a number";
  const Range& range = info.range;
  const bool fits = number ? range.contains(*number)
                           : std::ranges::find(info.choices, *word) != info.choices.end();
  if (fits) return {};
  std::ostringstream text;
  if (number) {
    text << " is " << *number << ", must be " << (range.whole ? "an integer" : "finite")
         << (range.open ? ", above " : ", at least ") << range.least;
    if (std::isfinite(range.largest))
      text << (range.open ? " and below " : " and at most ") << range.largest;
  } else {
    text << " is '" << *word << "', must be one of: ";
    for (const char* separator = ""; const char* choice : info.choices)
      text << std::exchange(separator, ", ") << choice;
  }
  return text.str();
}

}  // namespace

const char* part_not_taken(const Backend& backend, const Problem& problem) {
  if (problem.shear() && !backend.takes_shear) return "shear springs";
  if (problem.collider() && !backend.takes_collider) return "collider";
  if (!problem.bending().empty() && !backend.takes_bending) return "bending";
  if (problem.has_drag() && !backend.takes_drag) return "drag";
  if (problem.implicit_forces() && !backend.takes_implicit_forces) return "implicit forces";
  return nullptr;
}

bool Range::contains(double number) const {
  if (!std::isfinite(number) || (whole && number != std::floor(number))) return false;
  return open ? number > least && number < largest : number >= least && number <= largest;
}

Settings complete_settings(const Backend& backend, const Settings& given) {
  Settings all;
  for (const SettingInfo& info : backend.settings)
    std::visit([&](auto initial) { all[info.name] = initial; }, info.initial);
  for (const auto& [name, value] : given) {
    const auto info = std::ranges::find(backend.settings, name, &SettingInfo::name);
    const std::string fault =
        info == backend.settings.end() ? " does not exist" : fault_of(*info, value);
    if (!fault.empty())
      throw std::invalid_argument("solver '" + std::string(backend.name) + "': setting '" + name +
                                  "'" + fault);
    all[name] = value;
  }
  return all;
}

}  // namespace inextensible
