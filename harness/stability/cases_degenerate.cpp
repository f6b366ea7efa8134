// Collapsed and degenerate starts.
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case.h"

namespace harness {

using namespace case_parts;

void add_degenerate(std::vector<HardCase>& cases, const HardCaseValues& /*values*/) {
  const char* row = "degenerate";
  cases.push_back(
      {row,
       "coincident",
       "both ends of an edge in one place, falling together",
       [] {
         Mesh mesh = chain(3, {1, 0, 0}, false);
         mesh.start.x.col(2) = mesh.start.x.col(1);
         mesh.start.x.col(3) = mesh.start.x.col(1) + Eigen::Vector3d(1.0 / 3, 0, 0);
         return trial_of(std::move(mesh), 0.01, 3);
       },
       {{springs, survives, "a spring without direction pulls nowhere, and nothing else does"},
        {{"admm"},
         refuses,
         "the edge has no direction to grow along",
         {{survives,
           "the linear system may part its ends by a rounding, and any direction is brought to "
           "full "
           "length at once"}}},
        {everyone, refuses, "the edge has no direction to grow along"}}});
  cases.push_back({row,
                   "folded",
                   "20 links folded flat onto the first",
                   [] {
                     Mesh mesh = chain(20);
                     for (int i = 0; i <= 20; ++i) mesh.start.x.col(i) << 0.05 * (i % 2), 0, 0;
                     return trial_of(std::move(mesh), 1.0 / 400, 200);
                   },
                   {{start_direction, survives,
                     "links unfold at 100 rad/s at most, a quarter of a radian a step"},
                    {strain_limiting, survives, "20 links: some hundred passes"},
                    {everyone, survives, "a chain's J has full rank unless pulled taut"}}});
  cases.push_back({row,
                   "plumb",
                   "all edges parallel: a chain at rest, hanging straight down",
                   [] {
                     return trial_of(chain(20, {0, -1, 0}), 1.0 / 100, 100);
                   },
                   {{everyone, survives, "J has full rank"}}});
  cases.push_back({row,
                   "upright",
                   "a chain standing straight up on its pin",
                   [] {
                     return trial_of(chain(20, {0, 1, 0}), 1.0 / 100, 30);
                   },
                   {{everyone, survives,
                     "an unstable equilibrium, but J has full rank, and in 0.3 s rounding does not "
                     "grow to anything"}}});
}

}  // namespace harness
