// Cloth from files.
#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "harness/base/files.h"
#include "harness/base/text.h"
#include "harness/scenes/cloth_mesh.h"
#include "harness/scenes/scene_folder.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {
namespace {

constexpr std::string_view prefix = "mesh:";

std::string without_spaces(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
  return text;
}

std::vector<std::string> split(const std::string& text, const std::string& word) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(word, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + word.size();
  }
  return parts;
}

// One condition on a vertex, in the file's unit: "y>1.2", "x<=0"; "v12" and "near(0:1:0)" are one
// vertex, by its number in the file or as the nearest one.
using Condition = std::function<bool(const Eigen::Vector3d&)>;

Condition read_condition(const std::string& text, const MeshFile& file) {
  char axis = 0, relation = 0;
  int read = 0;
  long number = 0;
  const auto all_read = [&] { return read == static_cast<int>(text.size()); };
  if (Eigen::Vector3d p;
      std::sscanf(text.c_str(), "near(%lf:%lf:%lf)%n", &p.x(), &p.y(), &p.z(), &read) == 3 &&
      all_read()) {
    const auto nearest = std::ranges::min_element(
        file.vertices, {}, [&](const Eigen::Vector3d& v) { return (v - p).norm(); });
    return [at = *nearest](const Eigen::Vector3d& x) { return x == at; };
  }
  if (std::sscanf(text.c_str(), "v%ld%n", &number, &read) == 1 && all_read()) {
    if (number < 1 || number > std::ssize(file.vertices))
      throw UsageError(concat("pins: '", file.path, "' has no vertex ", number));
    return [at = file.vertices[number - 1]](const Eigen::Vector3d& x) { return x == at; };
  }
  double value = 0;
  for (const char* form : {"%c%c=%lf%n", "%c%c%lf%n"}) {
    if (std::sscanf(text.c_str(), form, &axis, &relation, &value, &read) != 3 || !all_read() ||
        axis < 'x' || axis > 'z' || (relation != '>' && relation != '<'))
      continue;
    const double sign = relation == '>' ? 1 : -1;
    const bool equal = form[4] == '=';
    return [=, i = axis - 'x'](const Eigen::Vector3d& x) {
      return equal ? sign * x[i] >= sign * value : sign * x[i] > sign * value;
    };
  }
  throw UsageError("pins are '" + shortened(text) +
                   "', must be like y>1.2, x<=0, v12 (a vertex of the file) or near(0:1:0), joined "
                   "by 'and' and 'or'");
}

// "y>1.2andx<0orv3": 'and' binds closer.
Condition read_pins(const std::string& text, const MeshFile& file) {
  std::vector<std::vector<Condition>> any;
  for (const std::string& part : split(text, "or")) {
    std::vector<Condition>& all = any.emplace_back();
    for (const std::string& one : split(part, "and")) all.push_back(read_condition(one, file));
  }
  return [any](const Eigen::Vector3d& x) {
    return std::ranges::any_of(any, [&](const std::vector<Condition>& all) {
      return std::ranges::all_of(all, [&](const Condition& one) { return one(x); });
    });
  };
}

// The files, read once for the scenes of all parameters.
struct MeshModel {
  std::string description, remarks;
  std::string name, identity;  // name: with the hash of all that the scene is made of
  Condition pinned, loaded;    // empty: nothing is
  ClothMesh cloth, start;      // unstretched, and where it begins
  bool midpoints = false;      // triangles by the midpoints of their sides
  inextensible::TriangleMesh body;
  std::shared_ptr<const inextensible::TriangleCollider> checked;  // of the body; null: known before
  std::vector<inextensible::Pose> poses;  // of the body at equal intervals; empty: it stays
  std::optional<double> floor;            // its height

  bool has_body() const { return floor || !body.triangles.empty(); }
};

// The cloth that is simulated, with what is held and loaded where it begins.
ClothMesh simulated(const MeshModel& model, ClothMesh cloth, const ClothMesh& start) {
  for (const Eigen::Vector3d& v : start.vertices) {
    cloth.held.push_back(model.pinned && model.pinned(v));
    cloth.loaded.push_back(model.loaded && model.loaded(v));
  }
  return model.midpoints ? midpoints_of(cloth) : cloth;
}

