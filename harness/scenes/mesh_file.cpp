#include "harness/scenes/mesh_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>

#include "harness/base/files.h"
#include "harness/base/text.h"

namespace harness {
namespace {

// Those of the format that say nothing about vertices, faces and lines.
constexpr std::string_view left_out[] = {
    "vn",       "vp",   "g",     "o",     "s",    "mg",   "usemtl",     "mtllib",   "usemap",
    "maplib",   "lod",  "bevel", "p",     "deg",  "bmat", "step",       "cstype",   "curv",
    "curv2",    "surf", "con",   "parm",  "trim", "hole", "scrv",       "sp",       "c_interp",
    "d_interp", "end",  "ctech", "stech", "call", "csh",  "shadow_obj", "trace_obj"};

// The next word from `at` on; empty at the end of the line. Numbers are read as far as they go.
std::string_view next_word(const char*& at) {
  while (*at != 0 && std::isspace(static_cast<unsigned char>(*at)) != 0) ++at;
  const char* begin = at;
  while (*at != 0 && std::isspace(static_cast<unsigned char>(*at)) == 0) ++at;
  return {begin, at};
}

struct Reader {
  MeshFile& mesh;
  int line = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw UsageError(concat("'", mesh.path, "', line ", line, ": ", what));
  }

  // The place, from 0 on, that an index means: from 1, or backwards from the last one so far.
  int place_of(long index, long count, const char* what) const {
    const long place = index < 0 ? count + index : index - 1;
    if (index == 0 || place < 0 || place >= count)
      fail(concat("no ", what, ' ', index, " among the ", count, " so far"));
    return static_cast<int>(place);
  }

  // "7", "7/1/3", "7//3", "-1"; the texture's point is -1 where there is none.
  std::array<int, 2> corner_of(std::string_view word) const {
    char* rest = nullptr;
    const long vertex = std::strtol(word.data(), &rest, 10);
    const char* end = word.data() + word.size();
    if (rest == word.data() || (rest < end && *rest != '/'))
      fail("'" + shortened(std::string(word)) + "' is not a corner of a face, such as 7 or 7/1/3");
    const int place = place_of(vertex, std::ssize(mesh.vertices), "vertex");
    if (end - rest < 2 || rest[1] == '/') return {place, -1};
    return {place, place_of(std::strtol(rest + 1, nullptr, 10), std::ssize(mesh.texture), "vt")};
  }

  void read(const char* at);
};

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

void Reader::read(const char* at) {
  const std::string_view key = next_word(at);
  const auto numbers = [&](auto& to, const char* what) {
    for (double& number : to.reshaped()) {
      char* rest = nullptr;
      number = std::strtod(at, &rest);
      if (rest == at || !std::isfinite(number)) fail(what);
      at = rest;
    }
  };
  if (key == "v") {
    numbers(mesh.vertices.emplace_back(), "a vertex needs three numbers");
  } else if (key == "vt") {
    numbers(mesh.texture.emplace_back(), "a texture's point needs two numbers");
  } else if (key == "f") {
    MeshFile::Face& face = mesh.faces.emplace_back(MeshFile::Face{{}, line});
    for (std::string_view word; !(word = next_word(at)).empty();) {
      const auto [vertex, point] = corner_of(word);
      face.corners.push_back(vertex);
      if (point >= 0) face.texture.push_back(point);
    }
    if (face.corners.size() < 3) fail("a face needs three corners or more");
    if (face.texture.size() != face.corners.size()) face.texture.clear();
  } else if (key == "l") {
    int before = -1;
    for (std::string_view word; !(word = next_word(at)).empty();) {
      const int corner = corner_of(word)[0];
      if (before >= 0) mesh.ropes.push_back({before, corner});
      before = corner;
    }
  } else if (!key.empty() && std::ranges::find(left_out, key) == std::end(left_out)) {
    fail("'" + shortened(std::string(key)) + "' is no keyword of an OBJ file");
  }
}

// Replaces each vertex by first[vertex].
void replace(MeshFile& file, const std::vector<int>& first) {
  for (MeshFile::Face& face : file.faces)
    for (int& corner : face.corners) corner = first[corner];
  for (auto& rope : file.ropes)
    for (int& end : rope) end = first[end];
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
  Reader reader{mesh};
  for (std::string line; next_line(file, line, reader.line);) reader.read(line.c_str());
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
  if (triangles.empty())
    for (const auto& [a, b] : edges) out << "l " << a + 1 << ' ' << b + 1 << '\n';
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
  replace(file, first);
}

void sew(MeshFile& file) {
  std::vector<char> of_face(file.vertices.size(), 0);
  for (const MeshFile::Face& face : file.faces)
    for (const int corner : face.corners) of_face[corner] = 1;
  std::vector<int> first(file.vertices.size());
  std::iota(first.begin(), first.end(), 0);
  const auto closed = [&](const std::array<int, 2>& ends) {
    const auto [a, b] = ends;
    if (!of_face[a] || !of_face[b] || file.vertices[a] != file.vertices[b]) return false;
    std::ranges::replace(first, first[b], first[a]);
    return true;
  };
  file.sewn = static_cast<int>(std::erase_if(file.ropes, closed));
  if (file.sewn > 0) replace(file, first);
}

std::vector<MeshFile::Face> distinct_faces(const MeshFile& file) {
  std::vector<MeshFile::Face> faces;
  std::set<std::vector<int>> known;
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
    std::vector<int> corners = face.corners;
    std::ranges::sort(corners);
    if (known.insert(std::move(corners)).second) faces.push_back(face);
  }
  return faces;
}

}  // namespace harness
