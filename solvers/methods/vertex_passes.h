// Visits of all vertices in colors, each moved alone to the minimum of its energy's quadratic
// model: what vertex block descent (Chen, Liu, Yang and Yuksel 2024) and its augmented Lagrangian
// form share. Vertices of a color, visited side by side, share no spring or bending stencil.
#pragma once

#include "solvers/problem/contacts.h"

namespace inextensible {

// The energy, in kg m^2: with d_k the length of spring k, l_k at rest,
//   1/2 sum_i m_i |x_i - y_i|^2 + sum_k (k_k / 2 (d_k - l_k)^2 + t_k (d_k - l_k)) + V(x),
// V of bending, quadratic; stiffnesses k_k (kg) and V's, and tensions t_k (kg m), being h^2 times
// those of a step of h seconds.
class VertexPasses {
 public:
  VertexPasses(const Problem& problem, const Springs& springs, const Bending& bending = {});

  // Positions and targets (3 x n), inertia (n); store() leaves pinned vertices alone.
  void load(const Positions& x, const Positions& y, const std::vector<double>& inertia);
  void store(Positions& x) const;
  bool finite() const { return x_.allFinite(); }

  // Every free vertex once: `relaxation` times one Newton step on its energy, the others held
  // fixed, the Hessian without what is negative across a spring. stiffness_scale multiplies the
  // springs' stiffnesses. Returns the largest move's square, m^2.
  double visit_all(double stiffness_scale, double relaxation = 1);
  // A vertex with a plane stays out of its half-space; contacts must not outlive the next call.
  // null: none.
  void set_planes(const Contacts* contacts);
  void read_pushes(Contacts& contacts) const;  // of the last pass

  // Moves all free vertices at once by what tensions do to their inertia.
  void follow_tensions();
  // t_k += k_k (d_k - l_k), the step of the method of multipliers. Whether all springs end within
  // `strain_limit`.
  bool update_tensions(double strain_limit);
  Eigen::ArrayXd& tensions() { return tension_; }  // by entry: both ends of a spring have one

  // Ends of springs, and pairs of bending, at free vertices.
  int entries() const { return entries_; }

 private:
  static constexpr int width = 8;  // vertices that are visited side by side
  struct Group {
    int place, entry, springs;  // its first place and entry, entries a vertex
    int pair = 0, pairs = 0;    // the same of bending
  };
  struct Ends;
  void place_vertices(const Ends& ends);
  struct Model;
  void add_springs(const Group& group, double stiffness_scale, Model& model) const;
  void add_bending(const Group& group, double stiffness_scale, Model& model) const;
  template <bool with_planes>
  double visit(const Group& group, double stiffness_scale, double relaxation);

  std::vector<Group> groups_;  // by color
  std::vector<int> vertex_;    // at a place, -1: none
  std::vector<int> place_;     // of a vertex; pinned ones come last
  int free_places_ = 0, entries_ = 0;
  std::vector<int> other_;  // by entry: the place of the other end
  std::vector<double> stiffness_, rest_;
  Eigen::ArrayXd tension_;
  // -H_ij of V, by pair, and the place of j. Rows of H have the sum 0: each pair is a spring of no
  // length, whose stiffness may be negative.
  std::vector<int> bent_with_;
  std::vector<double> bend_;
  Eigen::MatrixX3d x_, y_, moved_;
  Eigen::ArrayXd inertia_;
  Eigen::ArrayX4d plane_;  // normal and offset, by place; 0 and -infinity: none
  Eigen::ArrayXd push_;    // m
  bool has_planes_ = false;
};

}  // namespace inextensible