// The triangles of a closed surface, counter-clockwise seen from outside: those that are turned
// against their neighbours are turned. Throws UsageError where a side has not two faces.
inextensible::TriangleMesh body_of(const MeshFile& file) {
  inextensible::TriangleMesh body{file.vertices, {}};
  for (const auto& [corners, line, texture] : distinct_faces(file)) {
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      body.triangles.push_back({corners[0], corners[k], corners[k + 1]});
  }
  const inextensible::TriangleSides sides = inextensible::sides_of(body.triangles);
  if (sides.faces != 2)
    throw UsageError(concat(
        "'", file.path, "' is not a body to collide with: the side between vertices ", sides.a + 1,
        " and ", sides.b + 1, " has ", counted(sides.faces, "face"), ", a closed surface has 2",
        sides.faces == 1
            ? "; --weld 1e-6 joins doubled corners, --thickness DISTANCE closes an open surface"
            : ""));
  const auto first = [&](int side) { return body.triangles[side / 3][side % 3]; };
  std::vector<char> known(body.triangles.size(), 0), turned = known;  // against the piece's first
  for (int seed = 0; seed < std::ssize(known); ++seed) {
    if (known[seed]) continue;
    std::vector<int> piece{seed};
    known[seed] = 1;
    double volume = 0;  // negative: faces are the wrong way round
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const auto [a, b, c] = body.triangles[piece[i]];
      volume += (turned[piece[i]] ? -1 : 1) *
                body.vertices[a].dot(body.vertices[b].cross(body.vertices[c]));
      for (int side = 3 * piece[i]; side < 3 * piece[i] + 3; ++side) {
        const int twin = sides.twin[side], t = twin / 3;
        if (known[t]) continue;
        known[t] = 1;
        piece.push_back(t);
        turned[t] = (first(twin) == first(side)) != (turned[piece[i]] != 0);  // same way along it
      }
    }
    for (const int t : piece)
      if ((turned[t] != 0) != (volume < 0)) std::swap(body.triangles[t][0], body.triangles[t][1]);
  }
  return body;
}

// An open surface with a back, `thickness` behind it as its faces look, and sides around its rim.
MeshFile thickened(MeshFile file, double thickness) {
  const auto n = static_cast<int>(file.vertices.size());
  std::vector<Eigen::Vector3d> normal(file.vertices.size(), Eigen::Vector3d::Zero());
  std::set<std::pair<int, int>> sides;  // as faces pass them
  for (const auto& [c, line, texture] : file.faces) {
    for (std::size_t k = 0; k < c.size(); ++k) {
      const int a = c[k], b = c[(k + 1) % c.size()];
      if (!sides.emplace(a, b).second)
        throw UsageError("'" + file.path + "': its faces look different ways, so it has no front");
      normal[a] += (file.vertices[b] - file.vertices[a])
                       .cross(file.vertices[c[(k + c.size() - 1) % c.size()]] - file.vertices[a]);
    }
  }
  for (int v = 0; v < n; ++v)
    file.vertices.push_back(file.vertices[v] - thickness * normal[v].normalized());
  for (std::size_t f = 0, faces = file.faces.size(); f < faces; ++f) {
    MeshFile::Face back = file.faces[f];
    std::ranges::reverse(back.corners);
    for (int& corner : back.corners) corner += n;
    file.faces.push_back(std::move(back));
  }
  for (const auto& [a, b] : sides)
    if (!sides.contains({b, a})) file.faces.push_back({{b, a, a + n, b + n}, 0});
  return file;
}

