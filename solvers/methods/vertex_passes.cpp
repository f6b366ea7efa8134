// Each loop over `width` vertices is of fixed length and without branches, so that compilers turn
// it into vector instructions. Vertices of a color that have fewer springs than others of their
// group are filled up with springs to themselves, of no stiffness. Loops: one over vertices
// and the ends of their springs a pass.
#include "solvers/methods/vertex_passes.h"

#include <iterator>
#include <map>

namespace inextensible {

// What meets at each vertex: springs' far ends in the order of springs, and bending's matrix.
struct VertexPasses::Ends {
  struct Spring {
    int other;
    double stiffness, rest_length;
  };
  std::vector<std::vector<Spring>> springs;
  std::vector<std::map<int, double>> bending;  // -H_ij by j
  std::vector<int> color;                      // -1: pinned

  Ends(const Problem& problem, const Springs& all, const Bending& stencils)
      : springs(problem.vertices()), bending(problem.vertices()), color(problem.vertices(), -1) {
    for (std::size_t k = 0; k < all.edges.size(); ++k) {
      const auto [a, b] = all.edges[k];
      springs[a].push_back({b, all.stiffness[k], all.rest_length[k]});
      springs[b].push_back({a, all.stiffness[k], all.rest_length[k]});
    }
    for (const BendingStencil& s : stencils)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
          const double entry = s.stiffness * s.coefficient[i] * s.coefficient[j];
          if (entry != 0 && s.vertex[i] != s.vertex[j]) bending[s.vertex[i]][s.vertex[j]] -= entry;
        }
    // The first color that no neighbour has: two colors on a woven net, four with shear springs.
    std::vector<char> taken;
    for (std::size_t v = 0; v < color.size(); ++v) {
      if (problem.inverse_mass()[v] == 0) continue;
      taken.assign(springs[v].size() + bending[v].size() + 1, 0);
      const auto take = [&](int other) {
        const int c = color[other];
        if (c >= 0 && c < std::ssize(taken)) taken[c] = 1;
      };
      for (const Spring& spring : springs[v]) take(spring.other);
      for (const auto& [other, entry] : bending[v]) take(other);
      color[v] = static_cast<int>(std::find(taken.begin(), taken.end(), 0) - taken.begin());
    }
  }
};

VertexPasses::VertexPasses(const Problem& problem, const Springs& springs, const Bending& bending)
    : place_(problem.vertices()) {
  const Ends ends(problem, springs, bending);
  place_vertices(ends);
  const auto places = static_cast<Eigen::Index>(vertex_.size());
  x_.setZero(places, 3);
  y_.setZero(places, 3);
  moved_.setZero(places, 3);
  inertia_.setOnes(places);
  push_.setZero(places);
  plane_.setZero(places, 4);
  for (Group& group : groups_) {
    group.entry = static_cast<int>(other_.size());
    group.pair = static_cast<int>(bent_with_.size());
    for (int i = group.place; i < group.place + width; ++i) {
      const int v = vertex_[i];
      if (v < 0) continue;
      group.springs = std::max(group.springs, static_cast<int>(ends.springs[v].size()));
      group.pairs = std::max(group.pairs, static_cast<int>(ends.bending[v].size()));
    }
    for (int s = 0; s < group.springs; ++s)
      for (int i = group.place; i < group.place + width; ++i) {
        const int v = vertex_[i];
        const bool filler = v < 0 || s >= std::ssize(ends.springs[v]);
        const Ends::Spring spring = filler ? Ends::Spring{} : ends.springs[v][s];
        other_.push_back(filler ? i : place_[spring.other]);
        stiffness_.push_back(spring.stiffness);
        rest_.push_back(spring.rest_length);
        entries_ += filler ? 0 : 1;
      }
    for (int s = 0; s < group.pairs; ++s)
      for (int i = group.place; i < group.place + width; ++i) {
        const int v = vertex_[i];
        const bool filler = v < 0 || s >= std::ssize(ends.bending[v]);
        const auto pair = filler ? ends.bending[0].end() : std::next(ends.bending[v].begin(), s);
        bent_with_.push_back(filler ? i : place_[pair->first]);
        bend_.push_back(filler ? 0 : pair->second);
        entries_ += filler ? 0 : 1;
      }
  }
  tension_.setZero(static_cast<Eigen::Index>(other_.size()));
}

