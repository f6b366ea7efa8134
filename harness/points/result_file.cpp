#include "harness/points/result_file.h"

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/json_text.h"
#include "harness/points/noise.h"
#include "harness/points/point_json.h"
#include "harness/points/schema.h"

namespace harness {
namespace {

using nlohmann::json;

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

// How many samples were taken, and how many of them again.
json retaken_samples(const std::vector<PointResult>& points) {
  std::size_t samples = 0;
  int retaken = 0;
  for (const PointResult& point : points) {
    samples += point.samples.size();
    retaken += point.retaken;
  }
  return {{"samples", samples}, {"retaken", retaken}};
}

}  // namespace

json result_document(json context, const Suite& suite, const std::vector<std::string>& command,
                     bool complete, const std::vector<PointResult>& points, json references) {
  context["command"] = command;
  context["suite"] = to_json(suite);
  context["seed"] = suite.seed;
  if (!suite.tuned_file.empty())
    context["tuned"] = {{"file", suite.tuned_file}, {"hash", suite.tuned_hash}};
  const auto noise = pair_noise(points, suite.same);
  if (noise) context["noise"] = to_json(*noise);
  context["retaken_samples"] = retaken_samples(points);
  json list = json::array(), benchmarks = json::array();
  int family = 0;
  for (const PointResult& point : points) {
    list.push_back(to_json(point));
    if (point.ok()) add_benchmarks(benchmarks, point, family++);
  }
  json document = {{"schema", "inextensible-bench/1"},
                   {"complete", complete},
                   {"context", context},
                   {"legend", legend(contestants_of(suite))},
                   {"points", list},
                   {"references", std::move(references)},
                   {"benchmarks", benchmarks}};
  if (const std::string warning = noise ? noise_warning(*noise) : ""; !warning.empty())
    document["warning"] = warning;
  return document;
}

std::string result_text(const json& document) {
  nlohmann::ordered_json ordered;
  for (const char* first : {"warning", "schema", "complete", "context", "legend"})
    if (document.contains(first)) ordered[first] = document.at(first);
  for (const auto& [key, value] : document.items()) ordered[key] = value;
  return document_text(ordered);
}

bool is_timed(const json& document) {
  return document.value(json::json_pointer("/context/timed"), true);
}

json read_result(const std::string& path) {
  return parse_result(read_file(path, "result file"), path);
}

json parse_result(const std::string& text, const std::string& path) {
  json document = parse_document(text, path);
  check_result(document, path);
  return document;
}

json read_answers(const std::string& path) {
  json document = parse_document(read_file(path, "result of bench answers"), path);
  check_schema(document, "answers", path);
  return document;
}

bool is_answers(const json& document) {
  return document.is_object() && document.value("schema", json()) == "inextensible-answers/1";
}

json read_result_or_answers(const std::string& path) {
  json document = parse_document(read_file(path, "result file"), path);
  if (is_answers(document)) {
    check_schema(document, "answers", path);
  } else {
    check_result(document, path);
  }
  return document;
}

void check_result(const json& document, const std::string& path) {
  const json schema = document.is_object() ? document.value("schema", json()) : json();
  if (schema == "inextensible-bench/1") {
    check_schema(document, "result", path);
  } else if (schema == "inextensible-stability/1") {
    check_schema(document, "stability", path);
  } else {
    throw UsageError("'" + path +
                     "' is not a result file: its schema is neither \"inextensible-bench/1\" nor "
                     "\"inextensible-stability/1\"");
  }
}

}  // namespace harness