// The rigid motion that takes a body to its shape in another file (Umeyama 1991).
inextensible::Pose pose_between(const MeshFile& body, const MeshFile& there) {
  if (body.vertices.size() != there.vertices.size())
    throw UsageError("'" + there.path + "' has other vertices than '" + body.path + "'");
  const auto points = [n = std::ssize(body.vertices)](const MeshFile& file) -> Eigen::MatrixXd {
    return Eigen::Map<const Positions>(file.vertices.data()->data(), 3, n);
  };
  const Eigen::MatrixXd motion = Eigen::umeyama(points(body), points(there), false);
  inextensible::Pose pose{motion.topLeftCorner<3, 3>(), motion.topRightCorner<3, 1>()};
  for (std::size_t v = 0; v < body.vertices.size(); ++v)
    if ((pose(body.vertices[v]) - there.vertices[v]).norm() >
        1e-4 * there.vertices[v].norm() + 1e-6)
      throw UsageError("'" + there.path + "' is not '" + body.path +
                       "' moved and turned: a body cannot change its shape");
  return pose;
}

Eigen::AlignedBox3d box_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box;
}

// Throws UsageError for cloth that falls apart or cannot move.
void check_cloth(const std::string& path, MeshFile file, const ClothMesh& cloth, bool has_body,
                 bool welded) {
  if (std::ranges::all_of(cloth.held, std::identity{}))
    throw UsageError("'" + path + "': all vertices are pinned, nothing can move");
  const std::vector<int> piece = pieces_of(cloth);
  const int pieces = 1 + *std::ranges::max_element(piece);
  std::set<int> held;
  for (std::size_t v = 0; v < piece.size(); ++v)
    if (cloth.held[v]) held.insert(piece[v]);
  const int loose = pieces - static_cast<int>(held.size());
  if (pieces > 1 && !(has_body && welded) && loose > 0) {
    weld(file, 1e-6 * box_of(cloth.vertices).diagonal().norm());
    const std::vector<int> joined = pieces_of(cloth_of(file));
    const bool doubled = *std::ranges::max_element(joined) + 1 < pieces;
    const auto free = std::ranges::find_if(piece, [&](int of) { return !held.contains(of); });
    if (!has_body || doubled)
      throw UsageError(concat(
          "'", path, "' is in ", pieces, " pieces, ", loose, " of them pinned nowhere",
          cloth.medial ? ""
                       : concat(", as that of vertex ", cloth.in_file[free - piece.begin()] + 1),
          doubled ? "; corners lie on each other: --weld 1e-6 joins them" : "",
          doubled && has_body ? ", --weld 0 leaves them apart" : ""));
  }
  if (count_cloth(cloth).second == 0)
    throw UsageError(concat("'", path, "': no side of its ",
                            counted(cloth.quads.size() + cloth.triangles.size(), "face"),
                            " is constrained, since triangles that make no quads are springs: "
                            "there is nothing to compare"));
}

// How deep points are in a body: its deepest, and how many are in it.
std::pair<double, int> depth_in(const inextensible::Collider& body,
                                const std::vector<Eigen::Vector3d>& points) {
  const auto n = static_cast<int>(points.size());
  const Eigen::Map<const Eigen::Matrix3Xd> x(points.data()->data(), 3, n);
  auto memory = body.nothing_of(n);
  std::vector<inextensible::ContactPlane> planes;
  inextensible::WorkCounters unused;
  body.find(x, std::vector<double>(points.size(), 1), 0, memory, planes, unused);
  std::pair<double, int> found{0, 0};
  for (const auto& [v, normal, offset] : planes) {
    const double depth = offset - normal.dot(x.col(v));
    if (depth <= 1e-9 * x.col(v).norm()) continue;
    found = {std::max(found.first, depth), found.second + 1};
  }
  return found;
}

// Throws UsageError where corners, sides or faces of one body begin, or have their middle, inside
// another: their union would have faces within.
void check_apart(const std::string& path, const inextensible::TriangleMesh& body,
                 const inextensible::TriangleMesh& others) {
  const auto reaches = [](const auto& mesh, const inextensible::TriangleMesh& around) {
    std::vector<Eigen::Vector3d> points;
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                            &c = mesh.vertices[t[2]];
      points.insert(points.end(), {a, (a + b) / 2, (b + c) / 2, (c + a) / 2, (a + b + c) / 3});
    }
    return depth_in(inextensible::TriangleCollider(around, 0), points).second > 0;
  };
  if (reaches(body, others) || reaches(others, body))
    throw UsageError("'" + path + "' reaches into another body: bodies must be apart");
}

