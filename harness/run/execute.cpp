#include "harness/run/execute.h"

#include "harness/base/child_process.h"
#include "harness/points/point_json.h"

namespace harness {
namespace {

using End = ChildOutcome::End;

PointResult lost(const PointSpec& spec, const ChildOutcome& outcome, double timeout) {
  const std::string place = outcome.step < 0
                                ? "before the first step"
                                : concat("in step ", outcome.step, " (t = ", outcome.time, " s)");
  PointResult point(spec);
  if (outcome.end == End::timed_out) {
    const bool calibrating = outcome.part == static_cast<int>(RunPart::calibration);
    point.end(calibrating ? PointStatus::skipped : PointStatus::timeout,
              concat(calibrating ? "timed out while calibrating: " : "", "longer than ", timeout,
                     " s, stuck ", place, "; ended with ", signal_text(outcome.code)));
  } else {
    const bool starved = outcome.end == End::killed && outcome.out_of_memory;
    point.end(starved ? PointStatus::out_of_memory : PointStatus::crashed,
              ending(outcome) + " " + place + (starved ? "; the kernel was out of memory" : ""));
  }
  point.peak_rss_bytes = outcome.peak_rss_bytes;
  return point;
}

constexpr const char* repetition_mark = " #";

std::string key_of_repetition(const std::string& key, int i) {
  return key + repetition_mark + std::to_string(i);
}

// Leaves a point of a result file its first sample; lists without an entry for each sample stay.
std::vector<Samples> cut_off_repetitions(PointResult& point) {
  const std::size_t samples = point.samples.size();
  std::vector<Samples> repetitions(samples > 1 ? samples - 1 : 0);
  const auto cut = [&](auto Samples::*member) {
    auto& list = point.*member;
    if (samples < 2 || list.size() != samples) return;
    for (std::size_t i = 1; i < samples; ++i) (repetitions[i - 1].*member).push_back(list[i]);
    list.resize(1);
  };
  cut(&Samples::cpu_samples);
  cut(&Samples::filter_samples);
  cut(&Samples::sample_runs);
  cut(&Samples::samples);
  return repetitions;
}

// A search for a stiffness that began elsewhere (a neighbour failed then, not now) is another run.
bool same_start(const PointResult& point, std::optional<double> guess) {
  if (!point.ok() || !point.stiffness) return true;
  return guess ? *guess == point.calibration_guess : std::isnan(point.calibration_guess);
}

// The parent reads the reference once for all children, so that the result names it.
void find_reference(const RunLimits& limits, const PointSpec& spec) {
  if (limits.references) limits.references->find(spec.scene, spec.scene_parameters);
}

// Consecutive runs are mostly of one scene: the parent builds it for all their children, since
// the grid of a body takes longer than many a run.
class LastScene {
 public:
  // Null: it cannot be built, and the run itself says why.
  const Scene* of(const PointSpec& spec) {
    const std::pair key(spec.scene, spec.scene_parameters);
    if (scene_ && key_ == key) return &*scene_;
    scene_.reset();
    try {
      scene_ = find_scene(spec.scene)->build(spec.scene_parameters);
    } catch (const std::exception&) {  // a file that is gone, or too little memory, too
      return nullptr;
    }
    key_ = key;
    return &*scene_;
  }

 private:
  std::pair<std::string, SceneParameters> key_;
  std::optional<Scene> scene_;
};

}  // namespace

void add_sample(PointResult& point, const Runner& run, RunLimits limits) {
  limits.sample_of = &point;
  append(run(point.spec, limits), point);
}

Runner with_references(const Runner& inner, std::shared_ptr<ReferenceFolder> references) {
  return [=](const PointSpec& spec, RunLimits limits) {
    limits.references = references;
    return inner(spec, limits);
  };
}

Runner isolated(const Runner& inner, double memory) {
  return
      [=, scenes = std::make_shared<LastScene>()](const PointSpec& spec, const RunLimits& limits) {
        find_reference(limits, spec);
        // A limit on memory includes the scene.
        const Scene* scene = memory > 0 ? nullptr : scenes->of(spec);
        return in_child(
            {limits.timeout, memory, limits.interrupted},
            [&](Heartbeat& heartbeat) {
              RunLimits own = limits;
              own.interrupted = nullptr;  // the parent asks
              own.heartbeat = &heartbeat;
              own.scene = scene;
              return to_json(inner(spec, own));
            },
            point_of, [&](const ChildOutcome& child) { return lost(spec, child, limits.timeout); });
      };
}

Runner journaled(const Runner& inner, Journal& journal) {
  const auto samples_of_key = std::make_shared<std::map<std::string, int>>();
  return [=, &journal](const PointSpec& spec, const RunLimits& limits) {
    const std::string key = key_of(spec);
    if (limits.sample_of) {
      const auto take = [&] {
        const Samples taken = inner(spec, limits);
        return to_json(taken);
      };
      const std::string repetition = key_of_repetition(key, ++(*samples_of_key)[key]);
      PointResult more(spec);
      append(samples_of(journal.once(repetition, take)), more);
      return more;
    }
    if (const json* known = journal.find(key)) {
      PointResult point = point_of(*known);
      if (same_start(point, limits.stiffness_guess)) {
        find_reference(limits, spec);
        return point;
      }
      for (int i = 1; journal.find(key_of_repetition(key, i)); ++i)
        journal.forget(key_of_repetition(key, i));
      journal.forget(key);
    }
    PointResult point = inner(spec, limits);
    journal.add(key, to_json(point));
    return point;
  };
}

void add_runs_of(const json& result, Journal& journal) {
  for (const json& entry : result.at("points")) {
    PointResult point = point_of(entry);
    if (point.status == PointStatus::skipped) continue;
    point.best = false;  // to be decided again
    point.best_at_errors.clear();
    point.at_ladder_end.clear();
    const std::vector<Samples> repetitions = cut_off_repetitions(point);
    const std::string key = key_of(point.spec);
    journal.add(key, to_json(point));
    for (std::size_t i = 0; i < repetitions.size(); ++i)
      journal.add(key_of_repetition(key, static_cast<int>(i) + 1), to_json(repetitions[i]));
  }
}

std::size_t points_in(const Journal& journal) {
  return static_cast<std::size_t>(std::ranges::count_if(journal.known(), [](const auto& entry) {
    return entry.first.find(repetition_mark) == std::string::npos;
  }));
}

}  // namespace harness
