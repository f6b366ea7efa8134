#include "harness/scenes/scene_folder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "harness/base/files.h"
#include "harness/base/json.h"
#include "harness/scenes/mesh_file.h"
#include "harness/scenes/meshes.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {
namespace {

constexpr std::string_view folder_prefix = "folder:";
constexpr double pose_interval = 1e-3;  // s

json pairs_of(const std::vector<Edge>& edges) {
  json list = json::array();
  for (const auto& [a, b] : edges) list.push_back({a, b});
  return list;
}

std::vector<Edge> edges_of(const json& list) {
  std::vector<Edge> edges;
  for (const auto& [a, b] : list.get<std::vector<std::array<int, 2>>>()) edges.push_back({a, b});
  return edges;
}

template <class Matrix>
json numbers_of(const Matrix& matrix) {
  return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
}

json poses_of(const BodyMotion& motion, double duration) {
  json poses = json::array();
  for (int i = 0; i * pose_interval <= duration + pose_interval; ++i) {
    const Pose pose = motion(i * pose_interval);
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows;
    rows << pose.turn, pose.translation;
    poses.push_back(numbers_of(rows));
  }
  return poses;
}

BodyMotion motion_of(const json& list) {
  std::vector<Pose> poses;
  for (const auto& numbers : list.get<std::vector<std::array<double, 12>>>()) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> rows(numbers.data());
    poses.push_back({rows.leftCols<3>(), rows.col(3)});
  }
  if (poses.size() < 2) throw std::invalid_argument("'body_poses' must have two poses or more");
  return motion_through(std::move(poses), pose_interval);
}

json document_of(const Scene& scene) {
  const Problem& problem = *scene.problem;
  json document{{"schema", "inextensible-scene/1"},
                {"size", scene.size},
                {"gravity", numbers_of(problem.gravity())},
                {"mass", problem.mass()},
                {"pinned", problem.pinned()},
                {"edge", pairs_of(problem.edges())},
                {"rest_length", problem.rest_length()},
                {"triangles", scene.triangles},
                {"implicit", problem.implicit_forces()},
                {"contact_inside", problem.contact_inside()},
                {"pins_follow_body", problem.pins_follow_body()},
                {"conserves_energy", scene.conserves_energy},
                {"staggered", scene.staggered}};
  if (std::isfinite(scene.energy_bound)) document["energy_bound"] = scene.energy_bound;
  if (!scene.start.v.isZero(0)) document["v"] = numbers_of(scene.start.v);
  if (!problem.limit_scale().empty()) document["limit_scale"] = problem.limit_scale();
  if (const inextensible::Springs* shear = problem.shear()) {
    document["spring"] = pairs_of(shear->edges);
    document["spring_length"] = shear->rest_length;
    document["spring_stiffness"] = shear->stiffness;
  }
  for (const auto& stencil : problem.bending()) {
    document["stencil"].push_back(stencil.vertex);
    document["stencil_coefficient"].push_back(stencil.coefficient);
    document["stencil_stiffness"].push_back(stencil.stiffness);
  }
  for (int i = 0; problem.has_drag() && i < problem.vertices(); ++i)
    document["drag"].push_back(problem.drag(i));
  for (const Scene::Mark& mark : scene.marks)
    document["marks"].push_back({mark.name, mark.vertex, mark.height});
  if (problem.body_motion())
    document["body_poses"] = poses_of(problem.body_motion(), scene.duration);
  return document;
}

std::string path_of(std::string_view name) {
  if (name.starts_with(folder_prefix)) name.remove_prefix(folder_prefix.size());
  const std::filesystem::path path(name.substr(0, name.find(",content=")));
  return (path / "").lexically_normal().parent_path().string();
}

// The numbers of a list for a matrix that has its size.
template <class Matrix>
void read(const json& list, Matrix&& matrix, const char* key) {
  const auto numbers = list.get<std::vector<double>>();
  if (std::ssize(numbers) != matrix.size())
    throw std::invalid_argument(
        concat("'", key, "' has ", numbers.size(), " numbers, must have ", matrix.size()));
  std::ranges::copy(numbers, matrix.data());
}

std::shared_ptr<const inextensible::Collider> body_of(const json& document,
                                                      const std::string& folder) {
  const MeshFile file = read_mesh_file(folder + "/" + document.at("body").get<std::string>());
  inextensible::TriangleMesh body{file.vertices, {}};
  for (const MeshFile::Face& face : file.faces) {
    if (face.corners.size() != 3) throw UsageError(file.name(face) + " is no triangle");
    body.triangles.push_back({face.corners[0], face.corners[1], face.corners[2]});
  }
  return std::make_shared<const inextensible::TriangleCollider>(
      std::move(body), document.at("friction").get<double>());
}