// The same faces and lines elsewhere.
ClothMesh in_shape_of(const MeshFile& file, ClothMesh cloth, const MeshFile& rest) {
  const auto same = [](const MeshFile::Face& a, const MeshFile::Face& b) {
    return a.corners == b.corners;
  };
  if (!std::ranges::equal(file.faces, rest.faces, same) || file.ropes != rest.ropes ||
      file.vertices.size() != rest.vertices.size())
    throw UsageError("'" + rest.path + "' has other faces or lines than '" + file.path + "'");
  for (std::size_t v = 0; v < cloth.vertices.size(); ++v)
    cloth.vertices[v] = file.vertices[cloth.in_file[v]];
  return cloth;
}

// "mesh:m.obj,pins=y>1,body=b.obj": the words after the file, by what they are for.
std::map<std::string, std::string> parts_of(const std::string& name) {
  static const std::set<std::string> known{"pins",    "body",     "weld",      "rest",
                                           "load",    "floor",    "body_then", "thickness",
                                           "content", "triangles"};
  std::map<std::string, std::string> parts;
  std::istringstream words(name.substr(prefix.size()));
  std::getline(words, parts["file"], ',');
  for (std::string word; std::getline(words, word, ',');) {
    const std::string part = word.substr(0, word.find('='));
    if (!known.contains(part) || part.size() == word.size())
      throw UsageError("scene '" + name + "': '" + word +
                       "' must begin with pins=, body=, floor= or the like, as in "
                       "mesh:shirt.obj,pins=y>1.2");
    parts[part] = word.substr(part.size() + 1);
  }
  return parts;
}

// The number that an option gives.
std::optional<double> number_of(const std::map<std::string, std::string>& parts,
                                const std::string& part, double least) {
  if (!parts.contains(part)) return {};
  const std::string& text = parts.at(part);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != 0 || !(value >= least && value < 1e6))
    throw UsageError("--" + part + " is '" + shortened(text) + "', must be a number" +
                     (least == 0 ? " of at least 0" : ""));
  return value;
}

// What is left out, or other than its exporter may have meant, for people.
std::string remarks_of(const MeshFile& file, std::size_t distinct) {
  std::set<int> of_faces;
  for (const MeshFile::Face& face : file.faces)
    of_faces.insert(face.corners.begin(), face.corners.end());
  const auto threads = std::ranges::count_if(file.ropes, [&](const auto& ends) {
    return of_faces.contains(ends[0]) && of_faces.contains(ends[1]);
  });
  const std::size_t doubled = file.faces.size() - distinct;
  std::string text;
  if (file.sewn > 0)
    text += concat("  sewing lines: ", file.sewn, " without length, their ends are one vertex\n");
  if (threads > 0)
    text += concat("  sewing lines: ", threads,
                   " between faces are threads that keep their length, and are not drawn shut\n");
  if (doubled > 0) text += concat("  faces that occur twice: ", doubled, ", each used once\n");
  return text;
}

