// A rope that hangs by one end, vertex 0.
#pragma once

#include "solvers/problem/problem.h"

namespace inextensible::testing {

struct HangingRope {
  static constexpr double gravity = 9.81;
  // Links of this length (m), vertices of this mass (kg).
  HangingRope(int links, double length, double mass) {
    ProblemParts parts;
    parts.gravity = {0, -gravity, 0};
    parts.mass.assign(links + 1, mass);
    parts.pinned = {0};
    parts.rest_length.assign(links, length);
    start = {Positions::Zero(3, links + 1), Positions::Zero(3, links + 1), 0};
    for (int i = 0; i < links; ++i) {
      parts.edges.push_back({i, i + 1});
      start.x(1, i + 1) = -length * (i + 1);
    }
    problem = std::make_shared<const Problem>(parts);
  }
  std::shared_ptr<const Problem> problem;
  State start;  // at rest
};

}  // namespace inextensible::testing
