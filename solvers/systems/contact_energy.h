// Contact and friction as an energy, for methods that minimize one: a stiff spring across each
// plane, which pushes and never pulls, and friction of pressures that are known (lagged), with the
// smooth potential of Li et al. 2020 (Incremental Potential Contact, section 5).
#pragma once

#include <vector>

#include "inextensible/problem/contacts.h"

namespace inextensible {

class ContactEnergy {
 public:
  // contacts: those of the present step; they outlive this. stiffness: N/m. slip: m, within which
  // friction grows to its full strength.
  ContactEnergy(const Contacts& contacts, int vertices, double stiffness, double slip);

  // Pressures from now on: those of the last accepted step, and at new contacts what stops masses m
  // that would be at x in one step of h without contact; or those that the springs bear at x. The
  // latter returns by how much the sum of pressures has changed, over their sum.
  void expect_pressures(const std::vector<double>& mass, double h, const Positions& x);
  double take_pressures(const Positions& x);
  void accept();  // the present pressures are those of an accepted step

  double value(const Positions& x) const;  // J
  // Of a contact at its vertex's position. The second derivative is positive semidefinite, and
  // along a slide larger than it is.
  struct Derivatives {
    Eigen::Vector3d first;
    Eigen::Matrix3d second;
  };
  Derivatives derivatives(int contact, const Eigen::Vector3d& x) const;

 private:
  const Contacts& contacts_;
  double stiffness_, slip_;
  std::vector<double> pressure_;  // N, of each contact
  std::vector<double> borne_;     // N, of each vertex in the last accepted step
};

}  // namespace inextensible
