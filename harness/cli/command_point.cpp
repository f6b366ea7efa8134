// bench point: runs single points in this process, for bench ab and other programs.

#include "harness/cli/command.h"
#include "harness/points/context.h"

namespace harness {
namespace {

void check_spec(PointSpec& spec) {
  const auto type = checked_scene(spec.scene);
  const SceneParameters parameters = complete_parameters(*type, spec.scene_parameters);
  if (parameters != spec.scene_parameters)
    throw UsageError("'scene_parameters' is " + value_text(spec.scene_parameters) +
                     ", must hold every parameter of the scene: " + json(parameters).dump());
  std::tie(spec.vertices, spec.constraints) = type->counts(parameters);
  check_plain_name(spec.contestant, "'contestant'");
  check_settings(spec.settings, "'settings'", checked_backend(spec.solver, "'solver'"));
  if (!(spec.strain_limit > 0) || !std::isfinite(spec.strain_limit))
    throw UsageError("'strain_limit' is " + json(spec.strain_limit).dump() + ", must be above 0");
  const double duration = parameters.at("duration");
  if (!(spec.step > 0 && spec.step <= duration && duration / spec.step <= most_steps))
    throw UsageError("'step' is " + json(spec.step).dump() +
                     ", must be above 0 s and at most the duration, " + json(duration).dump() +
                     " s");
}

// One point a line; empty lines do not count. All are checked before the first one runs.
std::vector<PointSpec> read_specs(std::istream& in) {
  std::vector<PointSpec> specs;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = "point on line " + std::to_string(number);
    const json given = parse_document(line, where);
    try {
      // These may be omitted from a point that is typed by hand.
      json object{{"contestant", ""}, {"settings", json::object()}};
      object.update(given);
      check_spec(specs.emplace_back(spec_of(object)));
    } catch (const std::exception& error) {
      throw UsageError(where + ": " + error.what());
    }
  }
  if (specs.empty())
    throw UsageError("no point on standard input: give points of a result file, one JSON a line");
  return specs;
}

struct PointVerb {
  int samples = 1;
  RunLimits limits;

  void declare(const Command& command) {
    command.option("--samples", samples, "runs of each, the first one judged; default: 1", "N",
                   {.least = 1, .most = 1000000, .whole = true});
    add_timeout(command, limits.timeout, "60");
  }

  PointResult timed(const PointSpec& spec) const {
    const OutputToError no_output;  // a line printed by the solver would be read as a result
    PointResult point = run_point(spec, limits);
    for (int i = 1; i < samples && point.ok(); ++i) add_sample(point, run_point, limits);
    return point;
  }

  int run() {
    limits.references = ReferenceFolder::usual();
    const std::string fingerprint = counters_fingerprint();
    for (const PointSpec& spec : read_specs(std::cin)) {
      json line = to_json(timed(spec));
      line["counters_fingerprint"] = fingerprint;
      std::cout << compact(line) << std::endl;
    }
    return success;
  }
};

}  // namespace

Action point_verb(const Command& command) { return verb<PointVerb>(command); }

}  // namespace harness
