// Each loop over `width` vertices is of fixed length and without branches, so that compilers turn
// it into vector instructions. Vertices of a color that have fewer springs than others of their
// group are filled up with springs to themselves, of no stiffness. Loops: one over vertices
// and the ends of their springs a pass.
#include "solvers/methods/vertex_passes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inextensible {
namespace {

// The first color that no neighbour has, vertex after vertex: two colors on a woven net, four with
// its shear springs. -1: pinned.
std::vector<int> colors_of(const Problem& problem, const std::vector<std::vector<int>>& at,
                           const Springs& springs) {
  std::vector<int> color(at.size(), -1);
  std::vector<char> taken;
  for (std::size_t v = 0; v < at.size(); ++v) {
    if (problem.inverse_mass()[v] == 0) continue;
    taken.assign(at[v].size() + 1, 0);
    for (const int k : at[v]) {
      const Edge e = springs.edges[k];
      const int c = color[e.a == static_cast<int>(v) ? e.b : e.a];
      if (c >= 0 && c < std::ssize(taken)) taken[c] = 1;
    }
    color[v] = static_cast<int>(std::find(taken.begin(), taken.end(), 0) - taken.begin());
  }
  return color;
}

}  // namespace

VertexPasses::VertexPasses(const Problem& problem, const Springs& springs)
    : place_(problem.vertices()) {
  std::vector<std::vector<int>> at(problem.vertices());
  for (std::size_t k = 0; k < springs.edges.size(); ++k) {
    at[springs.edges[k].a].push_back(static_cast<int>(k));
    at[springs.edges[k].b].push_back(static_cast<int>(k));
  }
  place_vertices(problem, at, springs);
  const auto places = static_cast<Eigen::Index>(vertex_.size());
  x_.setZero(places, 3);
  y_.setZero(places, 3);
  moved_.setZero(places, 3);
  inertia_.setOnes(places);
  push_.setZero(places);
  plane_.setZero(places, 4);
  std::vector<double> stiffness, rest;
  for (Group& group : groups_) {
    group.entry = static_cast<int>(other_.size());
    for (int i = group.place; i < group.place + width; ++i) {
      if (vertex_[i] >= 0)
        group.springs = std::max(group.springs, static_cast<int>(at[vertex_[i]].size()));
    }
    for (int s = 0; s < group.springs; ++s) {
      for (int i = group.place; i < group.place + width; ++i) {
        const int v = vertex_[i];
        const bool filler = v < 0 || s >= std::ssize(at[v]);
        const int k = filler ? -1 : at[v][s];
        other_.push_back(
            filler ? i : place_[springs.edges[k].a == v ? springs.edges[k].b : springs.edges[k].a]);
        stiffness.push_back(filler ? 0 : springs.stiffness[k]);
        rest.push_back(filler ? 0 : springs.rest_length[k]);
        entries_ += filler ? 0 : 1;
      }
    }
  }
  const auto all = static_cast<Eigen::Index>(other_.size());
  stiffness_ = Eigen::Map<const Eigen::ArrayXd>(stiffness.data(), all);
  rest_ = Eigen::Map<const Eigen::ArrayXd>(rest.data(), all);
  tension_.setZero(all);
}

// By color, and within one by the number of springs, so that groups are of a kind.
void VertexPasses::place_vertices(const Problem& problem, const std::vector<std::vector<int>>& at,
                                  const Springs& springs) {
  const std::vector<int> color = colors_of(problem, at, springs);
  std::vector<int> order;
  for (int v = 0; v < problem.vertices(); ++v) {
    if (color[v] >= 0) order.push_back(v);
  }
  std::stable_sort(order.begin(), order.end(), [&](int p, int q) {
    return color[p] != color[q] ? color[p] < color[q] : at[p].size() > at[q].size();
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || color[order[i]] != color[order[i - 1]])
      vertex_.resize((vertex_.size() + width - 1) / width * width, -1);
    place_[order[i]] = static_cast<int>(vertex_.size());
    vertex_.push_back(order[i]);
  }
  vertex_.resize((vertex_.size() + width - 1) / width * width, -1);
  free_places_ = static_cast<int>(vertex_.size());
  for (int i = 0; i < free_places_; i += width) groups_.push_back({i, 0, 0});
  for (int v = 0; v < problem.vertices(); ++v) {
    if (color[v] >= 0) continue;
    place_[v] = static_cast<int>(vertex_.size());
    vertex_.push_back(v);
  }
}

