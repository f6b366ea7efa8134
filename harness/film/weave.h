// The triangles of a film's cloth: all turned the same way, and which of their sides are drawn as
// lines: every edge, or of a fine cloth every second or third yarn and so on, so that they stay
// lines.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "harness/film/recording.h"

namespace harness {

// Turns triangles so that two with a common side pass it in opposite directions, and normals do not
// flip from one to the next; the first triangle of each connected part stays as it is. A surface
// with one side only cannot be turned that way: there it is left wrong along a line.
std::vector<std::array<int, 3>> oriented(std::vector<std::array<int, 3>> triangles);

// One bit for each side of a triangle: 1 from corner 0 to 1, 2 from 1 to 2, 4 from 2 to 0. `every`:
// one of so many yarns is drawn; above 1, only those of a cloth of quads.
std::vector<std::uint8_t> drawn_sides(const FilmScene& stage, int every);

// The cloth's mean edge length, m; 0 without edges.
double mean_edge(const FilmScene& stage);

}  // namespace harness
