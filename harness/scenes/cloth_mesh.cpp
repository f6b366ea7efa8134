#include "harness/scenes/cloth_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "solvers/problem/closed_surface.h"

namespace harness {
namespace {

constexpr double most_oblique = 50;  // degrees

using Side = std::pair<int, int>;  // the lower vertex first

Side side(int a, int b) { return std::minmax(a, b); }

template <class Face>
Side side_of(const Face& face, std::size_t k) {
  return side(face[k], face[(k + 1) % face.size()]);
}

double triangle_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

// How far the worst of a quad's angles is from a right one, degrees.
double obliqueness(const std::vector<Eigen::Vector3d>& x, const std::array<int, 4>& quad) {
  double worst = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d& at = x[quad[k]];
    const Eigen::Vector3d to = x[quad[(k + 1) % 4]] - at, back = x[quad[(k + 3) % 4]] - at;
    const double angle = std::atan2(to.cross(back).norm(), to.dot(back));
    worst = std::max(worst, std::abs(angle - 0.5 * std::numbers::pi));
  }
  return worst * 180 / std::numbers::pi;
}

void check_sides(const MeshFile& file, const std::vector<MeshFile::Face>& faces) {
  std::map<Side, int> faces_at;
  for (const MeshFile::Face& face : faces)
    for (std::size_t k = 0; k < face.corners.size(); ++k) {
      const Side s = side_of(face.corners, k);
      if (++faces_at[s] > 2)
        throw UsageError(concat(file.name(face), ": the side between vertices ", s.first + 1,
                                " and ", s.second + 1, " belongs to more than two faces"));
    }
}

// Whether the first side of a quad runs along u of the texture and not along v, and how far its
// sides, in turn, are from these axes: degrees of the worst, twice, to compare with obliqueness().
struct Grain {
  bool along_u = false;
  double oblique = 0;
};

Grain grain(const std::array<Eigen::Vector2d, 4>& at) {
  std::array<double, 2> worst{0, 0};  // from v, u
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d side = (at[(k + 1) % 4] - at[k]).cwiseAbs();
    const double from_u = std::atan2(side.y(), side.x()), from_v = std::numbers::pi / 2 - from_u;
    worst[0] = std::max(worst[0], k % 2 == 0 ? from_v : from_u);
    worst[1] = std::max(worst[1], k % 2 == 0 ? from_u : from_v);
  }
  return {worst[1] <= worst[0], 360 / std::numbers::pi * std::min(worst[0], worst[1])};
}

// Triangles i and j that share the side between their corners, as a quad around it.
struct Pairing {
  Grain grain;  // its shape's obliqueness where the texture does not count
  std::size_t i, j;
  std::array<int, 4> quad;
};

using TextureTriangle = std::array<Eigen::Vector2d, 3>;

// The best pairs whose angles, or sides over the texture if there is one, are good; no triangle is
// in two.
std::vector<Pairing> pairings(const std::vector<Eigen::Vector3d>& x,
                              const std::vector<std::array<int, 3>>& triangles,
                              const std::vector<TextureTriangle>& texture) {
  std::map<Side, std::pair<std::size_t, std::size_t>> first;  // triangle and corner before the side
  std::vector<Pairing> all;
  for (std::size_t j = 0; j < triangles.size(); ++j)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [found, fresh] = first.try_emplace(side_of(triangles[j], k), j, k);
      if (fresh) continue;
      const auto [i, c] = found->second;
      const auto around = [i = i, c = c, j, k](const auto& of) {
        return std::array{of[i][(c + 2) % 3], of[i][c], of[j][(k + 2) % 3], of[i][(c + 1) % 3]};
      };
      const std::array<int, 4> quad = around(triangles);
      Grain how{false, obliqueness(x, quad)};
      if (!texture.empty()) {
        const auto at = around(texture);
        const auto &t = texture[j][k], &next = texture[j][(k + 1) % 3];
        if (!(t == at[3] && next == at[1]) && !(t == at[1] && next == at[3])) continue;  // a seam
        how = grain(at);
      }
      if (how.oblique <= most_oblique) all.push_back({how, i, j, quad});
    }
  std::ranges::stable_sort(all, {}, [](const Pairing& pair) { return pair.grain.oblique; });
  std::vector<char> taken(triangles.size(), 0);
  std::erase_if(all, [&](const Pairing& pair) {
    if (taken[pair.i] || taken[pair.j]) return true;
    taken[pair.i] = taken[pair.j] = 1;
    return false;
  });
  return all;
}

