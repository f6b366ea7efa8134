#include <cstdint>
#include <cstdio>
#include <sstream>

#include "harness/base/files.h"
#include "harness/film/film.h"
#include "harness/judge/mechanics.h"

namespace harness {
namespace {

std::string written(const std::string& path, const std::string& text) {
  check_writable(path);
  write_atomically(path, text);
  return path;
}

// A mesh of a film: the cloth of a run, or the body.
struct Part {
  std::string name;  // of its files
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<int, 2>> edges;
  const inextensible::Problem* problem;  // that owns the edges; null: no edges
  bool stays;                            // does not move: one frame is enough
  std::function<inextensible::Positions(std::size_t frame)> at;

  std::string file(std::size_t frame, const char* extension) const {
    char number[24] = "";
    if (!stays) std::snprintf(number, sizeof number, "-%04zu", frame + 1);
    return name + number + extension;
  }
};

std::string obj_text(const Part& part, const inextensible::Positions& x) {
  std::ostringstream out;
  out.precision(9);
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    out << "v " << x(0, i) << ' ' << x(1, i) << ' ' << x(2, i) << '\n';
  for (const auto& [a, b, c] : part.triangles)
    out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  if (part.triangles.empty()) {
    for (const auto& [a, b] : part.edges) out << "l " << a + 1 << ' ' << b + 1 << '\n';
  }
  return out.str();
}

// Edges first, as lines, then triangles: VTK numbers the cells of a file in this order.
std::string vtp_text(const Part& part, const inextensible::Positions& x) {
  std::vector<double> strains;
  if (part.problem) append_strains(*part.problem, x, strains);
  strains.resize(strains.size() + part.triangles.size());
  std::ostringstream out;
  out.precision(9);
  const auto array = [&out](const char* type, const char* name, int components,
                            const auto& values) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
        << components << "\" format=\"ascii\">";
    for (const auto value : values) out << value << ' ';
    out << "</DataArray>\n";
  };
  const auto cells = [&](const char* kind, const auto& all) {
    std::vector<int> vertices, ends;
    for (const auto& cell : all) {
      vertices.insert(vertices.end(), cell.begin(), cell.end());
      ends.push_back(static_cast<int>(vertices.size()));
    }
    out << '<' << kind << ">\n";
    array("Int32", "connectivity", 1, vertices);
    array("Int32", "offsets", 1, ends);
    out << "</" << kind << ">\n";
  };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<PolyData>\n<Piece NumberOfPoints=\""
      << x.cols() << "\" NumberOfVerts=\"0\" NumberOfLines=\"" << part.edges.size()
      << "\" NumberOfStrips=\"0\" NumberOfPolys=\"" << part.triangles.size() << "\">\n<CellData>\n";
  array("Float64", "strain", 1, strains);
  out << "</CellData>\n<Points>\n";
  array("Float64", "positions", 3, x.reshaped());
  out << "</Points>\n";
  cells("Lines", part.edges);
  cells("Polys", part.triangles);
  out << "</Piece>\n</PolyData>\n</VTKFile>\n";
  return out.str();
}

template <class Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// The run must outlive the parts.
std::vector<Part> parts_of(const Recording& recording, const FilmRun& take,
                           const std::string& name) {
  const inextensible::Problem* problem = recording.scene.problem.get();
  std::vector<Part> parts{
      {name, recording.scene.triangles, {}, problem, false, [&take](std::size_t frame) {
         return take.frames[frame];
       }}};
  for (const auto& [a, b] : problem->edges()) parts[0].edges.push_back({a, b});
  if (!recording.body.vertices.empty())
    parts.push_back({name + "-body",
                     recording.body.triangles,
                     {},
                     nullptr,
                     recording.body_poses.empty(),
                     [&recording](std::size_t frame) { return body_at(recording, frame); }});
  return parts;
}

// The header: "POINTCACHE2\0", version 1, points, first frame, frames per sample, samples.
std::string pc2_bytes(const Part& part, std::size_t frames) {
  std::string bytes("POINTCACHE2\0", 12);
  append(bytes, std::int32_t{1});
  append(bytes, static_cast<std::int32_t>(part.at(0).cols()));
  append(bytes, 0.0F);
  append(bytes, 1.0F);
  append(bytes, static_cast<std::int32_t>(frames));
  for (std::size_t i = 0; i < frames; ++i) {
    const inextensible::Positions x = part.at(i);
    for (Eigen::Index k = 0; k < x.size(); ++k) append(bytes, static_cast<float>(x(k)));
  }
  return bytes;
}

// Writes one file a frame, or one for a body that does not move; returns their paths.
std::vector<std::string> write_frames(const std::vector<Part>& parts, std::size_t frames,
                                      const std::string& folder, const char* extension,
                                      std::string (*text)(const Part&,
                                                          const inextensible::Positions&)) {
  std::vector<std::string> paths;
  for (const Part& part : parts) {
    for (std::size_t i = 0; i < (part.stays ? 1 : frames); ++i)
      paths.push_back(written(folder + "/" + part.file(i, extension), text(part, part.at(i))));
  }
  return paths;
}

// Plays the files of the frames.
std::string pvd_text(const std::vector<Part>& parts, std::size_t frames, double rate) {
  std::ostringstream play;
  play << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
          "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t i = 0; i < frames; ++i) {
    for (std::size_t p = 0; p < parts.size(); ++p)
      play << "<DataSet timestep=\"" << static_cast<double>(i) / rate << "\" part=\"" << p
           << "\" file=\"" << parts[p].file(i, ".vtp") << "\"/>\n";
  }
  play << "</Collection>\n</VTKFile>\n";
  return play.str();
}

}  // namespace

std::vector<std::string> write_run(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name,
                                   const std::string& ending) {
  const std::vector<Part> parts = parts_of(recording, take, name);
  const std::size_t frames = take.frames.size();
  if (ending == ".obj") return write_frames(parts, frames, folder, ".obj", obj_text);
  if (ending == ".pvd") {
    write_frames(parts, frames, folder, ".vtp", vtp_text);
    return {written(folder + "/" + name + ".pvd",
                    pvd_text(parts, frames, recording.spec.frames_per_second))};
  }
  std::vector<std::string> paths;  // .pc2
  for (const Part& part : parts) {
    const std::string path = folder + "/" + part.name;
    paths.push_back(written(path + ".obj", obj_text(part, part.at(0))));
    if (!part.stays) paths.push_back(written(path + ".pc2", pc2_bytes(part, frames)));
  }
  return paths;
}

}  // namespace harness