Scene scene_of(const json& document, const std::string& folder) {
  const MeshFile cloth = read_mesh_file(folder + "/cloth.obj");
  const json none = json::array();
  Draft draft(static_cast<int>(cloth.vertices.size()),
              {{"duration", document.value("duration", 1.0)}});
  Scene& scene = draft.scene;
  ProblemParts& parts = draft.parts;
  std::copy(cloth.vertices.begin(), cloth.vertices.end(), scene.start.x.colwise().begin());
  if (document.contains("v")) read(document.at("v"), scene.start.v, "v");
  read(document.at("gravity"), parts.gravity, "gravity");
  parts.mass.resize(cloth.vertices.size());
  read(document.at("mass"), Eigen::Map<Eigen::VectorXd>(parts.mass.data(), std::ssize(parts.mass)),
       "mass");
  document.at("pinned").get_to(parts.pinned);
  parts.edges = edges_of(document.at("edge"));
  document.at("rest_length").get_to(parts.rest_length);
  parts.limit_scale = document.value("limit_scale", none).get<std::vector<double>>();
  if (document.contains("spring"))
    parts.shear = {edges_of(document.at("spring")), document.at("spring_length"),
                   document.at("spring_stiffness")};
  const json stencils = document.value("stencil", none);
  for (std::size_t i = 0; i < stencils.size(); ++i)
    parts.bending.push_back({stencils[i], document.at("stencil_coefficient").at(i),
                             document.at("stencil_stiffness").at(i)});
  parts.drag = document.value("drag", none).get<std::vector<double>>();
  parts.implicit_forces = document.value("implicit", false);
  parts.contact_inside = document.value("contact_inside", true);
  parts.pins_follow_body = document.value("pins_follow_body", false);
  if (document.contains("body")) parts.collider = body_of(document, folder);
  const bool moves = document.contains("body_poses");
  if (moves) parts.body_motion = motion_of(document.at("body_poses"));
  scene.energy_bound = document.value(
      "energy_bound", moves ? std::numeric_limits<double>::infinity() : scene.energy_bound);
  scene.size = document.value("size", scene.size);
  scene.triangles = document.value("triangles", none).get<std::vector<std::array<int, 3>>>();
  scene.conserves_energy = document.value("conserves_energy", false);
  scene.staggered = document.value("staggered", true);
  for (const json& mark : document.value("marks", none))
    scene.marks.push_back({mark.at(0), mark.at(1), mark.at(2)});
  Scene made = finished(std::move(draft));
  inextensible::check_state(*made.problem, made.start);
  return made;
}

}  // namespace

BodyMotion motion_through(std::vector<Pose> poses, double interval) {
  return [poses = std::move(poses), interval](double time) {
    const auto last = static_cast<double>(poses.size() - 1);
    const double at = std::clamp(time / interval, 0.0, last);
    const auto first = std::min(static_cast<std::size_t>(at), poses.size() - 2);
    const Pose &before = poses[first], &after = poses[first + 1];
    const double part = at - static_cast<double>(first);
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(before.turn).slerp(part, Eigen::Quaterniond(after.turn));
    return Pose{turn.toRotationMatrix(),
                (1 - part) * before.translation + part * after.translation};
  };
}

json about(const SceneType& type, const SceneParameters& complete) {
  return {{"name", type.name},
          {"kind", type.kind()},
          {"parameters", complete},
          {"n", complete.at(type.resolution)},
          {"duration", complete.at("duration")}};
}

void write_scene(const std::string& folder, const Scene& scene, const json& about) {
  json document = document_of(scene);
  document.update(about);
  const auto write = [&](const std::string& file, const std::string& text) {
    write_atomically(folder + "/" + file, text);
  };
  write("cloth.obj", obj_text(scene.start.x, scene.triangles, scene.problem->edges()));
  if (const auto* body =
          dynamic_cast<const inextensible::TriangleCollider*>(scene.problem->collider())) {
    document["body"] = "body.obj";
    document["friction"] = body->friction();
    const auto& vertices = body->mesh().vertices;
    write("body.obj",
          obj_text(Eigen::Map<const Positions>(vertices.data()->data(), 3,
                                               static_cast<Eigen::Index>(vertices.size())),
                   body->mesh().triangles, {}));
  }
  write("scene.json", document_text(document));
}

bool names_folder(std::string_view scene) {
  const auto is_scene = [&](const SceneType& type) { return type.name == scene; };
  return scene.starts_with(folder_prefix) ||
         (std::ranges::none_of(scene_types(), is_scene) && !scene.empty() &&
          std::filesystem::is_regular_file(std::filesystem::path(scene) / "scene.json"));
}

SceneType folder_scene(const std::string& name) {
  const std::string folder = path_of(name), path = folder + "/scene.json";
  const std::string text = read_file(path, "scene");
  const json document = parse_document(text, path);
  check_fits(document, json::parse(read_file(source_path("configs/scene.schema.json"), "schema")),
             "scene", path);
  try {
    std::string content = text + read_file(folder + "/cloth.obj", "cloth");
    if (document.contains("body"))
      content += read_file(folder + "/" + document.at("body").get<std::string>(), "body");
    const std::string identity = fnv1a(content);
    const std::size_t expected = name.find(",content=");
    if (expected != std::string::npos && name.substr(expected + 9) != identity)
      throw std::invalid_argument("the files have changed: their hash was " +
                                  name.substr(expected + 9) + " and is now " + identity);
    const double n = document.value("n", 1.0), duration = document.value("duration", 1.0);
    // Built once: a scene with a mistake is refused here.
    const auto built = std::make_shared<const Scene>(scene_of(document, folder));
    return {
        .name = std::string(folder_prefix) + folder + ",content=" + identity,
        .summary = "a scene from files",
        .parameters = {{"n", n, "the size that was exported", n, n, true}, duration_info(duration)},
        .build =
            [built](const SceneParameters& p) {
              Scene scene = *built;
              scene.duration = p.at("duration");
              return scene;
            },
        .counts =
            [built](const SceneParameters&) {
              return std::pair{built->problem->vertices(), built->problem->constraints()};
            },
        .like = document.value("kind", document.contains("body") ? "drape" : "patch"),
        .identity = identity,
        .reference = document.contains("reference")
                         ? folder + "/" + document.at("reference").get<std::string>()
                         : ""};
  } catch (const std::invalid_argument& error) {
    throw UsageError("'" + path + "' is no scene: " + error.what());
  }
}

}  // namespace harness
