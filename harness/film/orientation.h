// Triangles that all turn the same way, so that normals do not flip from one to the next.
#pragma once

#include <array>
#include <vector>

namespace harness {

// Turns triangles so that two with a common side pass it in opposite directions; the first triangle
// of each connected part stays as it is. A surface with one side only cannot be turned that way:
// there it is left wrong along a line.
std::vector<std::array<int, 3>> oriented(std::vector<std::array<int, 3>> triangles);

}  // namespace harness