void VertexPasses::load(const Positions& x, const Positions& y,
                        const std::vector<double>& inertia) {
  for (std::size_t v = 0; v < place_.size(); ++v) {
    const auto column = static_cast<Eigen::Index>(v);
    x_.row(place_[v]) = x.col(column).transpose();
    y_.row(place_[v]) = y.col(column).transpose();
    inertia_[place_[v]] = inertia[v];
  }
}

void VertexPasses::store(Positions& x) const {
  for (int i = 0; i < free_places_; ++i) {
    if (vertex_[i] >= 0) x.col(vertex_[i]) = x_.row(i).transpose();
  }
}

void VertexPasses::set_planes(const Contacts* contacts) {
  has_planes_ = contacts && contacts->count() > 0;
  if (!has_planes_) return;
  plane_.leftCols<3>().setZero();
  plane_.col(3).setConstant(-std::numeric_limits<double>::infinity());
  for (int c = 0; c < contacts->count(); ++c) {
    const int i = place_[contacts->vertex(c)];
    plane_.row(i) << contacts->normal(c).transpose().array(),
        -contacts->gap(c, Eigen::Vector3d::Zero());
  }
}

void VertexPasses::read_pushes(Contacts& contacts) const {
  for (int c = 0; c < contacts.count(); ++c)
    contacts.set_push(c, push_[place_[contacts.vertex(c)]]);
}

double VertexPasses::visit_all(double stiffness_scale, double relaxation) {
  double largest = 0;
  for (const Group& group : groups_) {
    largest = std::max(largest, has_planes_ ? visit<true>(group, stiffness_scale, relaxation)
                                            : visit<false>(group, stiffness_scale, relaxation));
  }
  return largest;
}

// Force (h: and Hessian xx, xy, xz, yy, yz, zz) of a group's vertices.
struct VertexPasses::Model {
  double f[3][width], h[6][width];
};

// Adds the springs at a group's vertices.
void VertexPasses::add_springs(const Group& group, double stiffness_scale, Model& model) const {
  auto& [f, h] = model;
  const double *x = x_.col(0).data(), *y = x_.col(1).data(), *z = x_.col(2).data();
  const int own = group.place;
  for (int s = 0; s < group.springs; ++s) {
    const int first = group.entry + s * width;
    const int* other = other_.data() + first;
    const double *rest = rest_.data() + first, *tension = tension_.data() + first,
                 *stiffness = stiffness_.data() + first;
#pragma GCC ivdep
    for (int i = 0; i < width; ++i) {
      const double dx = x[other[i]] - x[own + i], dy = y[other[i]] - y[own + i],
                   dz = z[other[i]] - z[own + i];
      const double squared = dx * dx + dy * dy + dz * dz;
      // One of no length has no direction and no force.
      const double inverse = squared > 0 ? 1 / std::sqrt(squared) : 0;
      const double along = stiffness_scale * stiffness[i];
      const double pull = along * (squared * inverse - rest[i]) + tension[i];
      const double nx = dx * inverse, ny = dy * inverse, nz = dz * inverse;
      const double across = std::max(0.0, pull) * inverse, more = along - across;
      f[0][i] += pull * nx, f[1][i] += pull * ny, f[2][i] += pull * nz;
      h[0][i] += more * nx * nx + across, h[1][i] += more * nx * ny, h[2][i] += more * nx * nz;
      h[3][i] += more * ny * ny + across, h[4][i] += more * ny * nz;
      h[5][i] += more * nz * nz + across;
    }
  }
}

