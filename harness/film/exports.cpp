#include "harness/film/exports.h"

#include <cstdint>
#include <cstdio>
#include <sstream>

#include "harness/base/files.h"

namespace harness {
namespace {

std::string numbered(const std::string& folder, const std::string& name, std::size_t frame,
                     const char* extension) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "-%04zu", frame + 1);
  return folder + "/" + name + digits + extension;
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

}  // namespace

std::vector<std::string> write_obj(const Recording& recording, const Take& take,
                                   const std::string& folder, const std::string& name) {
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < take.frames.size(); ++i)
    paths.push_back(
        written(numbered(folder, name, i, ".obj"), obj_text(recording.stage, take.frames[i])));
  return paths;
}

std::vector<std::string> write_vtk(const Recording& recording, const Take& take,
                                   const std::string& folder, const std::string& name) {
  std::ostringstream play;
  play << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
          "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t i = 0; i < take.frames.size(); ++i) {
    const std::string path = numbered(folder, name, i, ".vtp");
    written(path, vtp_text(recording.stage, take.frames[i]));
    play << "<DataSet timestep=\"" << static_cast<double>(i) / recording.spec.frames_per_second
         << "\" file=\"" << path.substr(folder.size() + 1) << "\"/>\n";
  }
  play << "</Collection>\n</VTKFile>\n";
  return {written(folder + "/" + name + ".pvd", play.str())};
}

// The header: "POINTCACHE2\0", version 1, points, first frame, frames per sample, samples.
std::vector<std::string> write_pc2(const Recording& recording, const Take& take,
                                   const std::string& folder, const std::string& name) {
  std::string bytes("POINTCACHE2\0", 12);
  append(bytes, std::int32_t{1});
  append(bytes, static_cast<std::int32_t>(take.frames[0].cols()));
  append(bytes, 0.0F);
  append(bytes, 1.0F);
  append(bytes, static_cast<std::int32_t>(take.frames.size()));
  for (const inextensible::Positions& frame : take.frames) {
    for (Eigen::Index i = 0; i < frame.size(); ++i) append(bytes, static_cast<float>(frame(i)));
  }
  return {written(folder + "/" + name + ".obj", obj_text(recording.stage, take.frames[0])),
          written(folder + "/" + name + ".pc2", bytes)};
}

}  // namespace harness
