#include "solvers/methods/backend.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace inextensible {
namespace {

std::string fault_of(const SettingInfo& info, double number) {
  const Range& range = info.range;
  if (range.contains(number)) return {};
  std::ostringstream text;
  text << " is " << number << ", must be " << (range.whole ? "an integer" : "finite");
  text << (range.open ? ", above " : ", at least ") << range.least;
  if (std::isfinite(range.largest))
    text << (range.open ? " and below " : " and at most ") << range.largest;
  return text.str();
}

std::string fault_of(const SettingInfo& info, const std::string& word) {
  if (std::ranges::find(info.choices, word) != info.choices.end()) return {};
  std::string choices;
  for (const char* choice : info.choices) {
    if (!choices.empty()) choices += ", ";
    choices += choice;
  }
  return " is '" + word + "', must be one of: " + choices;
}

std::string fault_of(const SettingInfo& info, const std::variant<double, std::string>& value) {
  if (info.initial.index() != value.index())
    return value.index() == 0 ? " must be a word" : " must be a number";
  return std::visit([&info](const auto& v) { return fault_of(info, v); }, value);
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

double BackendOptions::number(const char* name) const {
  return std::get<double>(settings.at(name));
}

int BackendOptions::count(const char* name) const { return static_cast<int>(number(name)); }

const std::string& BackendOptions::word(const char* name) const {
  return std::get<std::string>(settings.at(name));
}

Settings complete_settings(const Backend& backend, const Settings& given) {
  Settings all;
  for (const SettingInfo& info : backend.settings) {
    std::visit([&](auto initial) { all[info.name] = initial; }, info.initial);
  }
  for (const auto& [name, value] : given) {
    const auto info = std::ranges::find(backend.settings, name, &SettingInfo::name);
    const std::string fault =
        info == backend.settings.end() ? " does not exist" : fault_of(*info, value);
    if (!fault.empty()) {
      throw std::invalid_argument("solver '" + std::string(backend.name) + "': setting '" + name +
                                  "'" + fault);
    }
    all[name] = value;
  }
  return all;
}

}  // namespace inextensible
