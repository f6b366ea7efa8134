// One block of chain_kkt.cpp: with A the 3 x 3 block of M + H at a vertex less what it has lost to
// blocks before, g the gradient of the edge's C there and k its curvature in H, the block and its
// coupling to the next vertex are
//   P = [ A    g ]      [ -k I ]
//       [ g^T  0 ]  and [ -g^T ].
// P (y, z) = (r, c) has the solution
//   y = s c + S (r - A s c),  z = s^T (r - A y),  s = g / |g|^2,
// where S is the inverse of A across g. P is regular where that exists, whatever A is along the
// edge, so nothing needs to be permuted; and K has the right inertia, M + H positive definite on
// the null space of J, if and only if A across g is positive definite in every block.
//
// Spelled out as numbers, as in tridiagonal.cpp.
#pragma once

#include <cmath>

namespace inextensible::chain {

// Smallest determinant of A across g, over its norm squared.
constexpr double least_determinant = 1e-14;

struct Vector {
  double x = 0, y = 0, z = 0;
};
inline Vector load(const double* p) { return {p[0], p[1], p[2]}; }
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double f, Vector a) { return {f * a.x, f * a.y, f * a.z}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Symmetric {
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
};
inline Vector operator*(const Symmetric& a, Vector v) {
  return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
          a.xz * v.x + a.yz * v.y + a.zz * v.z};
}
// a += factor (v w^T + w v^T) / 2
inline void add_product(Symmetric& a, double factor, Vector v, Vector w) {
  a.xx += factor * v.x * w.x;
  a.yy += factor * v.y * w.y;
  a.zz += factor * v.z * w.z;
  a.xy += 0.5 * factor * (v.x * w.y + v.y * w.x);
  a.xz += 0.5 * factor * (v.x * w.z + v.z * w.x);
  a.yz += 0.5 * factor * (v.y * w.z + v.z * w.y);
}
inline void add_diagonal(Symmetric& a, double number) {
  a.xx += number, a.yy += number, a.zz += number;
}
inline void add_scaled(Symmetric& a, double factor, const Symmetric& b) {
  a.xx += factor * b.xx, a.xy += factor * b.xy, a.yy += factor * b.yy;
  a.xz += factor * b.xz, a.yz += factor * b.yz, a.zz += factor * b.zz;
}

struct ChainBlock {
  Vector g, s, a;     // a = A s
  Symmetric inverse;  // S; at the end of a chain that of A
  double curvature = 0;
  // Magnitudes of the pivots, and how many are negative.
  double smallest = 1, largest = 1;
  int negative = 0;

  // The block of an edge; false: it is not regular.
  bool pivot(const Symmetric& matrix) {
    const double squared = dot(g, g);
    s = (1 / squared) * g;
    a = matrix * s;
    const Vector n = (1 / std::sqrt(squared)) * g;
    const Vector an = std::sqrt(squared) * a;
    const double along = dot(n, an);
    Symmetric across = matrix;  // (I - n n^T) A (I - n n^T)
    add_product(across, -2, n, an);
    add_product(across, along, n, n);
    const double trace = across.xx + across.yy + across.zz;
    const double norm = across.xx * across.xx + across.yy * across.yy + across.zz * across.zz +
                        2 * (across.xy * across.xy + across.xz * across.xz + across.yz * across.yz);
    const double determinant = 0.5 * (trace * trace - norm);
    // S = (trace (I - n n^T) - across) / determinant, as for any 2 x 2 matrix
    inverse = {};
    add_diagonal(inverse, trace / determinant);
    add_product(inverse, -trace / determinant, n, n);
    add_scaled(inverse, -1 / determinant, across);
    largest = std::sqrt(norm);
    smallest = std::abs(determinant) / largest;
    negative = 1 + (determinant < 0 ? 1 : trace < 0 ? 2 : 0);                // 1: the multiplier's
    return squared > 0 && std::abs(determinant) > least_determinant * norm;  // false on NaN
  }

  // The block of the last vertex of a chain without pins.
  bool pivot_last(const Symmetric& m) {
    const double cxx = m.yy * m.zz - m.yz * m.yz, cxy = m.xz * m.yz - m.xy * m.zz,
                 cxz = m.xy * m.yz - m.xz * m.yy;
    const double determinant = m.xx * cxx + m.xy * cxy + m.xz * cxz;
    const double leading = m.xx * m.yy - m.xy * m.xy;
    inverse = {cxx, cxy, m.xx * m.zz - m.xz * m.xz, cxz, m.xy * m.xz - m.xx * m.yz, leading};
    const double f = 1 / determinant;
    inverse = {f * inverse.xx, f * inverse.xy, f * inverse.yy,
               f * inverse.xz, f * inverse.yz, f * inverse.zz};
    g = s = a = {};
    // Jacobi's rule: as often as the leading minors change their sign.
    negative =
        (m.xx < 0 ? 1 : 0) + (m.xx * leading < 0 ? 1 : 0) + (leading * determinant < 0 ? 1 : 0);
    largest = std::abs(m.xx) + std::abs(m.yy) + std::abs(m.zz);
    smallest = std::abs(determinant) / (largest * largest);
    return m.xx != 0 && leading != 0 && smallest > least_determinant * largest;
  }

  // What is left of the next block's A.
  void take_from(Symmetric& next) const {
    const Vector b = inverse * a;
    add_scaled(next, -curvature * curvature, inverse);
    add_product(next, 2 * curvature, b - s, g);
    add_product(next, dot(a, s) - dot(a, b), g, g);
  }

  struct Solution {
    Vector y;
    double z;
  };
  Solution solve(Vector r, double c) const {
    const Vector y = c * s + inverse * (r - c * a);
    return {y, dot(s, r) - dot(a, y)};
  }
};

}  // namespace inextensible::chain