// The sides of body and cloth in characters, seen along the axis along which they are thinnest.
std::string sketch_of(const MeshModel& model) {
  const std::vector<Eigen::Vector3d>& cloth = model.start.vertices;
  Eigen::AlignedBox3d box = box_of(cloth);
  for (const Eigen::Vector3d& corner : model.body.vertices) box.extend(corner);
  int depth = 2;
  for (const int axis : {1, 0})
    if (box.sizes()[axis] < box.sizes()[depth]) depth = axis;
  const int across = depth == 0 ? 2 : 0, down = depth == 1 ? 2 : 1;
  // A column's width; rows are twice as high.
  const double cell = std::max({box.sizes()[across] / 59, box.sizes()[down] / 22, 1e-9});
  const auto cells = [&](double length) { return std::lround(length / cell); };
  std::vector<std::string> rows(1 + cells(box.sizes()[down] / 2),
                                std::string(1 + cells(box.sizes()[across]), ' '));
  const auto dot = [&](const Eigen::Vector3d& x, char mark) {
    const double below = down == 1 ? box.max().y() - x.y() : x.z() - box.min().z();
    rows[cells(below / 2)][cells(x[across] - box.min()[across])] = mark;
  };
  const auto draw = [&](const std::vector<Eigen::Vector3d>& x, const auto& faces, char mark) {
    for (const auto& face : faces)
      for (std::size_t k = 0; k < face.size(); ++k) {
        const Eigen::Vector3d &a = x[face[k]], way = x[face[(k + 1) % face.size()]] - a;
        const long parts = 1 + cells(2 * way.norm());
        for (long i = 0; i < parts; ++i)
          dot(a + static_cast<double>(i) / static_cast<double>(parts) * way, mark);
      }
  };
  draw(model.body.vertices, model.body.triangles, ':');
  draw(cloth, model.start.quads, '.');
  draw(cloth, model.start.triangles, '.');
  draw(cloth, model.start.ropes, '.');
  for (const Eigen::Vector3d& x : cloth) {
    if (model.loaded && model.loaded(x)) dot(x, 'w');
    if (model.pinned && model.pinned(x)) dot(x, 'o');
  }
  std::string text = concat("  seen along ", "xyz"[depth], ": o pinned, w loaded, : body\n");
  for (const std::string& row : rows)
    text += "    " + row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  return text;
}

// What was read, and what becomes of it, for people.
std::string description_of(const MeshModel& model, const MeshFile& file, const ClothMesh& cloth,
                           const std::vector<MeshFile::Face>& distinct) {
  const std::vector<int> piece = pieces_of(cloth);
  const Eigen::Vector3d sizes = box_of(model.start.vertices).sizes();
  const double largest = sizes.maxCoeff();
  std::string text =
      concat("'", file.path, "': ", counted(file.vertices.size(), "vertex", "vertices"), ", ",
             counted(file.faces.size(), "face"), ", ", counted(file.ropes.size(), "link"),
             " of lines; ", counted(1 + *std::ranges::max_element(piece), "piece"), "\n");
  text += concat("  unit: ", sizes.x(), " x ", sizes.y(), " x ", sizes.z(), " m, if --set scale=1",
                 largest > 20     ? "; that is large: centimetres would be scale=0.01\n"
                 : largest < 0.02 ? "; that is small: check the unit\n"
                                  : "\n");
  if (cloth.medial) {
    text += concat("  ", counted(cloth.triangles.size(), "triangle"),
                   ", by the midpoints of their sides; no springs\n");
  } else {
    const auto four =
        std::ranges::count_if(distinct, [](const auto& face) { return face.corners.size() == 4; });
    text += concat("  warp and weft: the sides of ", counted(cloth.quads.size(), "quad"),
                   ", of which ", std::ssize(cloth.quads) - four,
                   " are two triangles\n  springs: diagonals of quads, and sides of ",
                   counted(cloth.triangles.size(), "triangle"), " of no quad\n");
  }
  if (!cloth.along_u.empty())
    text += "  warp runs along the texture's u, and weft along its v; one limit for both\n";
  const auto marked = [](const std::vector<char>& flags) {
    return counted(std::ranges::count(flags, char{1}), "vertex", "vertices");
  };
  text +=
      concat("  constraints: ", counted(count_cloth(cloth).second, "side"), " of fixed length\n",
             "  pinned: ", marked(cloth.held), "; loaded: ", marked(cloth.loaded), "\n");
  text += model.remarks;
  text += concat("  below: ", counted(model.body.triangles.size(), "triangle"), " of a body",
                 model.poses.empty() ? "" : " that moves",
                 model.floor ? concat(", a floor at ", *model.floor) : "", "\n");
  return text + sketch_of(model);
}