template <bool with_planes>
double VertexPasses::visit(const Group& group, double stiffness_scale, double relaxation) {
  Model model;
  auto& [f, h] = model;
  const double* inertia = inertia_.data() + group.place;
  double* x[3];
  for (int axis = 0; axis < 3; ++axis) {
    x[axis] = x_.col(axis).data() + group.place;
    const double* to = y_.col(axis).data() + group.place;
    for (int i = 0; i < width; ++i) f[axis][i] = inertia[i] * (to[i] - x[axis][i]);
  }
  for (int i = 0; i < width; ++i) {
    h[0][i] = h[3][i] = h[5][i] = inertia[i];
    h[1][i] = h[2][i] = h[4][i] = 0;
  }
  add_springs(group, stiffness_scale, model);
  const double* plane[4];
  for (int n = 0; n < 4; ++n) plane[n] = plane_.col(n).data() + group.place;
  double* push = push_.data() + group.place;
  double moved[width];
#pragma GCC ivdep
  for (int i = 0; i < width; ++i) {
    // L D L^T.
    const double d0 = 1 / h[0][i], l1 = h[1][i] * d0, l2 = h[2][i] * d0;
    const double d1 = 1 / (h[3][i] - l1 * h[1][i]), e = h[4][i] - l2 * h[1][i], l3 = e * d1;
    const double d2 = 1 / (h[5][i] - l2 * h[2][i] - l3 * e);
    const auto solve = [&](double(&b)[3]) {
      b[1] -= l1 * b[0];
      b[2] = d2 * (b[2] - l2 * b[0] - l3 * b[1]);
      b[1] = d1 * b[1] - l3 * b[2];
      b[0] = d0 * b[0] - l1 * b[1] - l2 * b[2];
    };
    double at[3] = {f[0][i], f[1][i], f[2][i]};
    solve(at);
    for (int axis = 0; axis < 3; ++axis) at[axis] += x[axis][i];
    if constexpr (with_planes) {
      // Where that is behind the plane: the minimum on the plane.
      const double gap =
          plane[0][i] * at[0] + plane[1][i] * at[1] + plane[2][i] * at[2] - plane[3][i];
      double q[3] = {plane[0][i], plane[1][i], plane[2][i]};
      solve(q);
      const double give = q[0] * plane[0][i] + q[1] * plane[1][i] + q[2] * plane[2][i];
      const double force = gap < 0 ? -gap / give : 0;
      push[i] = force / inertia[i];
      for (int axis = 0; axis < 3; ++axis) at[axis] += force * q[axis];
    }
    for (int axis = 0; axis < 3; ++axis) at[axis] += (relaxation - 1) * (at[axis] - x[axis][i]);
    if constexpr (with_planes) {  // on the plane, where relaxation led through it
      const double gap =
          plane[0][i] * at[0] + plane[1][i] * at[1] + plane[2][i] * at[2] - plane[3][i];
      const double through = relaxation > 1 && gap < 0 ? gap : 0;
      for (int axis = 0; axis < 3; ++axis) at[axis] -= through * plane[axis][i];
    }
    moved[i] = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double way = at[axis] - x[axis][i];
      moved[i] += way * way;
      x[axis][i] = at[axis];
    }
  }
  return *std::max_element(moved, moved + width);
}

void VertexPasses::follow_tensions() {
  moved_ = x_;
  for (const Group& group : groups_) {
    for (int s = 0; s < group.springs; ++s) {
      for (int i = 0; i < width; ++i) {
        const int own = group.place + i, entry = group.entry + s * width + i;
        const Eigen::RowVector3d d = x_.row(other_[entry]) - x_.row(own);
        const double length = d.norm();
        if (length > 0) moved_.row(own) += tension_[entry] / (inertia_[own] * length) * d;
      }
    }
  }
  x_.swap(moved_);
}

bool VertexPasses::update_tensions(double strain_limit) {
  // A few roundings narrower than what is permissible.
  const double low = (1 - strain_limit) * (1 + 1e-15), high = (1 + strain_limit) * (1 - 1e-15);
  const double *x = x_.col(0).data(), *y = x_.col(1).data(), *z = x_.col(2).data();
  int violations = 0;
  for (const Group& group : groups_) {
    for (int s = 0; s < group.springs; ++s) {
      const int first = group.entry + s * width, own = group.place;
      const int* other = other_.data() + first;
      const double *rest = rest_.data() + first, *stiffness = stiffness_.data() + first;
      double* tension = tension_.data() + first;
#pragma GCC ivdep
      for (int i = 0; i < width; ++i) {
        const double dx = x[other[i]] - x[own + i], dy = y[other[i]] - y[own + i],
                     dz = z[other[i]] - z[own + i];
        const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
        tension[i] += stiffness[i] * (length - rest[i]);
        violations += static_cast<int>(length < low * rest[i]) |
                      static_cast<int>(!(length <= high * rest[i]));
      }
    }
  }
  return violations == 0;
}

}  // namespace inextensible