// A mesh being cut: each side into n, and faces accordingly.
struct Refinement {
  const ClothMesh& mesh;
  int n;
  ClothMesh fine = {mesh.vertices, {}, {}};
  std::map<Side, int> first_on = {};  // of n - 1 new vertices from the lower end on

  double part(int i) const { return static_cast<double>(i) / n; }

  int add(const Eigen::Vector3d& x) {
    fine.vertices.push_back(x);
    return static_cast<int>(fine.vertices.size()) - 1;
  }

  int on_side(int a, int b, int i) {  // i of n parts from a to b
    if (i == 0) return a;
    if (i == n) return b;
    const Side s = side(a, b);
    const auto [found, fresh] = first_on.try_emplace(s, static_cast<int>(fine.vertices.size()));
    if (fresh)
      for (int k = 1; k < n; ++k)
        add((1 - part(k)) * mesh.vertices[s.first] + part(k) * mesh.vertices[s.second]);
    return found->second + (a == s.first ? i : n - i) - 1;
  }

  int in_quad(const std::array<int, 4>& corners, int i, int j) {
    const auto [a, b, c, d] = corners;
    if (i == 0) return on_side(a, b, j);
    if (i == n) return on_side(d, c, j);
    if (j == 0) return on_side(a, d, i);
    if (j == n) return on_side(b, c, i);
    const auto& x = mesh.vertices;
    const double u = part(i), v = part(j);
    return add((1 - u) * ((1 - v) * x[a] + v * x[b]) + u * ((1 - v) * x[d] + v * x[c]));
  }

  int in_triangle(const std::array<int, 3>& corners, int i, int j) {  // i parts to b, j to c
    const auto [a, b, c] = corners;
    if (j == 0) return on_side(a, b, i);
    if (i == 0) return on_side(a, c, j);
    if (i + j == n) return on_side(b, c, j);
    const auto& x = mesh.vertices;
    const double u = part(i), v = part(j);
    return add((1 - u - v) * x[a] + u * x[b] + v * x[c]);
  }

  void cut(const std::array<int, 4>& quad) {
    std::vector<std::vector<int>> at(n + 1, std::vector<int>(n + 1));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) at[i][j] = in_quad(quad, i, j);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        fine.quads.push_back({at[i][j], at[i][j + 1], at[i + 1][j + 1], at[i + 1][j]});
  }

  void cut(const std::array<int, 3>& triangle) {
    std::map<std::pair<int, int>, int> known;
    const auto at = [&](int i, int j) {
      const auto [found, fresh] = known.try_emplace({i, j}, 0);
      if (fresh) found->second = in_triangle(triangle, i, j);
      return found->second;
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        fine.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < n) fine.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
};

template <class Face>
std::set<Side> sides_of(const std::vector<Face>& faces) {
  std::set<Side> sides;
  for (const Face& face : faces)
    for (std::size_t k = 0; k < face.size(); ++k) sides.insert(side_of(face, k));
  return sides;
}

// What keeps its length.
std::set<Side> constrained_sides(const ClothMesh& mesh) {
  std::set<Side> sides = mesh.medial ? sides_of(mesh.triangles) : sides_of(mesh.quads);
  for (const auto& [a, b] : mesh.ropes) sides.insert(side(a, b));
  return sides;
}

// Yarns are three vertices in a row: two of the sides that meet at the middle vertex are opposite
// each other. There are none where yarns end or five sides meet.
std::vector<std::array<int, 3>> yarns_of(const ClothMesh& mesh) {
  std::vector<std::set<int>> ends(mesh.vertices.size());
  for (const auto& [a, b] : sides_of(mesh.quads)) {
    ends[a].insert(b);
    ends[b].insert(a);
  }
  // Neighbours of a corner that are in one quad with it are not opposite each other.
  std::vector<std::set<Side>> beside(mesh.vertices.size());
  for (const auto& quad : mesh.quads)
    for (std::size_t k = 0; k < 4; ++k)
      beside[quad[k]].insert(side(quad[(k + 1) % 4], quad[(k + 3) % 4]));
  std::vector<std::array<int, 3>> yarns;
  for (std::size_t v = 0; v < ends.size(); ++v) {
    if (ends[v].size() > 4) continue;
    for (const int a : ends[v])
      for (const int b : ends[v]) {
        if (a >= b || beside[v].contains(side(a, b))) continue;
        // Within the cloth a side has one side opposite; on its rim the two along it are.
        const auto others = std::count_if(ends[v].begin(), ends[v].end(), [&](int c) {
          return c != a && !beside[v].contains(side(a, c));
        });
        if (others == 1 && ends[v].size() >= 3) yarns.push_back({a, static_cast<int>(v), b});
      }
  }
  return yarns;
}