// Several bodies are one mesh; each file of body_then has all of them, moved and turned as one.
template <class Read>
void add_bodies(MeshModel& model, std::map<std::string, std::string>& parts, const Read& read) {
  MeshFile all{parts["body"], {}, {}};
  const std::optional<double> thickness = number_of(parts, "thickness", 0);
  for (const std::string& path : split(parts["body"], ";")) {
    MeshFile file = read(path);
    all.vertices.insert(all.vertices.end(), file.vertices.begin(), file.vertices.end());
    if (thickness) file = thickened(std::move(file), *thickness);
    inextensible::TriangleMesh body = body_of(file);
    const auto first = static_cast<int>(model.body.vertices.size());
    if (first > 0) check_apart(path, body, model.body);
    for (auto& triangle : body.triangles)
      for (int& corner : triangle) corner += first;
    const auto add = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    add(model.body.vertices, body.vertices);
    add(model.body.triangles, body.triangles);
  }
  if (!parts.contains("body_then")) return;
  model.poses.emplace_back();
  for (const std::string& path : split(parts["body_then"], ";"))
    model.poses.push_back(pose_between(all, read(path)));
}

// The hash of all that the scene is made of: the content of its files, and the other words.
std::string hash_of(const std::map<std::string, std::string>& parts) {
  static const std::set<std::string> of_files{"file", "body", "body_then", "rest"};
  std::string content;
  for (const auto& [part, text] : parts) {
    if (!of_files.contains(part)) {
      content += part + "=" + text + ",";
      continue;
    }
    for (const std::string& file : split(text, ";")) content += read_file(file, "mesh");
  }
  return fnv1a(content);
}

// Unstretched, and where it begins.
template <class Read>
void read_cloth(MeshModel& model, std::map<std::string, std::string>& parts, const MeshFile& file,
                const Read& read) {
  if (parts.contains("triangles")) {
    if (parts["triangles"] != "midpoints" && parts["triangles"] != "springs")
      throw UsageError("--triangles is '" + parts["triangles"] + "', must be midpoints or springs");
    model.midpoints = parts["triangles"] == "midpoints";
    if (model.midpoints && !file.ropes.empty())
      throw UsageError("--triangles midpoints: '" + file.path +
                       "' has lines, which have no triangles");
  }
  model.cloth = model.start = cloth_of(file, model.midpoints);
  if (!parts.contains("rest")) return;
  const MeshFile rest = read(parts["rest"]);
  model.cloth = cloth_of(rest, model.midpoints);
  model.start = in_shape_of(file, model.cloth, rest);
}

// Throws UsageError where cloth begins inside the body; else what was set up for it is kept.
void check_outside(MeshModel& model, const std::string& path, const std::string& body) {
  try {
    model.checked = std::make_shared<const inextensible::TriangleCollider>(model.body, 0);
  } catch (const std::invalid_argument& error) {
    throw UsageError("'" + body + "' is not a body to collide with: " + error.what());
  }
  const auto [deepest, inside] = depth_in(*model.checked, model.start.vertices);
  if (inside > 0)
    throw UsageError(concat("'", path, "': ", inside, " of ",
                            counted(model.start.vertices.size(), "vertex", "vertices"),
                            " begin inside the body, as deep as ", number_text(deepest, 3),
                            " of the file's units"));
}

