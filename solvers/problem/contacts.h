// The vertices that a collider keeps out of its obstacle during one step: where each may not go,
// and what has been done to keep it from there.
//
// A step with contact and Coulomb friction moves a vertex, beside all else, by push along the
// plane's normal n and by drag within the plane, such that
//   push >= 0,  n . x >= offset,  push (n . x - offset) = 0,
//   |drag| <= mu push, and the vertex stays where it began the step, or |drag| = mu push against
//   the way it slides.
// On an obstacle that moves, "where it began" moves with it.
// settle() visits vertices by projected Gauss-Seidel for these (Jourdan, Alart and Jean 1998): push
// and drag are kept, so that a contact can be let go of again, and friction grows with all that
// presses, gravity or the tension of the cloth.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "inextensible/problem/obstacle.h"

namespace inextensible {

class Contacts {
 public:
  // The problem has a collider, and outlives this.
  explicit Contacts(const Problem& problem);

  // A step of h begins at x_start (3 x n) and `time`, s; there are no contacts. The obstacle is
  // where it will be when the step ends, and carries along what friction holds.
  void begin(const Positions& x_start, double time, double h);

  // Adds a contact for every vertex of x that is inside and has none; one that is inside in spite
  // of its plane, as it may be where the obstacle is not convex, takes the plane that is nearest
  // now. Returns how many were inside, deeper than `tolerance()`.
  int find(const Positions& x, WorkCounters& work);
  double tolerance() const { return tolerance_; }  // m

  // Visits every contact once; x(vertex, axis) is a coordinate to read and write.
  template <class Access>
  void settle(const Access& x);
  void settle(Positions& x) {
    settle([&x](int vertex, int axis) -> double& { return x(axis, vertex); });
  }

  // Takes from displacements d (3 x n, m) what leads through or out of a plane that holds its
  // vertex.
  void keep_in_planes(Positions& d) const;
  // Takes from velocities v (3 x n, m/s) of vertices at x what leads them through or out of a plane
  // that holds them, as it moves.
  void keep_on_planes(const Positions& x, Positions& v) const;

  // What a step must do in the end, whatever it did before: leaves no vertex inside.
  void push_out(Positions& x, WorkCounters& work);

  int count() const { return count_; }
  int vertex(int contact) const { return vertex_[contact]; }
  Eigen::Vector3d normal(int contact) const { return vector(normal_x, contact); }
  bool holds(int contact) const { return value(push, contact) > 0; }

  double friction() const { return friction_; }  // Coulomb coefficient
  // Of its vertex at x: m above the plane; and the way since the start of the step, within it and
  // as the obstacle sees it.
  double gap(int contact, const Eigen::Vector3d& x) const {
    return normal(contact).dot(x) - value(offset, contact);
  }
  Eigen::Vector3d tangential(int contact, const Eigen::Vector3d& x) const {
    const Eigen::Vector3d way = x - vector(start_x, contact);
    return way - way.dot(normal(contact)) * normal(contact);
  }

  // What settle() has done so far, to be taken up again with the positions of that time and no
  // contacts found since.
  struct Record {
    std::array<std::vector<double>, 4> done;
  };
  void save(Record& record) const;
  void restore(const Record& record);

 private:
  // Numbers of a contact, m; each has a column of its own.
  enum Number {
    normal_x,
    normal_y,
    normal_z,
    offset,
    start_x,
    start_y,
    start_z,
    push,
    drag_x,
    drag_y,
    drag_z,
    numbers
  };
  static constexpr int lanes = 8;  // contacts that are visited side by side

  double& value(Number number, int contact) { return numbers_[number][contact]; }
  double value(Number number, int contact) const { return numbers_[number][contact]; }
  Eigen::Vector3d vector(Number first, int contact) const {
    return {numbers_[first][contact], numbers_[first + 1][contact], numbers_[first + 2][contact]};
  }
  void set_plane(int contact, const ContactPlane& plane);
  void visit(int first, double (&x)[3][lanes]);

  const Problem& problem_;
  double tolerance_, friction_;
  const Positions* start_ = nullptr;
  // Of an obstacle that moves: what it does during the step, and how long that is, s.
  Pose carry_;
  double h_ = 0;
  int count_ = 0;
  std::vector<int> vertex_;
  std::array<std::vector<double>, numbers> numbers_;  // filled up to whole lanes
  std::vector<int> place_;                            // of a vertex's contact, or -1
  Obstacle obstacle_;
  std::vector<ContactPlane> found_;
};

// Contacts first ... first + lanes - 1, at x. Without branches, so that compilers turn it into
// vector instructions.
inline void Contacts::visit(int first, double (&x)[3][lanes]) {
  const double* n[3] = {&value(normal_x, first), &value(normal_y, first), &value(normal_z, first)};
  const double* begin[3] = {&value(start_x, first), &value(start_y, first), &value(start_z, first)};
  double* d[3] = {&value(drag_x, first), &value(drag_y, first), &value(drag_z, first)};
  const double* plane = &value(offset, first);
  double* pushed = &value(push, first);
  const double mu = friction_;
#pragma GCC ivdep
  for (int i = 0; i < lanes; ++i) {
    const double n0 = n[0][i], n1 = n[1][i], n2 = n[2][i];
    const double gap = n0 * x[0][i] + n1 * x[1][i] + n2 * x[2][i] - plane[i];
    const double now = std::max(0.0, pushed[i] - gap), more = now - pushed[i];
    pushed[i] = now;
    const double p0 = x[0][i] + more * n0, p1 = x[1][i] + more * n1, p2 = x[2][i] + more * n2;
    const double w0 = p0 - begin[0][i], w1 = p1 - begin[1][i], w2 = p2 - begin[2][i];
    const double along = w0 * n0 + w1 * n1 + w2 * n2;
    // What would hold it where it began; as much of it as friction can.
    const double h0 = d[0][i] - (w0 - along * n0), h1 = d[1][i] - (w1 - along * n1),
                 h2 = d[2][i] - (w2 - along * n2);
    const double most = mu * now, squared = h0 * h0 + h1 * h1 + h2 * h2;
    const double part = squared > most * most ? most / std::sqrt(squared) : 1;
    x[0][i] = p0 + (part * h0 - d[0][i]);
    x[1][i] = p1 + (part * h1 - d[1][i]);
    x[2][i] = p2 + (part * h2 - d[2][i]);
    d[0][i] = part * h0;
    d[1][i] = part * h1;
    d[2][i] = part * h2;
  }
}

template <class Access>
void Contacts::settle(const Access& at) {
  double x[3][lanes] = {};
  for (int first = 0; first < count_; first += lanes) {
    const int here = std::min(lanes, count_ - first);
    const int* vertex = vertex_.data() + first;
    for (int i = 0; i < here; ++i) {
      for (int axis = 0; axis < 3; ++axis) x[axis][i] = at(vertex[i], axis);
    }
    visit(first, x);
    for (int i = 0; i < here; ++i) {
      for (int axis = 0; axis < 3; ++axis) at(vertex[i], axis) = x[axis][i];
    }
  }
}

}  // namespace inextensible
