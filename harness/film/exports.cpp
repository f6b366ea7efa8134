#include <cstdio>
#include <sstream>

#include "harness/base/files.h"
#include "harness/film/film.h"
#include "harness/judge/trajectory.h"
#include "harness/scenes/mesh_file.h"

namespace harness {
namespace {

// A mesh of a film: the cloth of a run, or the body.
struct Part {
  std::string name;  // of its files
  std::vector<std::array<int, 3>> triangles;
  std::vector<Edge> edges;
  bool stays;  // does not move: one frame is enough
  std::function<Positions(std::size_t frame)> at;

  std::string obj_file(std::size_t frame) const {
    char number[24] = "";
    if (!stays) std::snprintf(number, sizeof number, "-%04zu", frame + 1);
    return name + number + ".obj";
  }
};

template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// The run must outlive the parts.
std::vector<Part> parts_of(const Recording& recording, const FilmRun& take,
                           const std::string& name) {
  std::vector<Part> parts{{name, recording.scene.triangles, recording.scene.problem->edges(), false,
                           [&take](std::size_t frame) { return take.frames[frame]; }}};
  if (!recording.body.vertices.empty())
    parts.push_back({name + "-body",
                     recording.body.triangles,
                     {},
                     recording.body_poses.empty(),
                     [&recording](std::size_t frame) { return body_at(recording, frame); }});
  return parts;
}

std::string pc2_bytes(const Part& part, std::size_t frames) {
  std::string bytes;
  append(bytes, PointCacheHead{.points = static_cast<std::int32_t>(part.at(0).cols()),
                               .samples = static_cast<std::int32_t>(frames)});
  for (std::size_t i = 0; i < frames; ++i) {
    const Positions x = part.at(i);
    for (Eigen::Index k = 0; k < x.size(); ++k) append(bytes, static_cast<float>(x(k)));
  }
  return bytes;
}

}  // namespace

std::vector<std::string> write_run(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name,
                                   const std::string& ending) {
  const std::size_t frames = take.frames.size();
  std::vector<std::string> paths;
  const auto write = [&](const std::string& file, const std::string& content) {
    const std::string path = folder + "/" + file;
    check_writable(path);
    write_atomically(path, content);
    paths.push_back(path);
  };
  for (const Part& part : parts_of(recording, take, name)) {
    if (ending == ".pc2") {
      write(part.name + ".obj", obj_text(part.at(0), part.triangles, part.edges, 9));
      if (!part.stays) write(part.name + ".pc2", pc2_bytes(part, frames));
    } else {
      for (std::size_t i = 0; i < (part.stays ? 1 : frames); ++i)
        write(part.obj_file(i), obj_text(part.at(i), part.triangles, part.edges, 9));
    }
  }
  return paths;
}

}  // namespace harness