std::shared_ptr<const MeshModel> read_model(const std::string& name) {
  auto model = std::make_shared<MeshModel>();
  auto parts = parts_of(name);
  const std::string expected = parts["content"];
  parts.erase("content");
  model->identity = hash_of(parts);
  const std::string& path = parts["file"];
  if (!expected.empty() && expected != model->identity)
    throw UsageError("'" + path + "' has changed: the scene's files and pins have the hash " +
                     expected + ", these have " + model->identity);
  model->name = name + (expected.empty() ? ",content=" + model->identity : "");
  const std::optional<double> welded = number_of(parts, "weld", 0);
  if (welded && parts.contains("rest")) throw UsageError("--weld and --rest exclude each other");
  const auto read = [&](const std::string& file) {
    MeshFile mesh = read_mesh_file(file);
    if (welded.value_or(0) > 0) weld(mesh, *welded);
    sew(mesh);
    return mesh;
  };
  const MeshFile file = read(path);
  read_cloth(*model, parts, file, read);
  if (parts.contains("pins")) model->pinned = read_pins(without_spaces(parts["pins"]), file);
  if (parts.contains("load")) model->loaded = read_pins(without_spaces(parts["load"]), file);
  model->floor = number_of(parts, "floor", -1e6);
  if (parts.contains("body")) add_bodies(*model, parts, read);
  for (const auto& [part, option] :
       {std::pair("body_then", "--collider-then"), {"thickness", "--thickness"}})
    if (parts.contains(part) && !parts.contains("body"))
      throw UsageError(std::string(option) + " goes with --collider");
  if (model->floor && parts.contains("body_then"))
    throw UsageError("--floor and --collider-then exclude each other: the floor would move too");

  const ClothMesh cloth = simulated(*model, model->cloth, model->start);
  const bool holds = std::ranges::any_of(cloth.held, std::identity{});
  if (model->pinned && !holds)
    throw UsageError("scene '" + name + "': no vertex is where the pins are");
  if (model->loaded && std::ranges::none_of(model->start.vertices, model->loaded))
    throw UsageError("scene '" + name + "': no vertex is where the load is");
  const std::vector<MeshFile::Face> distinct = distinct_faces(file);
  model->remarks = remarks_of(file, distinct.size());
  model->description = description_of(*model, file, cloth, distinct);
  try {
    check_cloth(path, file, cloth, model->has_body() || !holds, welded.has_value());
    // What has this content has been checked before.
    if (!model->body.triangles.empty() && expected.empty())
      check_outside(*model, path, parts["body"]);
  } catch (const UsageError& error) {
    throw UnusableMesh(error.what(), model->description);
  }
  if (!holds && !model->has_body())
    throw UnusableMesh("scene '" + name +
                           "': nothing is pinned and nothing is below; add --pins 'y > ...', "
                           "--floor HEIGHT or --collider FILE",
                       model->description, true);
  return model;
}

// Metres, with y upwards.
Eigen::Vector3d placed(const Eigen::Vector3d& x, const SceneParameters& p) {
  const double s = p.at("scale");
  if (p.at("up") == 2) return {s * x.x(), s * x.z(), -s * x.y()};
  return s * x;
}

inextensible::Pose placed(const inextensible::Pose& pose, const SceneParameters& p) {
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) axes.col(i) = placed(Eigen::Vector3d::Unit(i), p) / p.at("scale");
  return {axes * pose.turn * axes.transpose(), placed(pose.translation, p)};
}

ClothMesh placed(ClothMesh cloth, const SceneParameters& p) {
  for (Eigen::Vector3d& v : cloth.vertices) v = placed(v, p);
  return cloth;
}

ClothMesh cloth_for(const MeshModel& model, const ClothMesh& start, const SceneParameters& p) {
  return placed(simulated(model, refined(model.cloth, whole(p)), start), p);
}

