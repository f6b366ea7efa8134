// Cloth from files.
#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/text.h"
#include "harness/scenes/cloth_mesh.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {
namespace {

constexpr std::string_view prefix = "mesh:";

// "y > 1.2": which coordinate, and where.
struct Comparison {
  int axis;
  bool above;
  double value;
  bool holds(const Eigen::Vector3d& x) const { return above ? x[axis] > value : x[axis] < value; }
};

std::string without_spaces(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
  return text;
}

// "y>1.2andx<0".
std::vector<Comparison> read_pins(const std::string& text) {
  std::vector<Comparison> all;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find("and", begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    char axis = 0, relation = 0;
    double value = 0;
    int read = 0;
    if (std::sscanf(part.c_str(), "%c%c%lf%n", &axis, &relation, &value, &read) != 3 ||
        read != static_cast<int>(part.size()) || axis < 'x' || axis > 'z' ||
        (relation != '>' && relation != '<'))
      throw UsageError("pins are '" + text +
                       "', must be like y>1.2, or several such joined by 'and'");
    all.push_back({axis - 'x', relation == '>', value});
    begin = end + 3;
  }
  return all;
}

// "7", "7/1/3", "7//3", "-1": corners count from 1, or backwards from the last vertex so far.
int corner_of(const std::string& word, std::size_t vertices, const std::string& where) {
  char* rest = nullptr;
  const long number = std::strtol(word.c_str(), &rest, 10);
  if (rest == word.c_str() || (*rest != '\0' && *rest != '/'))
    throw UsageError(where + ": '" + word + "' is not a corner of a face, such as 7 or 7/1/3");
  const auto count = static_cast<long>(vertices);
  const long index = number < 0 ? count + number : number - 1;
  if (number == 0 || index < 0 || index >= count)
    throw UsageError(where + ": no vertex " + std::to_string(number) + " among the " +
                     std::to_string(count) + " so far");
  return static_cast<int>(index);
}

// Wavefront OBJ: vertices and faces, and nothing else of what a file may hold. Throws UsageError,
// naming file and line, for what is no OBJ file or has no face.
MeshFile read_mesh_file(const std::string& path) {
  std::istringstream lines(read_file(path, "mesh"));
  MeshFile mesh;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = "'" + path + "', line " + std::to_string(++number);
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Eigen::Vector3d v;
      words >> v.x() >> v.y() >> v.z();
      if (!words || !v.allFinite()) throw UsageError(where + ": a vertex needs three numbers");
      mesh.vertices.push_back(v);
    } else if (word == "f") {
      std::vector<int>& face = mesh.faces.emplace_back();
      while (words >> word) face.push_back(corner_of(word, mesh.vertices.size(), where));
      if (face.size() < 3) throw UsageError(where + ": a face needs three corners or more");
    }
  }
  if (mesh.faces.empty())
    throw UsageError("'" + path + "' has no faces: is it a mesh in Wavefront's OBJ format?");
  return mesh;
}

// The files, read once for the scenes of all parameters.
struct MeshModel {
  std::string identity;
  std::vector<Comparison> pins;
  ClothMesh cloth;
  inextensible::TriangleMesh body;

  bool pinned(const Eigen::Vector3d& x) const {
    return !pins.empty() &&
           std::ranges::all_of(pins, [&](const Comparison& one) { return one.holds(x); });
  }
};

inextensible::TriangleMesh body_of(const MeshFile& file) {
  inextensible::TriangleMesh body;
  body.vertices = file.vertices;
  for (const std::vector<int>& face : file.faces) {
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      body.triangles.push_back({face[0], face[k], face[k + 1]});
  }
  double volume = 0;  // negative: faces are the wrong way round
  for (const auto& [a, b, c] : body.triangles)
    volume += body.vertices[a].dot(body.vertices[b].cross(body.vertices[c])) / 6;
  if (volume < 0) {
    for (auto& [a, b, c] : body.triangles) std::swap(b, c);
  }
  return body;
}

