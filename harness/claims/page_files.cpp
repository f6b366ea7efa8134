// What the result files say of themselves: tuned settings, noise, date and machine.
#include <algorithm>
#include <cmath>
#include <set>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/claims/page.h"
#include "harness/points/point_json.h"
#include "harness/points/tuned.h"

namespace harness::claims {

using nlohmann::json;

namespace {

std::string settings_words(const inextensible::Settings& settings) {
  std::string words;
  const json all = to_json(settings);
  for (const auto& [name, value] : all.items())
    words += (words.empty() ? "" : ", ") + quoted(name) + " " +
             (value.is_number() ? number_text(value.get<double>()) : value.get<std::string>());
  return words.empty() ? "defaults" : words;
}

// Of a |log ratio|: by how much the longer time is longer.
std::string noise_cell(const json& noise, const char* key) {
  return noise.is_object() && noise.contains(key) && noise.at(key).is_number()
             ? percent(std::expm1(noise.at(key).get<double>()))
             : std::string("-");
}

}  // namespace

void print_tuned(std::ostream& out, const std::vector<NamedResult>& results) {
  std::set<std::pair<std::string, std::string>> files;  // and the hash of what they said
  for (const NamedResult& result : results) {
    const json tuned = result.document.value("context", json::object()).value("tuned", json());
    if (tuned.is_object()) files.emplace(tuned.at("file"), tuned.value("hash", ""));
  }
  if (files.empty()) return;
  std::vector<Tuned> all;
  all.reserve(files.size());
  for (const auto& [file, hash] : files) all.push_back(read_tuned(file));
  if (std::all_of(all.begin(), all.end(), [](const Tuned& t) { return t.entries.empty(); })) return;
  out << "## Tuned settings\n\nFound by `bench tune`, by one rule and with one budget for all, on "
         "scenes that no table shows. Gain: time at default settings over that with these, "
         "geometric mean over the tuning scenes.\n\n";
  for (const auto& [file, hash] : files) {
    const Tuned tuned = read_tuned(file);
    if (!hash.empty() && tuned.hash != hash)
      out << "`" << file << "` is not what it was when some of these files were measured.\n\n";
    print_head(out, {"scenes", "solver", "settings", "gain", "sets tried"});
    for (const TunedEntry& entry : tuned.entries)
      print_row(out, {entry.kind, quoted(entry.solver), settings_words(entry.settings),
                      number_text(entry.gain, 3), std::to_string(entry.evaluations)});
    out << '\n';
  }
}

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

}  // namespace harness::claims
