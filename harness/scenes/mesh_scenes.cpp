// Cloth from files.
#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
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
  for (const auto& [corners, line] : distinct_faces(file)) {
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      body.triangles.push_back({corners[0], corners[k], corners[k + 1]});
  }
  double volume = 0;  // negative: faces are the wrong way round
  for (const auto& [a, b, c] : body.triangles)
    volume += body.vertices[a].dot(body.vertices[b].cross(body.vertices[c])) / 6;
  if (volume < 0) {
    for (auto& [a, b, c] : body.triangles) std::swap(b, c);
  }
  return body;
}

ClothMesh with_pins(const MeshModel& model, ClothMesh cloth) {
  for (const Eigen::Vector3d& v : cloth.vertices) cloth.held.push_back(model.pinned(v));
  return cloth;
}

// Throws UsageError for cloth that falls apart or cannot move.
void check_cloth(const std::string& file, const ClothMesh& cloth, bool has_body) {
  if (std::ranges::all_of(cloth.held, std::identity{}))
    throw UsageError("'" + file + "': all vertices are pinned, nothing can move");
  const std::vector<int> piece = pieces_of(cloth);
  std::set<int> pieces, held;
  for (std::size_t v = 0; v < piece.size(); ++v) {
    pieces.insert(piece[v]);
    if (cloth.held[v]) held.insert(piece[v]);
  }
  if (!has_body && held.size() < pieces.size())
    throw UsageError("'" + file + "' is in " + std::to_string(pieces.size()) + " pieces, " +
                     std::to_string(pieces.size() - held.size()) +
                     " of them pinned nowhere: join corners that lie on each other, or pin every "
                     "piece");
  if (count_cloth(cloth).second == 0)
    throw UsageError("'" + file + "': no side of its " +
                     std::to_string(cloth.quads.size() + cloth.triangles.size()) +
                     " faces is constrained, as triangles that make no quads are springs: there is "
                     "nothing to compare");
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
  model->cloth = cloth_of(read_mesh_file(file));
  if (!body.empty()) {
    model->body = body_of(read_mesh_file(body));
    try {
      (void)inextensible::TriangleCollider(model->body, 0);
    } catch (const std::invalid_argument& error) {
      throw UsageError("'" + body + "' is not a body to collide with: " + error.what());
    }
  }
  const ClothMesh cloth = with_pins(*model, model->cloth);
  const bool holds = std::ranges::any_of(cloth.held, std::identity{});
  if (!model->pins.empty() && !holds)
    throw UsageError("scene '" + name + "': no vertex is where the pins are");
  if (!holds && body.empty())
    throw UsageError(
        "scene '" + name +
        "': nothing is pinned and nothing is below; add --pins 'y > ...' or --collider FILE");
  check_cloth(file, cloth, !body.empty());
  return model;
}

// Metres, with y upwards.
Eigen::Vector3d placed(const Eigen::Vector3d& x, const SceneParameters& p) {
  const double s = p.at("scale");
  if (p.at("up") == 2) return {s * x.x(), s * x.z(), -s * x.y()};
  return s * x;
}

ClothMesh cloth_for(const MeshModel& model, const SceneParameters& p) {
  ClothMesh cloth = with_pins(model, refined(model.cloth, whole(p)));
  for (Eigen::Vector3d& v : cloth.vertices) v = placed(v, p);
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