std::shared_ptr<const MeshModel> read_model(const std::string& name) {
  auto model = std::make_shared<MeshModel>();
  std::string file, body;
  std::istringstream words(name.substr(prefix.size()));
  std::getline(words, file, ',');
  for (std::string word; std::getline(words, word, ',');) {
    if (word.starts_with("pins=")) {
      model->pins = read_pins(without_spaces(word.substr(5)));
    } else if (word.starts_with("body=")) {
      body = word.substr(5);
    } else {
      throw UsageError("scene '" + name + "': '" + word +
                       "' must be pins=... or body=..., as in mesh:shirt.obj,pins=y>1.2");
    }
  }
  std::string content = name.substr(std::min(name.find(",pins="), name.size()));
  content.erase(std::min(content.find(",body="), content.size()));
  content = read_file(file, "mesh") + content;
  if (!body.empty()) content += read_file(body, "mesh");
  model->identity = fnv1a(content);
  model->cloth = cloth_of(read_mesh_file(file), file);
  if (!body.empty()) {
    model->body = body_of(read_mesh_file(body));
    try {
      (void)inextensible::TriangleCollider(model->body, 0);
    } catch (const std::invalid_argument& error) {
      throw UsageError("'" + body + "' is not a body to collide with: " + error.what());
    }
  }
  const bool holds =
      std::ranges::any_of(model->cloth.vertices, [&](auto& v) { return model->pinned(v); });
  if (!model->pins.empty() && !holds)
    throw UsageError("scene '" + name + "': no vertex is where the pins are");
  if (!holds && body.empty())
    throw UsageError("scene '" + name +
                     "': nothing is pinned and nothing is below; add ,pins=y>... or ,body=FILE");
  return model;
}

// Metres, with y upwards.
Eigen::Vector3d placed(const Eigen::Vector3d& x, const SceneParameters& p) {
  const double s = p.at("scale");
  if (p.at("up") == 2) return {s * x.x(), s * x.z(), -s * x.y()};
  return s * x;
}

ClothMesh cloth_for(const MeshModel& model, const SceneParameters& p) {
  ClothMesh cloth = refined(model.cloth, whole(p));
  for (Eigen::Vector3d& v : cloth.vertices) {
    cloth.held.push_back(model.pinned(v));
    v = placed(v, p);
  }
  return cloth;
}

Scene build_mesh(const MeshModel& model, const SceneParameters& p) {
  Draft draft = cloth_draft(cloth_for(model, p), p);
  if (!model.body.triangles.empty()) {
    inextensible::TriangleMesh body = model.body;
    for (Eigen::Vector3d& v : body.vertices) v = placed(v, p);
    draft.parts.collider =
        std::make_shared<const inextensible::TriangleCollider>(std::move(body), p.at("friction"));
  }
  const inextensible::Positions& x = draft.scene.start.x;
  draft.scene.size = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
  return finished(std::move(draft));
}

}  // namespace

bool names_mesh(std::string_view scene) { return scene.starts_with(prefix); }

std::string with_mesh_parts(const std::string& scene, const std::string& pins,
                            const std::string& body) {
  if (pins.empty() && body.empty()) return scene;
  if (!names_mesh(scene))
    throw UsageError("--pins and --collider go with --scene mesh:FILE.obj, not with '" + scene +
                     "'");
  for (const std::string& part : {pins, body}) {
    if (part.find(',') != std::string::npos)
      throw UsageError("'" + part + "': a comma cannot stand in pins or a file's name here");
  }
  return scene + (pins.empty() ? "" : ",pins=" + without_spaces(pins)) +
         (body.empty() ? "" : ",body=" + body);
}

SceneType mesh_scene(const std::string& name) {
  const std::shared_ptr<const MeshModel> model = read_model(name);
  return {.name = name,
          .summary = "cloth of your own",
          .parameters = with_cloth_parameters(
              {{"n", 1, "parts that each side of the file's faces is cut into", 1, 64, true},
               {"scale", 1, "m per unit of the files", 0, 1e6},
               {"up", 1, "which of the files' axes is up: 1 is y, 2 is z", 1, 2, true},
               {"friction", 0.3, "Coulomb coefficient of the body", zero_too, 1e3}},
              {.density = 0.15, .shear = 20, .bending = 1e-5, .drag = 0.05}, 1),
          .build = [model](const SceneParameters& p) { return build_mesh(*model, p); },
          .counts = [model](const SceneParameters& p) { return count_cloth(cloth_for(*model, p)); },
          .like = model->body.triangles.empty() ? "patch" : "drape",
          .identity = model->identity};
}

}  // namespace harness
