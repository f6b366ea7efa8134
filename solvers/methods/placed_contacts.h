// The planes of a step's contacts, side by side with the places of colored edges: passes settle
// them in vectors, without looking up a vertex.
#pragma once

#include <vector>

#include "solvers/methods/colored_edges.h"
#include "solvers/problem/contacts.h"

namespace inextensible {

class PlacedContacts {
 public:
  // contact: whether there may be contacts at all; else nothing is allocated.
  PlacedContacts(const ColoredEdges& edges, bool contact);

  // Takes planes and pushes of `contacts` over; to be done again whenever those have changed.
  void load(const Contacts& contacts, const ColoredEdges& edges);
  // Gives the pushes back.
  void store(Contacts& contacts, const ColoredEdges& edges) const;

  // Contacts::settle(), at x.
  void settle(ColoredEdges::Places& x);

  // Normals of planes that hold their vertex, by place; zero elsewhere.
  const ColoredEdges::Places& held_normals();

 private:
  static constexpr int width = Contacts::lanes;  // places that are settled side by side

  std::vector<int> blocks_;  // first places of those blocks of `width` that have a contact
  ColoredEdges::Places normal_, held_;
  Eigen::ArrayXd offset_, push_;
};

}  // namespace inextensible
