#include "harness/scenes/mesh_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/text.h"

namespace harness {
namespace {

// Those of the format that say nothing about vertices, faces and lines.
constexpr std::string_view left_out[] = {
    "vt",       "vn",       "vp",   "g",     "o",     "s",    "mg",   "usemtl",     "mtllib",
    "usemap",   "maplib",   "lod",  "bevel", "p",     "deg",  "bmat", "step",       "cstype",
    "curv",     "curv2",    "surf", "con",   "parm",  "trim", "hole", "scrv",       "sp",
    "c_interp", "d_interp", "end",  "ctech", "stech", "call", "csh",  "shadow_obj", "trace_obj"};

// "7", "7/1/3", "7//3", "-1": corners count from 1, or backwards from the last vertex so far.
int corner_of(const std::string& word, std::size_t vertices, const std::string& where) {
  char* rest = nullptr;
  const long number = std::strtol(word.c_str(), &rest, 10);
  if (rest == word.c_str() || (*rest != '\0' && *rest != '/'))
    throw UsageError(where + ": '" + shortened(word) +
                     "' is not a corner of a face, such as 7 or 7/1/3");
  const auto count = static_cast<long>(vertices);
  const long index = number < 0 ? count + number : number - 1;
  if (number == 0 || index < 0 || index >= count)
    throw UsageError(concat(where, ": no vertex ", number, " among the ", count, " so far"));
  return static_cast<int>(index);
}

// The next line without its comment, and with those that it is continued by.
bool next_line(std::istream& file, std::string& line, int& number) {
  line.clear();
  for (std::string part; std::getline(file, part);) {
    ++number;
    while (!part.empty() && (part.back() == '\r' || part.back() == ' ')) part.pop_back();
    const bool goes_on = part.ends_with('\\');
    if (goes_on) part.back() = ' ';
    line += part;
    if (goes_on && file.peek() != std::istream::traits_type::eof()) continue;
    line.erase(std::min(line.find('#'), line.size()));
    return true;
  }
  return false;
}

void read_line(std::istringstream words, const std::string& where, int line, MeshFile& mesh) {
  std::string word;
  words >> word;
  if (word == "v") {
    Eigen::Vector3d v;
    words >> v.x() >> v.y() >> v.z();
    if (!words || !v.allFinite()) throw UsageError(where + ": a vertex needs three numbers");
    mesh.vertices.push_back(v);
  } else if (word == "f") {
    MeshFile::Face& face = mesh.faces.emplace_back(MeshFile::Face{{}, line});
    while (words >> word) face.corners.push_back(corner_of(word, mesh.vertices.size(), where));
    if (face.corners.size() < 3) throw UsageError(where + ": a face needs three corners or more");
  } else if (word == "l") {
    for (int before = -1, corner = 0; words >> word; before = corner) {
      corner = corner_of(word, mesh.vertices.size(), where);
      if (before >= 0) mesh.ropes.push_back({before, corner});
    }
  } else if (!word.empty() && std::ranges::find(left_out, word) == std::end(left_out)) {
    throw UsageError(where + ": '" + shortened(word) + "' is no keyword of an OBJ file");
  }
}

}  // namespace

std::string MeshFile::name(const Face& face) const {
  const auto same = [&](const Face& other) { return other.line == face.line; };
  return "'" + path + "', face " +
         std::to_string(std::ranges::find_if(faces, same) - faces.begin() + 1) + " (line " +
         std::to_string(face.line) + ")";
}

MeshFile read_mesh_file(const std::string& path) {
  std::string content = read_file(path, "mesh");
  if (content.starts_with("\xEF\xBB\xBF")) content.erase(0, 3);
  std::istringstream file(content);
  MeshFile mesh{path, {}, {}};
  int number = 0;
  for (std::string line; next_line(file, line, number);)
    read_line(std::istringstream(line), "'" + path + "', line " + std::to_string(number), number,
              mesh);
  if (mesh.faces.empty() && mesh.ropes.empty())
    throw UsageError("'" + path +
                     "' has no faces and no lines: is it a mesh in Wavefront's OBJ format?");
  return mesh;
}

std::string obj_text(const Eigen::Matrix3Xd& x, const std::vector<std::array<int, 3>>& triangles,
                     const std::vector<inextensible::Edge>& edges, int digits) {
  std::ostringstream out;
  out.precision(digits);
  for (const auto& v : x.colwise()) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& [a, b, c] : triangles)
    out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  if (triangles.empty()) {
    for (const auto& [a, b] : edges) out << "l " << a + 1 << ' ' << b + 1 << '\n';
  }
  return out.str();
}

void weld(MeshFile& file, double distance) {
  using Cell = std::array<long, 3>;
  std::map<Cell, std::vector<int>> in_cell;
  const auto cell_of = [&](const Eigen::Vector3d& x) {
    return Cell{std::lround(x.x() / distance), std::lround(x.y() / distance),
                std::lround(x.z() / distance)};
  };
  std::vector<int> first(file.vertices.size());
  for (std::size_t v = 0; v < first.size(); ++v) {
    const Cell at = cell_of(file.vertices[v]);
    first[v] = static_cast<int>(v);
    for (int k = 0; k < 27 && first[v] == static_cast<int>(v); ++k) {
      const auto near = in_cell.find({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
      if (near == in_cell.end()) continue;
      for (const int other : near->second)
        if ((file.vertices[other] - file.vertices[v]).norm() <= distance) first[v] = other;
    }
    if (first[v] == static_cast<int>(v)) in_cell[at].push_back(first[v]);
  }
  for (MeshFile::Face& face : file.faces)
    for (int& corner : face.corners) corner = first[corner];
  for (auto& rope : file.ropes)
    for (int& end : rope) end = first[end];
}

std::vector<MeshFile::Face> distinct_faces(const MeshFile& file) {
  std::vector<MeshFile::Face> faces;
  std::set<std::set<int>> known;
  const auto number = [](int vertex) { return std::to_string(vertex + 1); };
  for (const MeshFile::Face& face : file.faces) {
    const std::size_t n = face.corners.size();
    const auto at = [&](std::size_t k) { return file.vertices[face.corners[k % n]]; };
    Eigen::Vector3d area = Eigen::Vector3d::Zero();  // twice, after Newell
    double longest = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double side = (at(k + 1) - at(k)).norm();
      if (!(side > 0))
        throw UsageError(file.name(face) + ": its corners " + number(face.corners[k]) + " and " +
                         number(face.corners[(k + 1) % n]) + " are in one place");
      area += (at(k) - at(0)).cross(at(k + 1) - at(0));
      longest = std::max(longest, side);
    }
    int turned = 0;  // corners that turn against the first one
    const auto turn = [&](std::size_t k) {
      return (at(k + 1) - at(k)).cross(at(k + n - 1) - at(k)).eval();
    };
    for (std::size_t k = 1; k < n; ++k) turned += turn(k).dot(turn(0)) < 0 ? 1 : 0;
    if (n == 4 && turned == 2)
      throw UsageError(file.name(face) + ": it crosses itself, its corners are not in turn");
    if (!(area.norm() > 1e-9 * longest * longest))
      throw UsageError(file.name(face) + ": it has no area, its corners lie on one line");
    if (known.emplace(face.corners.begin(), face.corners.end()).second) faces.push_back(face);
  }
  return faces;
}

}  // namespace harness
