// The active set of contacts around an equation solver (Nocedal and Wright 2006, section 16.5).
// Vertices that planes hold stay on them while positions are solved for. Then a plane that would
// have to pull releases its vertex, one that a vertex went through holds it, and the rest is solved
// for again.
#pragma once

#include <vector>

#include "solvers/problem/iterate.h"

namespace inextensible {

class ActiveContacts {
 public:
  explicit ActiveContacts(const Problem& problem);

  // At the candidate x0 (3 x n), whose contacts are settled.
  void begin(Iterate x0);
  // The candidate, with its held vertices on their planes, to x.
  void write_candidate(Positions& x) const;
  // Held vertices of x, onto their planes.
  void hold(Positions& x) const;
  // Removes the reactions of planes, along the normals of held vertices, from the residual f (3 x
  // n) of equations scaled by these masses, and stores them.
  void take_reactions(const Eigen::VectorXd& mass, Positions& f);
  // At a solution x, after take_reactions(): releases planes that would pull, holds with those that
  // were crossed, and updates pushes. Returns whether other vertices are held now.
  bool update(const Positions& x);

 private:
  Contacts* contacts_ = nullptr;
  Positions free_;                // the candidate without any push
  std::vector<double> reaction_;  // of each contact, along its normal, over the vertex's mass, m
};

}  // namespace inextensible
