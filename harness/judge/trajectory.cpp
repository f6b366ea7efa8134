#include "harness/judge/trajectory.h"

#include "harness/base/files.h"
#include "harness/judge/mechanics.h"
#include "harness/scenes/mesh_file.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {
namespace {

struct Frames {
  Path path;
  std::vector<double> times = {};  // s; empty: the file does not say
};

Frames frames_of_npz(const std::string& path) {
  const NumberArrays arrays = read_npz(path);
  if (!arrays.contains("positions"))
    throw UsageError("'" + path + "' has no array 'positions' (frames x vertices x 3)");
  Frames frames{path_of(arrays.at("positions"), path)};
  if (arrays.contains("times")) frames.times = arrays.at("times").values;
  return frames;
}

// The number at the end of a file's name; -1: none.
long number_at_end(const std::string& file) {
  const std::string stem = std::filesystem::path(file).stem().string();
  const std::size_t begin = stem.find_last_not_of("0123456789") + 1;
  return begin < stem.size() ? std::stol(stem.substr(begin)) : -1;
}

Frames frames_of_objs(const std::vector<std::string>& files) {
  Frames frames;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const long number = number_at_end(files[k]);
    if (k > 0 && number != number_at_end(files[k - 1]) + 1)
      throw UsageError("frames are missing between '" + files[k - 1] + "' and '" + files[k] + "'");
    const MeshFile mesh = read_mesh_file(files[k]);
    Positions x(3, mesh.vertices.size());
    std::copy(mesh.vertices.begin(), mesh.vertices.end(), x.colwise().begin());
    frames.path.push_back(std::move(x));
  }
  return frames;
}

Frames frames_of(const std::vector<std::string>& files) {
  const auto all_end = [&](const char* ending) {
    return std::ranges::all_of(files, [&](const std::string& f) { return f.ends_with(ending); });
  };
  if (files.size() == 1 && all_end(".npz")) return frames_of_npz(files[0]);
  if (!files.empty() && all_end(".obj")) return frames_of_objs(files);
  throw UsageError("a trajectory is one .npz file or numbered .obj files");
}

double diagonal(const Positions& x) {
  return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
}

// Throws UsageError unless the first frame is the scene's start.
void check_first(const std::string& file, const Positions& first, const Scene& scene) {
  constexpr double close = 1e-3;  // of the scene's size: single precision and rounding pass
  const Positions& start = scene.start.x;
  const double distance = max_distance(scene, first, start);
  if (distance <= close) return;
  const double scale = diagonal(first) / diagonal(start);
  if (scale > 5 || scale < 0.2)
    throw UsageError(concat("'", file, "': positions are ", number_text(scale, 3),
                            " times as large as the scene's; they must be in metres"));
  throw UsageError(concat("'", file, "': the first frame is ", number_text(distance, 3),
                          " of the scene's size off its start (cloth.obj): another mesh, another "
                          "order of vertices, or other axes"));
}

class Playback final : public Stepper {
 public:
  Playback(std::shared_ptr<const Problem> problem, std::shared_ptr<const Trajectory> trajectory)
      : Stepper(std::move(problem), false), trajectory_(std::move(trajectory)) {}

 private:
  StepResult solve(const State&, double, Positions& x) override {
    if (++frame_ >= trajectory_->frames.size())
      return {Status::not_converged, 0, -1, 0, "the trajectory has ended"};
    x = trajectory_->frames[frame_];
    return {};
  }

  std::shared_ptr<const Trajectory> trajectory_;
  std::size_t frame_ = 0;
};

}  // namespace

