#include "harness/points/result_file.h"

#include <set>

#include "harness/base/files.h"
#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/points/schema.h"

namespace harness {
namespace {

using Pointer = json::json_pointer;

// Measured numbers to six digits, which is more than repeats.
void round_all(json& value) {
  if (value.is_number_float()) value = rounded_to(value.get<double>());
  if (value.is_structured()) std::ranges::for_each(value, round_all);
}

// One entry a repetition, in Google Benchmark's own format; compare.py reads them.
void add_benchmarks(json& list, const PointResult& point, int family) {
  for (std::size_t i = 0; i < point.samples.size(); ++i) {
    const double microseconds = point.samples[i] * 1e6;
    list.push_back(
        {{"name", point.spec.id()},
         {"run_name", point.spec.id()},
         {"run_type", "iteration"},
         {"family_index", family},
         {"per_family_instance_index", 0},
         {"repetitions", point.samples.size()},
         {"repetition_index", i},
         {"threads", 1},
         {"iterations", i < point.sample_runs.size() ? point.sample_runs[i] : 1},
         {"real_time", microseconds},
         {"cpu_time", i < point.cpu_samples.size() ? point.cpu_samples[i] * 1e6 : microseconds},
         {"time_unit", "us"}});
  }
}

void add_rows(json& all, const json& more, const json& again, std::set<std::string>& taken) {
  std::set<std::string> here;
  for (const json& row : more) {
    if (!again.is_null() && row.value("contestant", json()) == again) continue;
    json owner;  // what a search for a best step has in common; of a hard case: case and solver
    for (const char* key : {"case", "sweep", "scene", "scene_parameters", "vertices", "contestant",
                            "solver", "strain_limit"})
      owner.push_back(row.value(key, json()));
    if (taken.contains(owner.dump())) continue;
    here.insert(owner.dump());
    all.push_back(row);
  }
  taken.merge(here);
}

// Entries whose name is new.
void add_named(json& all, const json& more) {
  for (const json& entry : more)
    if (std::ranges::none_of(all, [&](const json& one) { return one["name"] == entry["name"]; }))
      all.push_back(entry);
}

// Texts of a file as they may be printed anywhere.
void make_harmless(json& value) {
  if (value.is_string()) value = harmless(value.get_ref<const std::string&>());
  if (value.is_structured()) std::ranges::for_each(value, make_harmless);
}

// What no run can have measured, as "is ..."; empty: nothing.
std::string impossible(const json& point) {
  const auto number = [](const json& object, const char* key) {
    const json value = object.value(key, json());
    return value.is_number() ? value.get<double>() : std::nan("");
  };
  const bool ok = point.at("status") == "ok";
  if (point.at("best").get<bool>() && !ok) return "is a best one, but did not end well";
  constexpr double rounding = 1 + 1e-5;
  if (ok && number(point, "max_strain") > number(point, "strain_limit") * rounding)
    return "ended well with more strain than its limit";
  for (const char* error : {"trajectory", "trajectory_mean", "trajectory_max"})
    if (number(point.at("error"), error) < 0) return "has a negative error";
  const json& times = point.at("seconds_per_simulated_second");
  if (times.is_null()) return "";
  const auto samples = times.at("samples").get<std::vector<double>>();
  if (samples.empty()) return "";
  const auto [least, most] = std::ranges::minmax(samples);
  if (!(least > 0)) return "has a time that is not positive";
  const auto fits = [&, scale = most](const char* key, double value) {
    return std::abs(number(times, key) - value) <= 2 * (rounding - 1) * scale;
  };
  if (!fits("min", least) || !fits("median", quantile(samples, 0.5)) ||
      !fits("q1", quantile(samples, 0.25)) || !fits("q3", quantile(samples, 0.75)))
    return "has times that are not those of its samples";
  return "";
}

void check_points(const json& document, const std::string& path) {
  std::set<std::string> ids;
  for (const json& point : document.at("points")) {
    const std::string id = point.at("id").get<std::string>();
    std::string why = impossible(point);
    if (!ids.insert(id + point.at("sweep").dump() + point.at("scene_parameters").dump()).second)
      why = "is there twice";
    if (!why.empty())
      throw UsageError("'" + path + "' cannot be a result: point '" + shortened(id) + "' " + why);
  }
}

}  // namespace

json row_of(PointResult point) {
  point.measures.error_levels = levels_of_series(point.measures);
  point.measures.error_series.clear();
  for (auto* times : {&point.samples, &point.cpu_samples, &point.filter_samples})
    for (double& seconds : *times) seconds = rounded_to(seconds);  // quantiles are of these
  json row = to_json(point);
  for (const char* measured :
       {"seconds_per_simulated_second", "filter_seconds_per_simulated_second",
        "cpu_seconds_per_simulated_second", "frame_times", "occasions", "phases", "error", "sag",
        "p99_strain", "rms_strain", "max_strain_after_collision", "kinetic_energy_mean",
        "rest_speed", "setup_seconds"})
    round_all(row.at(measured));
  return row;
}

json result_document(json context, const Suite& suite, const std::vector<std::string>& command,
                     bool complete, const std::vector<PointResult>& points, json references) {
  context["command"] = command;
  context["suite"] = to_json(suite);
  context["seed"] = suite.seed;
  if (!suite.tuned_file.empty())
    context["tuned"] = {{"file", suite.tuned_file}, {"hash", suite.tuned_hash}};
  const auto noise = pair_noise(points, suite.same);
  if (noise) context["noise"] = *noise;
  json list = json::array(), benchmarks = json::array();
  std::size_t samples = 0;
  int family = 0, retaken = 0;
  for (const PointResult& point : points) {
    samples += point.samples.size();
    retaken += point.retaken;
    list.push_back(row_of(point));
    if (point.best_somewhere() || (point.ok() && point.spec.sweep == "step"))
      add_benchmarks(benchmarks, point, family++);
  }
  context["retaken_samples"] = {{"samples", samples}, {"retaken", retaken}};
  json document = {{"schema", "inextensible-bench/1"},
                   {"complete", complete},
                   {"context", context},
                   {"legend", legend(contestants_of(suite))},
                   {"points", list},
                   {"references", std::move(references)},
                   {"benchmarks", benchmarks}};
  if (const std::string why = noise ? why_not_quotable(*noise) : ""; !why.empty())
    document["warning"] = "noisy: " + why;
  return document;
}

std::string why_not_quotable(const PairNoise& noise) {
  if (noise.q95 <= quotable_noise) return "";
  return concat("equal programs differ by ", number_text(100 * std::expm1(noise.q95), 2),
                " % here, more than the ", 100 * quotable_noise,
                " % that a result to be quoted may have");
}

std::string result_text(const json& document) {
  nlohmann::ordered_json ordered;
  for (const char* first : {"warning", "schema", "complete", "context", "legend"})
    if (document.contains(first)) ordered[first] = document.at(first);
  for (const auto& [key, value] : document.items()) ordered[key] = value;
  return document_text(ordered);
}

bool is_timed(const json& document) { return document.value(Pointer("/context/timed"), true); }

bool is_answers(const json& document) {
  return document.is_object() && document.value("schema", json()) == "inextensible-answers/1";
}

void check_result(const json& document, const std::string& path, ResultKinds kinds) {
  constexpr std::pair<const char*, const char*> schemas[] = {
      {"inextensible-answers/1", "answers"},
      {"inextensible-bench/1", "result"},
      {"inextensible-stability/1", "stability"}};
  std::span<const std::pair<const char*, const char*>> permitted(schemas);
  if (kinds == ResultKinds::answers) permitted = permitted.first(1);
  if (kinds == ResultKinds::sweeps) permitted = permitted.subspan(1);
  const json name = document.is_object() ? document.value("schema", json()) : json();
  std::string names;
  for (const auto& [full_name, schema] : permitted) {
    if (name == full_name) {
      check_schema(document, schema, path);
      if (document.contains("points")) check_points(document, path);
      return;
    }
    names += (names.empty() ? "\"" : ", \"") + std::string(full_name) + "\"";
  }
  throw UsageError("'" + path + "' is not a result file: its schema is " + value_text(name) +
                   ", must be " + (permitted.size() > 1 ? "one of " : "") + names);
}

json parse_result(const std::string& text, const std::string& path, ResultKinds kinds) {
  json document = parse_document(text, path);
  check_result(document, path, kinds);
  make_harmless(document);
  return document;
}

json read_result(const std::string& path, ResultKinds kinds) {
  return parse_result(read_file(path, "result file"), path, kinds);
}

std::optional<PairNoise> pair_noise(const std::vector<PointResult>& points,
                                    const std::string& one) {
  PairNoise noise{{one, double_of(one)}};
  // Best points, by what they are best at; in a step sweep every point.
  const auto by_place = [&](const std::string& contestant) {
    std::map<std::string, const PointResult*> places;
    for (const PointResult& point : points) {
      if (!point.ok() || point.samples.empty() || point.spec.contestant != contestant) continue;
      PointSpec place = point.spec;
      place.contestant = place.solver = "";
      place.settings.clear();
      if (place.sweep != "step") place.step = 0;
      const std::string key = key_of(place);
      if (point.best || place.sweep == "step") places[key] = &point;
      for (const double level : point.best_at_errors)
        if (place.sweep != "step") places[key + number_text(level)] = &point;
    }
    return places;
  };
  const auto first = by_place(noise.pair[0]);
  std::set<std::pair<const PointResult*, const PointResult*>> pairs;
  for (const auto& [place, point] : by_place(noise.pair[1]))
    if (const auto twin = first.find(place); twin != first.end())
      pairs.emplace(twin->second, point);
  std::vector<double> distances;
  distances.reserve(pairs.size());
  for (const auto& [twin, point] : pairs)
    distances.push_back(std::abs(std::log(point->seconds() / twin->seconds())));
  if (distances.empty()) return {};
  noise.places = static_cast<int>(distances.size());
  noise.median = quantile(distances, 0.5);
  noise.q95 = quantile(distances, 0.95);
  return noise;
}

std::optional<PairNoise> noise_of(const json& context) {
  if (!context.contains("noise")) return {};
  return context.at("noise").get<PairNoise>();
}

json joined(const std::vector<json>& documents) {
  json all = documents.front();
  all["complete"] = std::ranges::all_of(
      documents, [](const json& document) { return document.value("complete", true); });
  if (documents.size() == 1) return all;
  const bool sweep = all.contains("points");
  const char* rows = sweep ? "points" : "matrix";
  const Pointer q95("/context/noise/q95"), again("/context/noise/pair/1"),
      legend("/legend/solvers"), between("/context/scatter");
  all.erase("benchmarks");
  all[rows] = json::array();
  double noise = std::nan("");
  std::set<std::string> taken;
  for (const json& document : documents) {
    if (document.value("schema", "") != all.value("schema", ""))
      throw UsageError("results of different kinds of sweeps cannot be combined into one table");
    const json own = document.value(q95, json()), scatter = document.value(between, json());
    const std::size_t before = all[rows].size();
    add_rows(all[rows], document.at(rows), document.value(again, json()), taken);
    for (std::size_t i = before; i < all[rows].size(); ++i) {
      if (own.is_number()) all[rows][i]["noise"] = own;
      if (scatter.is_number()) all[rows][i]["scatter"] = scatter;
    }
    if (document.contains(legend)) add_named(all[legend], document.at(legend));
    if (document.contains("references")) add_named(all["references"], document.at("references"));
    if (own.is_number()) noise = std::fmax(noise, own.get<double>());
    if (!is_timed(document)) all["context"]["timed"] = false;
    if (sweep || &document == &documents.front()) continue;
    for (const char* list : {"largest_steps", "degrees_of_freedom", "same_frame"})
      all[list].insert(all[list].end(), document.at(list).begin(), document.at(list).end());
    for (auto& [name, count] : all["counts"].items())
      count = count.get<long>() + document.at("counts").at(name).get<long>();
  }
  if (std::isfinite(noise)) all[q95] = noise;
  return all;
}

json read_results(const std::vector<std::string>& paths) {
  std::vector<json> documents;
  documents.reserve(paths.size());
  for (const std::string& path : paths) documents.push_back(read_result(path));
  return joined(documents);
}

}  // namespace harness
