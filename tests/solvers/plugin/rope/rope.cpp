// The velocity filter in a program of one's own, as one call after the program's own time step.
#include <solvers/registry.h>
#include <solvers/systems/constraint_system.h>

#include <cstdio>

int main() {
  using namespace inextensible;
  // A rope of 1 m and 20 links, horizontal, held at vertex 0.
  constexpr int links = 20;
  constexpr double h = 0.01;
  ProblemParts parts;
  parts.mass.assign(links + 1, 0.05);
  parts.pinned = {0};
  Positions x = Positions::Zero(3, links + 1), v = x;
  for (int i = 0; i <= links; ++i) {
    x(0, i) = i / double{links};
    if (i == 0) continue;
    parts.edges.push_back({i - 1, i});
    parts.rest_length.push_back(1.0 / links);
  }
  const Problem problem(parts);
  const auto filter = make_velocity_filter("fast_projection", problem, {.strain_limit = 0.001});
  const EdgeConstraints edges(problem, 0.001);
  WorkCounters work;

  double before = 0, after = 0;
  for (int step = 0; step < 100; ++step) {
    v.rightCols(links).row(1).array() -= 9.81 * h;  // whatever moves the vertices in your program
    Positions filtered = x + h * v;
    before = std::max(before, std::abs(edges.worst(filtered).strain));
    if (!filter->apply(x, h, filtered, work)) return 1;  // refused: a smaller step is needed
    v = (filtered - x) / h;
    x = filtered;
    after = std::max(after, std::abs(edges.worst(x).strain));
  }
  std::printf("largest strain %.3g without the filter, %.3g with it\n", before, after);
  return before > 0.01 && after <= 0.001 ? 0 : 1;
}
