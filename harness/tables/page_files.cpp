// What the result files say of themselves: date, machine, commit and noise.
#include <cmath>

#include "harness/analysis/words.h"
#include "harness/base/text.h"
#include "harness/tables/page.h"

namespace harness::tables {

using nlohmann::json;

namespace {

// Excess of the longer time over the shorter one, from |log ratio|.
std::string noise_cell(const json& noise, const char* key) {
  return noise.is_object() && noise.contains(key) && noise.at(key).is_number()
             ? percent(std::expm1(noise.at(key).get<double>()))
             : std::string("-");
}

}  // namespace

void print_sources(std::ostream& out, const std::vector<NamedResult>& results) {
  out << "A/A: how far apart the times of one solver under two names are, in half of all places at "
         "most and in 95 % of them.\n\n";
  print_head(out, {"file", "date", "processor", "commit", "A/A pair", "places", "half", "95 %"});
  for (const NamedResult& result : results) {
    const json context = result.document.value("context", json::object());
    const json noise = context.value("noise", json());
    const bool pair = noise.is_object() && noise.contains("pair");
    const auto word = [](const json& object, const char* key) { return object.value(key, "-"); };
    print_row(out, {quoted(result.name), word(context, "date"), word(context, "cpu_model"),
                    word(context.value("build", json::object()), "git"),
                    pair ? quoted(noise.at("pair").at(0)) : std::string("-"),
                    pair ? std::to_string(noise.value("places", 0)) : std::string("-"),
                    noise_cell(noise, "median"), noise_cell(noise, "q95")});
  }
}

}  // namespace harness::tables