Trajectory read_trajectory(const std::vector<std::string>& files, const Scene& scene, double rate) {
  Frames frames = frames_of(files);
  const std::string& file = files.front();
  const auto in_frame = [&](std::size_t k) {
    return files.size() > 1 ? "'" + files[k] + "'" : concat("'", file, "', frame ", k + 1);
  };
  for (std::size_t k = 0; k < frames.path.size(); ++k) {
    const Positions& x = frames.path[k];
    if (x.cols() != scene.problem->vertices())
      throw UsageError(concat(in_frame(k), " has ", x.cols(), " vertices, the scene has ",
                              scene.problem->vertices()));
    if (!x.allFinite()) throw UsageError(in_frame(k) + " has positions that are not finite");
  }
  std::vector<double>& times = frames.times;
  if (rate > 0) {
    if (!times.empty()) throw UsageError("'" + file + "' has times of its own; leave out --fps");
    times.resize(frames.path.size());
    for (std::size_t k = 0; k < times.size(); ++k) times[k] = static_cast<double>(k) / rate;
  }
  if (times.empty()) throw UsageError("'" + file + "' has no times: give --fps, frames a second");
  if (times.size() != frames.path.size() || times.size() < 2)
    throw UsageError(concat("'", file, "' has ", frames.path.size(), " frames and ", times.size(),
                            " times; two frames or more are needed, and a time for each"));
  if (times.front() > 1e-9) {  // the start may be left out
    times.insert(times.begin(), 0);
    frames.path.insert(frames.path.begin(), scene.start.x);
  }
  const double interval = times[1] - times[0];
  for (std::size_t k = 1; k < times.size(); ++k)
    if (!(interval > 0) || std::abs(times[k] - times[k - 1] - interval) > 1e-3 * interval)
      throw UsageError(concat(in_frame(k), " is at ", times[k], " s, ", times[k] - times[k - 1],
                              " s after the frame before it; frames must be equally spaced"));
  check_first(file, frames.path.front(), scene);
  if (times.back() < scene.duration - 0.5 * interval)
    throw UsageError(concat("'", file, "' ends at ", times.back(), " s, the scene at ",
                            scene.duration, " s: frames are missing"));
  if (times.back() > 1.5 * scene.duration + interval)
    throw UsageError(concat("'", file, "' lasts ", times.back(), " s, the scene ", scene.duration,
                            " s; times are in seconds, and --fps is in frames a second"));
  return {interval, std::move(frames.path)};
}

Backend playback(const char* name, const char* label,
                 std::shared_ptr<const Trajectory> trajectory) {
  return {.name = name,
          .summary = "a trajectory that another program made; its time is as reported",
          .strain_control = StrainControl::time_step,
          .make =
              [trajectory](std::shared_ptr<const Problem> problem,
                           const inextensible::BackendOptions&) {
                return std::make_unique<Playback>(std::move(problem), trajectory);
              },
          .label = label};
}

std::string worst_places(const Trajectory& trajectory, const Scene& scene) {
  const Problem& problem = *scene.problem;
  inextensible::ContactPlane plane{};
  inextensible::WorkCounters unused;
  struct Worst {
    double value = 0, time = 0;
    long place = -1;
    void raise(double candidate, double at, long where) {
      if (candidate > value) *this = {candidate, at, where};
    }
  } strain, depth, pin;
  for (std::size_t k = 0; k < trajectory.frames.size(); ++k) {
    const Positions& x = trajectory.frames[k];
    const double time = static_cast<double>(k) * trajectory.interval;
    const StrainRange range = strain_range(problem, x);
    strain.raise(range.most, time, static_cast<long>(range.edge));
    const Pose pose = problem.body_motion() ? problem.body_motion()(time) : Pose{};
    for (Eigen::Index v = 0; problem.collider() && v < x.cols(); ++v) {
      const Eigen::Vector3d at = pose.inverse()(x.col(v));
      if (problem.collider()->plane_at(at, plane, unused))
        depth.raise(plane.offset - plane.normal.dot(at), time, v);
    }
    if (problem.pins_follow_body()) continue;
    for (const int v : problem.pinned())
      pin.raise((x.col(v) - scene.start.x.col(v)).norm(), time, v);
  }
  std::string text;
  const auto add = [&](const Worst& worst, const std::string& what) {
    if (worst.value > 1e-6 * scene.size)
      text += what + concat(", at t = ", number_text(worst.time, 4), " s\n");
  };
  if (strain.place >= 0) {
    const auto [a, b] = problem.edges()[static_cast<std::size_t>(strain.place)];
    add(strain, concat("largest strain: ", number_text(100 * strain.value, 3),
                       " % of the edge between vertices ", a + 1, " and ", b + 1));
  }
  add(depth, concat("deepest in the body: vertex ", depth.place + 1, ", ",
                    number_text(1e3 * depth.value, 3), " mm"));
  add(pin, concat("pinned vertex ", pin.place + 1, " has moved by ",
                  number_text(1e3 * pin.value, 3), " mm"));
  return text;
}

}  // namespace harness
