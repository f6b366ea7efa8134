// Rows and squares of vertices that scenes are made of, and the parameters that scenes share.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

// A scene whose problem is still open: pins, colliders and positions may change.
struct Draft {
  // Vertices at rest at the origin; gravity and duration are the parameters.
  Draft(int vertices, const SceneParameters& p);
  void constrain(int a, int b, double length);

  inextensible::ProblemParts parts;
  Scene scene;
};
// Throws std::invalid_argument for parts that make no problem.
Scene finished(Draft draft);
// The same with these vertices pinned, where nothing dissipates.
Scene released(Draft draft, std::vector<int> pinned);

// n vertices along x, each constrained to the next, `mass` kg and `length` m in all; at rest, in
// one place. Parameters: n, length, mass, duration, and gravity if there is any.
Draft vertex_row(const SceneParameters& p);

// n x n vertices on a horizontal square, centred over the origin at the height y (m), at rest; row
// i goes along z, column j along x, and vertex (i, j) has the number i n + j. Warp and weft are
// constrained; both diagonals of each quad are springs where `shear` is positive. Parameters: n,
// side, mass or density, shear, duration, and gravity, bending and drag if there are any. With a
// density it is a fabric, whose forces, in physical units, are those at the end of the step: as a
// spring of stiffness G each diagonal gives the cloth the shear stiffness G, since turned by gamma
// both change by l gamma / sqrt(2), and bear G (l gamma)^2 / 2 together.
Draft vertex_square(const SceneParameters& p, double y);

// Edge lengths of rows and squares, m.
double row_link(const SceneParameters& p);
double square_link(const SceneParameters& p);

// Vertices and constraints of the above.
std::pair<int, int> count_row(const SceneParameters& p);
std::pair<int, int> count_square(const SceneParameters& p);

inline int whole(const SceneParameters& p, const char* name = "n") {
  return static_cast<int>(p.at(name));
}

inline double value_or_zero(const SceneParameters& p, const char* name) {
  return p.contains(name) ? p.at(name) : 0;
}

// ---- Families of scenes ----
// To add one: a function that returns its scenes, here and in the list of scene.cpp.
std::vector<SceneType> line_scenes();
std::vector<SceneType> cloth_scenes();
std::vector<SceneType> worn_scenes();
std::vector<SceneType> spinning_scenes();
std::vector<SceneType> hanging_scenes();

// ---- What is known of chains ----
// omega_k, rad/s, k from 1 on, of the small oscillations of N equal masses on links of length l (m)
// that hang from a point: omega_k^2 = (g / l) x_k, x_k the k-th zero of the Laguerre polynomial L_N
// (Bernoulli 1733 for the limit of many). g: m/s^2. 1 <= mode <= masses.
double hanging_frequency(int masses, double link, double gravity, int mode);

// s, after which the free end of a chain that is folded into a U has fallen this part of the
// length.
//
// With s the way of the free end over the chain's length L, v its speed and mu the mass per length,
// the moving arm is (1 - s) L / 2 long. Without gravity, v = v_0 / sqrt(1 - s); falling from rest,
// v^2 = g L s (2 - s) / (1 - s) (Calkin and March 1989; Schagerl et al. 1997 measured it). A chain
// of links follows this to O(link / L), as long as several links move.
double folded_fall_time(double part, double length, double gravity);

// ---- Parameters ----
using ParameterInfos = std::vector<SceneParameterInfo>;

inline constexpr double zero_too = -1e-300;  // as an exclusive bound: 0 is allowed

inline SceneParameterInfo gravity_info(double least = -1e4) {
  return {"gravity", 9.81, "m/s^2, along -y", least, 1e4};
}
inline SceneParameterInfo duration_info(double seconds = 1) {
  return {"duration", seconds, "s", 0, 1e4};
}
inline SceneParameterInfo drag_info(double drag) {
  return {"drag", drag, "of still air, N s/m^3: force per area and speed; 0: none", zero_too, 1e6};
}
inline SceneParameterInfo friction_info(double friction) {
  return {"friction", friction, "Coulomb coefficient", zero_too, 1e3};
}
// Where a cloth in physical units begins.
struct ClothDefaults {
  double density, shear, bending, drag;  // units as below
};
inline ParameterInfos fabric_parameters(const ClothDefaults& cloth) {
  return {{"density", cloth.density, "kg/m^2", 0, 1e4},
          gravity_info(),
          {"shear", cloth.shear, "shear stiffness, N/m; 0: none", zero_too, 1e9},
          {"bending", cloth.bending,
           "bending rigidity of warp and weft, straight at rest, N m; 0: none", zero_too, 1e6},
          drag_info(cloth.drag)};
}
inline ParameterInfos joined(std::initializer_list<ParameterInfos> parts) {
  ParameterInfos all;
  for (const ParameterInfos& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}
// What vertex_row reads, with the scene's own parameters in between.
inline ParameterInfos row_parameters(const SceneParameterInfo& n, const ParameterInfos& own,
                                     double duration = 1) {
  return joined({{n, {"length", 1, "m", 0, 1e6}, {"mass", 1, "total, kg", 0, 1e6}},
                 own,
                 {duration_info(duration)}});
}

}  // namespace harness