// Each vertex's share of the faces around it.
std::vector<double> areas(const ClothMesh& mesh) {
  const auto& x = mesh.vertices;
  std::vector<double> all(x.size(), 0.0);
  for (const auto& [a, b, c, d] : mesh.quads) {
    // The mean of both ways to cut it.
    const double area = 0.5 * (triangle_area(x[a], x[b], x[c]) + triangle_area(x[a], x[c], x[d]) +
                               triangle_area(x[a], x[b], x[d]) + triangle_area(x[b], x[c], x[d]));
    for (const int v : {a, b, c, d}) all[v] += area / 4;
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const double area = (mesh.medial ? 4 : 1) * triangle_area(x[a], x[b], x[c]);
    for (const int v : {a, b, c}) all[v] += area / 3;
  }
  return all;
}

// Two triangles that share the midpoint m bend about the side that it halves, to which a1 - b1 and
// a2 - b2 are parallel. Of T1 = (m, a1, b1) and q = a2 or b2 the sum of coefficients times
// positions vanishes where both lie in one plane; turned by theta it is d theta, d the distance of
// q from the side. Both sums share the energy of a hinge, B / 2 theta^2 |side|^2 / (A1 + A2), which
// is right for triangles of equal sides with their corners on a cylinder, whichever way it is
// rolled (Seung and Nelson 1988, "Defects in flexible membranes with crystalline order").
inextensible::Bending hinges_of(const ClothMesh& mesh, double rigidity) {
  std::vector<std::vector<std::array<int, 2>>> across(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    across[a].push_back({b, c});
    across[b].push_back({c, a});
    across[c].push_back({a, b});
  }
  inextensible::Bending bending;
  for (int m = 0; m < static_cast<int>(across.size()); ++m) {
    if (across[m].size() != 2) continue;
    const auto [a1, b1] = across[m][0];
    const auto [b2, a2] = across[m][1];  // which runs the other way round
    const auto from_m = [&](int v) { return (mesh.vertices[v] - mesh.vertices[m]).eval(); };
    const Eigen::Vector3d side = from_m(b1) - from_m(a1), other = from_m(b2) - from_m(a2);
    const double length = side.norm();  // half of the side's
    const auto along = [&](int v, const Eigen::Vector3d& way) {
      return from_m(v).dot(way) / way.norm();
    };
    const double d1 = side.cross(from_m(a1)).norm() / length;
    const double d2 = other.cross(from_m(a2)).norm() / other.norm();
    const double area = 4 * 0.5 * (length * d1 + other.norm() * d2), ratio = d2 / d1;
    const double stiffness = rigidity * 2 * length * length / (area * d2 * d2);
    for (const int q : {a2, b2}) {
      if (mesh.held[a1] && mesh.held[b1] && mesh.held[m] && mesh.held[q]) continue;
      const double alpha = (along(q, other) + ratio * along(b1, side)) / length;
      bending.push_back({{a1, b1, m, q}, {alpha, ratio - alpha, -1 - ratio, 1}, stiffness});
    }
  }
  return bending;
}

}  // namespace

std::vector<int> pieces_of(const ClothMesh& mesh) {
  std::vector<std::array<int, 3>> joined = mesh.triangles;
  for (const auto& [a, b, c, d] : mesh.quads) joined.insert(joined.end(), {{a, b, c}, {a, c, d}});
  for (const auto& [a, b] : mesh.ropes) joined.push_back({a, b, b});
  return inextensible::pieces_of(mesh.vertices.size(), joined);
}