// By color, and within one by the number of springs, so that groups are of a kind.
void VertexPasses::place_vertices(const Ends& ends) {
  const std::vector<int>& color = ends.color;
  std::vector<int> order;
  for (std::size_t v = 0; v < color.size(); ++v)
    if (color[v] >= 0) order.push_back(static_cast<int>(v));
  std::ranges::stable_sort(
      order, {}, [&](int v) { return std::pair(color[v], -std::ssize(ends.springs[v])); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || color[order[i]] != color[order[i - 1]])
      vertex_.resize((vertex_.size() + width - 1) / width * width, -1);
    place_[order[i]] = static_cast<int>(vertex_.size());
    vertex_.push_back(order[i]);
  }
  vertex_.resize((vertex_.size() + width - 1) / width * width, -1);
  free_places_ = static_cast<int>(vertex_.size());
  for (int i = 0; i < free_places_; i += width) groups_.push_back({i, 0, 0});
  for (std::size_t v = 0; v < color.size(); ++v) {
    if (color[v] >= 0) continue;
    place_[v] = static_cast<int>(vertex_.size());
    vertex_.push_back(static_cast<int>(v));
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
  for (int i = 0; i < free_places_; ++i)
    if (vertex_[i] >= 0) x.col(vertex_[i]) = x_.row(i).transpose();
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
  for (const Group& group : groups_)
    largest = std::max(largest, has_planes_ ? visit<true>(group, stiffness_scale, relaxation)
                                            : visit<false>(group, stiffness_scale, relaxation));
  return largest;
}

// Force (h: and Hessian xx, xy, xz, yy, yz, zz) of a group's vertices.
struct VertexPasses::Model {
  double f[3][width], h[6][width];
};

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

// The force of V and its matrix's diagonal, the same for all axes.
void VertexPasses::add_bending(const Group& group, double stiffness_scale, Model& model) const {
  auto& [f, h] = model;
  const double *x = x_.col(0).data(), *y = x_.col(1).data(), *z = x_.col(2).data();
  const int own = group.place;
  for (int s = 0; s < group.pairs; ++s) {
    const int* other = bent_with_.data() + group.pair + s * width;
    const double* bend = bend_.data() + group.pair + s * width;
#pragma GCC ivdep
    for (int i = 0; i < width; ++i) {
      const double b = stiffness_scale * bend[i];
      f[0][i] += b * (x[other[i]] - x[own + i]);
      f[1][i] += b * (y[other[i]] - y[own + i]);
      f[2][i] += b * (z[other[i]] - z[own + i]);
      h[0][i] += b, h[3][i] += b, h[5][i] += b;
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
  for (int i = 0; i < width; ++i)
    h[0][i] = h[3][i] = h[5][i] = inertia[i], h[1][i] = h[2][i] = h[4][i] = 0;
  add_springs(group, stiffness_scale, model);
  add_bending(group, stiffness_scale, model);
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
    const auto gap = [&](const double(&p)[3]) {
      return plane[0][i] * p[0] + plane[1][i] * p[1] + plane[2][i] * p[2] - plane[3][i];
    };
    double at[3] = {f[0][i], f[1][i], f[2][i]};
    solve(at);
    for (int axis = 0; axis < 3; ++axis) at[axis] += x[axis][i];
    if constexpr (with_planes) {
      // Where that is behind the plane: the minimum on the plane.
      const double behind = std::min(gap(at), 0.0);
      double q[3] = {plane[0][i], plane[1][i], plane[2][i]};
      solve(q);
      const double give = q[0] * plane[0][i] + q[1] * plane[1][i] + q[2] * plane[2][i];
      const double force = behind < 0 ? -behind / give : 0;  // no plane: all of it is 0
      push[i] = force / inertia[i];
      for (int axis = 0; axis < 3; ++axis) at[axis] += force * q[axis];
    }
    for (int axis = 0; axis < 3; ++axis) at[axis] += (relaxation - 1) * (at[axis] - x[axis][i]);
    if constexpr (with_planes) {  // on the plane, where relaxation led through it
      const double through = relaxation > 1 ? std::min(gap(at), 0.0) : 0;
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
  for (const Group& group : groups_)
    for (int s = 0; s < group.springs; ++s)
      for (int i = 0; i < width; ++i) {
        const int own = group.place + i, entry = group.entry + s * width + i;
        const Eigen::RowVector3d d = x_.row(other_[entry]) - x_.row(own);
        const double length = d.norm();
        if (length > 0) moved_.row(own) += tension_[entry] / (inertia_[own] * length) * d;
      }
  x_.swap(moved_);
}

bool VertexPasses::update_tensions(double strain_limit) {
  // A few roundings narrower than what is permissible.
  const double low = (1 - strain_limit) * (1 + 1e-15), high = (1 + strain_limit) * (1 - 1e-15);
  const double *x = x_.col(0).data(), *y = x_.col(1).data(), *z = x_.col(2).data();
  int violations = 0;
  for (const Group& group : groups_)
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
  return violations == 0;
}

}  // namespace inextensible
