#include <iomanip>

#include "harness/base/files.h"
#include "harness/film/film.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/run/measure_point.h"
#include "harness/scenes/mesh_file.h"

namespace harness {
namespace {

// The settings given, and for springs the stiffness that a sweep would find.
Settings calibrated(const FilmSpec& spec, const Contestant& contestant, double limit, double step) {
  const Backend& backend = *find_backend(contestant.solver);
  const int size = static_cast<int>(spec.parameters.at(find_scene(spec.scene)->resolution));
  Settings settings = contestant.settings_for(size, limit);
  if (backend.strain_control != StrainControl::stiffness || settings.contains("stiffness"))
    return settings;
  const PointSpec point{.sweep = "strain",
                        .scene = spec.scene,
                        .scene_parameters = spec.parameters,
                        .solver = contestant.solver,
                        .settings = settings,
                        .strain_limit = limit,
                        .step = step};
  const PointResult found = run_point(point, {.interrupted = interrupted, .timed = false});
  if (found.stiffness) settings["stiffness"] = *found.stiffness;
  return settings;
}

// A step that cannot be solved may cost 100,000 passes, and as many again at each of its halves. A
// run gives up once all its steps, including refused ones, have needed more than this.
constexpr int most_halvings = 8;
constexpr std::int64_t spare_tries = 1000, tries_per_step = 100;
constexpr std::int64_t spare_iterations = 500'000, iterations_per_step = 10'000;

// Why a run must give up after this many steps; "": it need not.
std::string too_much_work(const WorkCounters& work, long steps) {
  const std::int64_t tries = work.steps + work.rejected_steps;
  if (tries > spare_tries + tries_per_step * steps)
    return concat(tries, " tries of steps for ", steps, " steps");
  if (work.iterations > spare_iterations + iterations_per_step * steps)
    return concat(work.iterations, " iterations for ", steps, " steps");
  return "";
}

std::string gave_up(double time, const std::string& why) {
  return "gave up at t = " + number_text(time, 3) + " s: " + why;
}

FilmRun take_of(const FilmSpec& spec, const Scene& scene, const Contestant& contestant,
                double limit, const std::function<void(const FilmRun&)>& told) {
  const double rate = spec.frames_per_second;
  FilmRun take;
  take.solver = contestant.name;
  take.label = label_of(contestant);
  take.strain_limit = limit;
  const int steps_per_frame =
      std::max(1, static_cast<int>(std::ceil(1 / (rate * spec.step) - 1e-9)));
  take.step = take.smallest_step = 1 / (rate * steps_per_frame);
  const auto settings = calibrated(spec, contestant, limit, take.step);
  const Backend& backend = *find_backend(contestant.solver);
  State state = start_of(scene, backend, take.step);
  const auto stepper = make_stepper(contestant.solver, scene.problem, {limit, 1, settings, &state});
  EnergyRecord energy(scene, backend.velocities);
  Clock::time_point begin;
  const auto keep = [&](const State& at) {
    take.frames.push_back(at.x);
    take.largest_strain.push_back(strain_range(*scene.problem, at.x).most);
    told(take);
    begin = Clock::now();
  };
  const auto judge_energy = [&] {
    if (take.energy_gained.empty())
      take.energy_gained = energy_gained(energy, scene.energy_bound, scene.duration);
  };
  const auto go_on = [&](const State& at, const DriveState& driven) {
    const double seconds = since(begin);
    energy.after(at, driven.last);
    judge_energy();
    if (driven.whole && driven.steps % steps_per_frame == 0) {
      take.smallest_step = driven.smallest;
      take.seconds.push_back(seconds);
      keep(at);
    }
    const std::string work = too_much_work(stepper->work(), driven.steps);
    if (!work.empty()) take.detail = gave_up(at.time, work);
    return work.empty();
  };
  keep(state);
  const long steps = steps_per_frame * (static_cast<long>(frames_in(spec)) - 1);
  const DriveState driven = drive(*stepper, state, {take.step, steps, most_halvings}, go_on,
                                  {.interrupted = interrupted});
  if (driven.end == DriveState::End::refused)
    take.detail = gave_up(state.time, driven.result.detail);
  energy.finish();
  judge_energy();
  return take;
}

}  // namespace

Positions body_at(const Recording& recording, std::size_t frame) {
  const Pose pose = recording.body_poses.empty() ? Pose{} : recording.body_poses.at(frame);
  const auto& vertices = recording.body.vertices;
  Positions x(3, vertices.size());
  std::transform(vertices.begin(), vertices.end(), x.colwise().begin(), pose);
  return x;
}

std::size_t frames_in(const FilmSpec& spec) {
  return 1 + static_cast<std::size_t>(
                 std::floor(spec.parameters.at("duration") * spec.frames_per_second + 1e-9));
}

Recording record(const FilmSpec& spec, const std::function<void(const FilmRun&)>& told) {
  Recording recording{spec, find_scene(spec.scene)->build(spec.parameters), {}, {}, {}};
  const Scene& scene = recording.scene;
  const auto* body = dynamic_cast<const inextensible::TriangleCollider*>(scene.problem->collider());
  if (body) recording.body = body->mesh();
  if (const auto& motion = scene.problem->body_motion())
    for (std::size_t i = 0; i < frames_in(spec); ++i)
      recording.body_poses.push_back(
          motion(scene.start.time + static_cast<double>(i) / spec.frames_per_second));
  for (const double limit : spec.strain_limits)
    for (const Contestant& contestant : spec.solvers)
      recording.takes.push_back(take_of(spec, scene, contestant, limit, told));
  return recording;
}

std::vector<std::string> write_meshes(const Recording& recording, const FilmRun& take,
                                      const std::string& folder, const std::string& name) {
  std::vector<std::string> paths;
  const auto write = [&](const std::string& part, const Positions& x, const auto& triangles,
                         const std::vector<Edge>& edges) {
    paths.push_back(concat(folder, "/", name, part, ".obj"));
    check_writable(paths.back());
    write_atomically(paths.back(), obj_text(x, triangles, edges, 9));
  };
  const Scene& scene = recording.scene;
  for (std::size_t i = 0; i < take.frames.size(); ++i) {
    std::ostringstream number;
    number << '-' << std::setw(4) << std::setfill('0') << i + 1;
    write(number.str(), take.frames[i], scene.triangles, scene.problem->edges());
    const bool stays = recording.body_poses.empty();
    if (!recording.body.vertices.empty() && (i == 0 || !stays))
      write("-body" + (stays ? "" : number.str()), body_at(recording, i), recording.body.triangles,
            {});
  }
  return paths;
}

}  // namespace harness