ClothMesh cloth_of(const MeshFile& file, bool triangles_only) {
  const std::vector<MeshFile::Face> faces = distinct_faces(file);
  check_sides(file, faces);
  ClothMesh cloth;
  std::vector<int> place(file.vertices.size(), -1);
  const auto vertex = [&](int v) {
    if (place[v] < 0) {
      place[v] = static_cast<int>(cloth.vertices.size());
      cloth.vertices.push_back(file.vertices[v]);
      cloth.in_file.push_back(v);
    }
    return place[v];
  };
  std::vector<std::array<int, 3>> triangles;
  std::vector<TextureTriangle> texture;
  bool textured = !triangles_only && !faces.empty() &&
                  std::ranges::none_of(faces, [](const auto& f) { return f.texture.empty(); });
  std::size_t aligned = 0;
  for (const auto& [c, line, points] : faces) {
    const auto at = [&, &of = points](std::size_t k) { return file.texture[of[k]]; };
    if (c.size() == 4 && !triangles_only) {
      cloth.quads.push_back({vertex(c[0]), vertex(c[1]), vertex(c[2]), vertex(c[3])});
      if (!textured) continue;
      const Grain of_quad = grain({at(0), at(1), at(2), at(3)});
      cloth.along_u.push_back(of_quad.along_u);
      aligned += of_quad.oblique <= most_oblique ? 1 : 0;
      continue;
    }
    for (std::size_t k = 1; k + 1 < c.size(); ++k) {
      triangles.push_back({vertex(c[0]), vertex(c[k]), vertex(c[k + 1])});
      if (textured) texture.push_back({at(0), at(k), at(k + 1)});
    }
  }
  std::vector<char> taken(triangles.size(), 0);
  if (!triangles_only) {
    std::vector<Pairing> pairs = pairings(cloth.vertices, triangles, {});
    if (textured) {
      std::vector<Pairing> along = pairings(cloth.vertices, triangles, texture);
      textured = 2 * (aligned + along.size()) >= cloth.quads.size() + pairs.size();
      if (textured) pairs = std::move(along);
      if (!textured) cloth.along_u.clear();  // it says nothing of warp and weft
    }
    for (const Pairing& pair : pairs) {
      taken[pair.i] = taken[pair.j] = 1;
      cloth.quads.push_back(pair.quad);
      if (textured) cloth.along_u.push_back(pair.grain.along_u);
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!taken[t]) cloth.triangles.push_back(triangles[t]);
  for (const auto& [a, b] : file.ropes) {
    if (file.vertices[a] == file.vertices[b])
      throw UsageError(concat("'", file.path, "': a line between vertices ", a + 1, " and ", b + 1,
                              " has no length"));
    cloth.ropes.push_back({vertex(a), vertex(b)});
  }
  return cloth;
}

ClothMesh refined(const ClothMesh& mesh, int n) {
  if (n == 1) return mesh;
  Refinement refinement{mesh, n};
  for (const auto& quad : mesh.quads) refinement.cut(quad);
  for (const char along : mesh.along_u)
    refinement.fine.along_u.insert(refinement.fine.along_u.end(), n * n, along);
  for (const auto& triangle : mesh.triangles) refinement.cut(triangle);
  for (const auto& [a, b] : mesh.ropes)
    for (int i = 0; i < n; ++i)
      refinement.fine.ropes.push_back(
          {refinement.on_side(a, b, i), refinement.on_side(a, b, i + 1)});
  return refinement.fine;
}

ClothMesh midpoints_of(const ClothMesh& mesh) {
  ClothMesh made;
  made.medial = true;
  std::map<Side, int> middle;
  for (const auto& triangle : mesh.triangles) {
    auto& corners = made.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Side s = side_of(triangle, k);
      const auto [found, fresh] = middle.try_emplace(s, static_cast<int>(made.vertices.size()));
      corners[k] = found->second;
      if (!fresh) continue;
      made.vertices.push_back(0.5 * (mesh.vertices[s.first] + mesh.vertices[s.second]));
      const auto either = [&](const std::vector<char>& flags) -> char {
        return !flags.empty() && (flags[s.first] || flags[s.second]);
      };
      made.held.push_back(either(mesh.held));
      made.loaded.push_back(either(mesh.loaded));
    }
  }
  return made;
}

ParameterInfos with_cloth_parameters(const ParameterInfos& own, const ClothDefaults& cloth,
                                     double duration) {
  return joined({own, fabric_parameters(cloth), {duration_info(duration)}});
}

