// Friction's potential is mu N f(y) of the distance y that a vertex has slid since the start of the
// step: f' = 2 y / s - (y / s)^2 up to the slip s, 1 beyond. It is convex, and curves f' / y across
// the slide and less along it; f' / y is taken for both. (With f'' along it, which is 0 where a
// vertex slides, Newton's direction fails on soft springs and needs no fewer iterations on stiff
// ones.)
#include "inextensible/systems/contact_energy.h"

#include <algorithm>

namespace inextensible {
namespace {

double potential(double y, double s) {
  return y < s ? y * y / s - y * y * y / (3 * s * s) : y - s / 3;
}

double over_distance(double y, double s) {  // f' / y
  return y < s ? (2 - y / s) / s : 1 / y;
}

}  // namespace

ContactEnergy::ContactEnergy(const Contacts& contacts, int vertices, double stiffness, double slip)
    : contacts_(contacts),
      stiffness_(stiffness),
      slip_(slip),
      pressure_(vertices, 0.0),
      borne_(vertices, 0.0) {}

void ContactEnergy::expect_pressures(const std::vector<double>& mass, double h,
                                     const Positions& x) {
  for (int c = 0; c < contacts_.count(); ++c) {
    const int vertex = contacts_.vertex(c);
    pressure_[c] = borne_[vertex] > 0
                       ? borne_[vertex]
                       : mass[vertex] * std::max(0.0, -contacts_.gap(c, x.col(vertex))) / (h * h);
  }
}

void ContactEnergy::accept() {
  std::fill(borne_.begin(), borne_.end(), 0.0);
  for (int c = 0; c < contacts_.count(); ++c) borne_[contacts_.vertex(c)] = pressure_[c];
}

double ContactEnergy::take_pressures(const Positions& x) {
  double change = 0, sum = 0;
  for (int c = 0; c < contacts_.count(); ++c) {
    const double now = stiffness_ * std::max(0.0, -contacts_.gap(c, x.col(contacts_.vertex(c))));
    change += std::abs(now - pressure_[c]);
    sum += now;
    pressure_[c] = now;
  }
  return sum > 0 ? change / sum : 0;
}

double ContactEnergy::value(const Positions& x) const {
  double energy = 0;
  for (int c = 0; c < contacts_.count(); ++c) {
    const Eigen::Vector3d at = x.col(contacts_.vertex(c));
    const double depth = std::max(0.0, -contacts_.gap(c, at));
    energy += 0.5 * stiffness_ * depth * depth;
    const double slid = contacts_.tangential(c, at).norm();
    energy += contacts_.friction() * pressure_[c] * potential(slid, slip_);
  }
  return energy;
}

ContactEnergy::Derivatives ContactEnergy::derivatives(int contact, const Eigen::Vector3d& x) const {
  const Eigen::Vector3d n = contacts_.normal(contact), t = contacts_.tangential(contact, x);
  const Eigen::Matrix3d across = n * n.transpose();
  const double gap = contacts_.gap(contact, x);
  const double grip = contacts_.friction() * pressure_[contact] * over_distance(t.norm(), slip_);
  Derivatives d{grip * t, grip * (Eigen::Matrix3d::Identity() - across)};
  if (gap < 0) {
    d.first += stiffness_ * gap * n;
    d.second += stiffness_ * across;
  }
  return d;
}

}  // namespace inextensible
