#include "harness/film/exports.h"

#include <cstdint>
#include <cstdio>
#include <sstream>

#include "harness/base/files.h"

namespace harness {
namespace {

std::string numbered(const std::string& name, std::size_t frame, const char* extension) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "-%04zu", frame + 1);
  return name + digits + extension;
}

std::string written(const std::string& path, const std::string& text) {
  check_writable(path);
  write_atomically(path, text);
  return path;
}

std::string obj_text(const Stage& stage, const inextensible::Positions& x) {
  std::ostringstream out;
  out.precision(9);
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    out << "v " << x(0, i) << ' ' << x(1, i) << ' ' << x(2, i) << '\n';
  for (const auto& [a, b, c] : stage.triangles)
    out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  if (stage.triangles.empty()) {
    for (const auto& [a, b] : stage.edges) out << "l " << a + 1 << ' ' << b + 1 << '\n';
  }
  return out.str();
}

// Edges first, as lines, then triangles: VTK numbers the cells of a file in this order.
std::string vtp_text(const Stage& stage, const inextensible::Positions& x) {
  std::ostringstream out;
  out.precision(9);
  const auto array = [&out](const char* type, const char* name, int components, auto&& values) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
        << components << "\" format=\"ascii\">";
    values();
    out << "</DataArray>\n";
  };
  const auto cells = [&](const char* kind, const auto& all) {
    out << '<' << kind << ">\n";
    array("Int32", "connectivity", 1, [&] {
      for (const auto& cell : all) {
        for (const int v : cell) out << v << ' ';
      }
    });
    array("Int32", "offsets", 1, [&] {
      std::size_t end = 0;
      for (const auto& cell : all) out << (end += cell.size()) << ' ';
    });
    out << "</" << kind << ">\n";
  };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<PolyData>\n<Piece NumberOfPoints=\""
      << x.cols() << "\" NumberOfVerts=\"0\" NumberOfLines=\"" << stage.edges.size()
      << "\" NumberOfStrips=\"0\" NumberOfPolys=\"" << stage.triangles.size()
      << "\">\n<CellData>\n";
  array("Float64", "strain", 1, [&] {
    for (const double strain : strains(stage, x)) out << strain << ' ';
    for (std::size_t t = 0; t < stage.triangles.size(); ++t) out << "0 ";
  });
  out << "</CellData>\n<Points>\n";
  array("Float64", "positions", 3, [&] {
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      out << x(0, i) << ' ' << x(1, i) << ' ' << x(2, i) << ' ';
  });
  out << "</Points>\n";
  cells("Lines", stage.edges);
  cells("Polys", stage.triangles);
  out << "</Piece>\n</PolyData>\n</VTKFile>\n";
  return out.str();
}

template <class Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// The header: "POINTCACHE2\0", version 1, points, first frame, frames per sample, samples.
std::string pc2_bytes(const std::vector<inextensible::Positions>& frames) {
  std::string bytes("POINTCACHE2\0", 12);
  append(bytes, std::int32_t{1});
  append(bytes, static_cast<std::int32_t>(frames[0].cols()));
  append(bytes, 0.0F);
  append(bytes, 1.0F);
  append(bytes, static_cast<std::int32_t>(frames.size()));
  for (const inextensible::Positions& frame : frames) {
    for (Eigen::Index i = 0; i < frame.size(); ++i) append(bytes, static_cast<float>(frame(i)));
  }
  return bytes;
}

// The body as a mesh like the cloth.
class Body {
 public:
  explicit Body(const Stage& of) : of_(of) { mesh_.triangles = of.body_triangles; }
  bool stays() const { return !of_.body.empty() && of_.body_poses.empty(); }
  bool moves() const { return !of_.body_poses.empty(); }
  const Stage& stage() const { return mesh_; }
  inextensible::Positions at(std::size_t frame) const { return body_at(of_, frame); }

 private:
  const Stage& of_;
  Stage mesh_;
};

}  // namespace

std::vector<std::string> write_obj(const Recording& recording, const Take& take,
                                   const std::string& folder, const std::string& name) {
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < take.frames.size(); ++i)
    paths.push_back(written(numbered(folder + "/" + name, i, ".obj"),
                            obj_text(recording.stage, take.frames[i])));
  const Body body(recording.stage);
  if (body.stays())
    paths.push_back(written(folder + "/" + name + "-body.obj", obj_text(body.stage(), body.at(0))));
  if (body.moves()) {
    for (std::size_t i = 0; i < take.frames.size(); ++i)
      paths.push_back(written(numbered(folder + "/" + name + "-body", i, ".obj"),
                              obj_text(body.stage(), body.at(i))));
  }
  return paths;
}

std::vector<std::string> write_vtk(const Recording& recording, const Take& take,
                                   const std::string& folder, const std::string& name) {
  std::ostringstream play;
  play << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
          "byte_order=\"LittleEndian\">\n<Collection>\n";
  const auto show = [&](std::size_t frame, int part, const std::string& file) {
    play << "<DataSet timestep=\"" << static_cast<double>(frame) / recording.spec.frames_per_second
         << "\" part=\"" << part << "\" file=\"" << file << "\"/>\n";
  };
  const auto write = [&](const std::string& file, const Stage& stage,
                         const inextensible::Positions& x) {
    written(folder + "/" + file, vtp_text(stage, x));
    return file;
  };
  const Body body(recording.stage);
  std::string body_file;
  if (body.stays()) body_file = write(name + "-body.vtp", body.stage(), body.at(0));
  for (std::size_t i = 0; i < take.frames.size(); ++i) {
    show(i, 0, write(numbered(name, i, ".vtp"), recording.stage, take.frames[i]));
    if (body.moves())
      body_file = write(numbered(name + "-body", i, ".vtp"), body.stage(), body.at(i));
    if (!body_file.empty()) show(i, 1, body_file);
  }
  play << "</Collection>\n</VTKFile>\n";
  return {written(folder + "/" + name + ".pvd", play.str())};
}

std::vector<std::string> write_pc2(const Recording& recording, const Take& take,
                                   const std::string& folder, const std::string& name) {
  std::vector<std::string> paths{
      written(folder + "/" + name + ".obj", obj_text(recording.stage, take.frames[0])),
      written(folder + "/" + name + ".pc2", pc2_bytes(take.frames))};
  const Body body(recording.stage);
  if (body.stays() || body.moves())
    paths.push_back(written(folder + "/" + name + "-body.obj", obj_text(body.stage(), body.at(0))));
  if (body.moves()) {
    std::vector<inextensible::Positions> frames;
    for (std::size_t i = 0; i < take.frames.size(); ++i) frames.push_back(body.at(i));
    paths.push_back(written(folder + "/" + name + "-body.pc2", pc2_bytes(frames)));
  }
  return paths;
}

}  // namespace harness
