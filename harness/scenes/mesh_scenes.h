// Cloth from a mesh of one's own: "mesh:shirt.obj,pins=y>1.2,body=body.obj".
//
// Warp and weft are the sides of quads. Triangles that make a good quad together are taken for one,
// and what is left of them holds with springs alone: a net of inextensible triangles would not
// bend. A body is a closed mesh.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "harness/scenes/scene.h"

namespace harness {

bool names_mesh(std::string_view scene);  // "mesh:..."

// The scene's name with pins ("y > 1.2", several joined by "and"; in the file's unit) and a body.
// Throws UsageError where one is given and the scene is no mesh.
std::string with_mesh_parts(const std::string& scene, const std::string& pins,
                            const std::string& body);

// Reads the files. Throws UsageError, naming file and place, for what can be no cloth.
SceneType mesh_scene(const std::string& name);

}  // namespace harness