Scene build_mesh(const MeshModel& model, const SceneParameters& p) {
  const ClothMesh begins = refined(model.start, whole(p)), cloth = cloth_for(model, begins, p),
                  start = placed(model.midpoints ? midpoints_of(begins) : begins, p);
  Draft draft = cloth_draft(cloth, p);
  const Eigen::AlignedBox3d box = box_of(start.vertices);
  std::copy(start.vertices.begin(), start.vertices.end(), draft.scene.start.x.colwise().begin());
  const auto loaded = static_cast<double>(std::ranges::count(cloth.loaded, char{1}));
  for (std::size_t v = 0; v < start.vertices.size(); ++v)
    if (cloth.loaded[v]) draft.parts.mass[v] += p.at("load") / loaded;
  if (model.checked && !model.floor && p.at("scale") == 1 && p.at("up") == 1) {
    draft.parts.collider =
        std::make_shared<const inextensible::TriangleCollider>(*model.checked, p.at("friction"));
  } else if (model.has_body()) {
    inextensible::TriangleMesh body = model.body;
    for (Eigen::Vector3d& v : body.vertices) v = placed(v, p);
    if (model.floor) {
      const double height = p.at("scale") * *model.floor;
      if (box.min().y() < height - 1e-9 * box.diagonal().norm())
        throw std::invalid_argument("the cloth begins below the floor, at the height " +
                                    number_text(box.min().y()) + " m");
      // A block whose top it is, far wider than the cloth.
      const Eigen::Vector3d reach = Eigen::Vector3d::Constant(20 * box.diagonal().norm());
      Eigen::Vector3d low = box.center() - reach, high = box.center() + reach;
      low.y() = height - reach.y();
      high.y() = height;
      add_block(body, low, high);
    }
    draft.parts.collider =
        std::make_shared<const inextensible::TriangleCollider>(std::move(body), p.at("friction"));
  }
  if (!model.poses.empty()) {
    std::vector<inextensible::Pose> poses;
    for (const inextensible::Pose& pose : model.poses) poses.push_back(placed(pose, p));
    const double interval = p.at("duration") / static_cast<double>(poses.size() - 1);
    draft.parts.body_motion = motion_through(std::move(poses), interval);
    draft.scene.energy_bound = std::numeric_limits<double>::infinity();  // it does work
  }
  draft.scene.size = box.diagonal().norm();
  return finished(std::move(draft));
}

}  // namespace

bool names_mesh(std::string_view scene) { return scene.starts_with(prefix); }

std::string with_mesh_parts(const std::string& scene,
                            const std::vector<std::pair<std::string, std::string>>& parts) {
  std::string name = scene;
  for (const auto& [part, text] : parts) {
    if (text.empty()) continue;
    if (text.find(',') != std::string::npos)
      throw UsageError("'" + text + "': a comma cannot stand here or in a file's name");
    const bool of_file = part.starts_with("body") || part == "rest";
    name += "," + part + "=" + (of_file ? text : without_spaces(text));
  }
  if (names_mesh(scene)) return find_scene(name)->name;
  if (name != scene)
    throw UsageError("'" + name.substr(scene.size() + 1) +
                     "' goes with --scene mesh:FILE.obj, not with '" + scene + "'");
  return scene;
}

SceneType mesh_scene(const std::string& name) {
  const std::shared_ptr<const MeshModel> model = read_model(name);
  ParameterInfos own{{"n", 1, "parts that each side of the file's faces is cut into", 1, 64, true},
                     {"scale", 1, "m per unit of the files", 0, 1e6},
                     {"up", 1, "which of the files' axes is up: 1 is y, 2 is z", 1, 2, true}};
  if (model->has_body())
    own.push_back({"friction", 0.3, "Coulomb coefficient of body and floor", zero_too, 1e3});
  if (!model->cloth.ropes.empty()) own.push_back({"line_density", 0.05, "of lines, kg/m", 0, 1e4});
  if (!model->cloth.along_u.empty())
    own.insert(own.end(),
               {{"weft_bending", 1, "bending rigidity of weft over that of warp", zero_too, 1e6},
                {"weft_limit", 1,
                 "strain limit of weft over that of warp; the tighter is the run's", 0.001, 1e3}});
  if (model->loaded) own.push_back({"load", 1, "on the vertices of --load together, kg", 0, 1e6});
  return {.name = model->name,
          .summary = "cloth of your own",
          .parameters = with_cloth_parameters(
              own, {.density = 0.15, .shear = 20, .bending = 1e-5, .drag = 0.05}, 1),
          .build = [model](const SceneParameters& p) { return build_mesh(*model, p); },
          .counts =
              [model](const SceneParameters& p) {
                return count_cloth(cloth_for(*model, refined(model->start, whole(p)), p));
              },
          .like = model->has_body() ? "drape" : "patch",
          .identity = model->identity,
          .description = model->description,
          .remarks = model->remarks};
}

}  // namespace harness
