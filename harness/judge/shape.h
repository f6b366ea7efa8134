// The shape of a cloth at rest in four numbers: potential energy over weight times size, mean
// height of the corners over size, area of the shadow on a horizontal plane over size^2, and folds.
#pragma once

#include <map>
#include <string>

#include "harness/scenes/scene.h"

namespace harness {

bool is_cloth(const Scene& scene);  // it has a shadow and a hem

// m^2, of the cloth's shadow on a horizontal plane as far as `reach` (m) from the y axis along x
// and z: counted on a raster of pixels x pixels.
double shadow_area(const Scene& scene, const inextensible::Positions& x, double reach, int pixels);

// How often the hem rises and falls again by 2 % of the size or more on one way around the cloth. 0
// where its triangles have no single hem.
int count_folds(const Scene& scene, const inextensible::Positions& x);

using Shape = std::map<std::string, double>;
Shape shape_of(const Scene& scene, const inextensible::Positions& x);

// What a cloth at rest is judged by: x's shape minus y's.
Shape rest_difference(const Scene& scene, const inextensible::Positions& x,
                      const inextensible::Positions& y);

}  // namespace harness