// Sides that run along v of the texture; without one, none.
static std::set<Side> weft_of(const ClothMesh& mesh) {
  std::set<Side> weft;
  for (std::size_t q = 0; q < mesh.along_u.size(); ++q)
    for (const std::size_t k : {0, 2})
      weft.insert(side_of(mesh.quads[q], mesh.along_u[q] ? k + 1 : k));
  return weft;
}

// weft_limit: of weft over that of warp; the tighter one is the run's.
static void constrain(Draft& draft, const ClothMesh& mesh, const std::set<Side>& sides,
                      const std::set<Side>& weft, double weft_limit) {
  for (const auto& [a, b] : sides) {
    if (mesh.held[a] && mesh.held[b]) continue;
    draft.constrain(a, b, (mesh.vertices[a] - mesh.vertices[b]).norm());
    if (weft_limit != 1)
      draft.parts.limit_scale.push_back((weft.contains({a, b}) ? weft_limit : 1) /
                                        std::min(weft_limit, 1.0));
  }
}

Draft cloth_draft(const ClothMesh& mesh, const SceneParameters& p) {
  const auto length = [&](int a, int b) { return (mesh.vertices[a] - mesh.vertices[b]).norm(); };
  const auto held = [&](auto... vertices) { return (mesh.held[vertices] && ...); };
  const auto n = static_cast<int>(mesh.vertices.size());
  Draft draft(n, p);
  inextensible::ProblemParts& parts = draft.parts;
  Scene& scene = draft.scene;
  const std::vector<double> area = areas(mesh);
  std::vector<double> rope(mesh.vertices.size(), 0.0);  // each vertex's share, m
  for (const auto& [a, b] : mesh.ropes)
    for (const int v : {a, b}) rope[v] += length(a, b) / 2;
  for (int v = 0; v < n; ++v) {
    scene.start.x.col(v) = mesh.vertices[v];
    if (held(v)) parts.pinned.push_back(v);
    parts.mass.push_back(p.at("density") * area[v] + value_or_zero(p, "line_density") * rope[v]);
    if (p.at("drag") > 0) parts.drag.push_back(p.at("drag") * area[v]);
  }
  const std::set<Side> weft = weft_of(mesh);
  const std::set<Side> yarn_sides = constrained_sides(mesh);
  constrain(draft, mesh, yarn_sides, weft, p.contains("weft_limit") ? p.at("weft_limit") : 1);
  if (p.at("shear") > 0) {
    inextensible::Springs springs;
    const auto join = [&](int a, int b) {
      if (held(a, b)) return;
      springs.edges.push_back({a, b});
      springs.rest_length.push_back(length(a, b));
      springs.stiffness.push_back(p.at("shear"));
    };
    for (const auto& [a, b, c, d] : mesh.quads) {
      join(a, c);
      join(b, d);
    }
    for (const auto& [a, b] : sides_of(mesh.triangles))
      if (!yarn_sides.contains({a, b})) join(a, b);
    if (!springs.edges.empty()) parts.shear = std::move(springs);
  }
  if (p.at("bending") > 0) {
    if (mesh.medial) parts.bending = hinges_of(mesh, p.at("bending"));
    for (const auto& [a, b, c] : yarns_of(mesh)) {
      const double rigidity =
          p.at("bending") * (weft.contains(side(a, b)) ? p.at("weft_bending") : 1);
      if (held(a, b, c) || rigidity == 0) continue;
      const double before = length(a, b), after = length(b, c);
      const double width = area[b] / (0.5 * (before + after));
      parts.bending.push_back(inextensible::yarn_bending(a, b, c, before, after, rigidity * width));
    }
  }
  parts.implicit_forces = true;
  for (const auto& [a, b, c, d] : mesh.quads)
    scene.triangles.insert(scene.triangles.end(), {{a, b, d}, {c, d, b}});
  scene.triangles.insert(scene.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  scene.staggered = false;
  return draft;
}

std::pair<int, int> count_cloth(const ClothMesh& mesh) {
  const auto constrained = std::ranges::count_if(constrained_sides(mesh), [&](const Side& s) {
    return !mesh.held[s.first] || !mesh.held[s.second];
  });
  return {static_cast<int>(mesh.vertices.size()), static_cast<int>(constrained)};
}

}  // namespace harness
