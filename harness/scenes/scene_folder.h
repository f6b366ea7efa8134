// A scene as files that other programs read and write: scene.json (configs/scene.schema.json), the
// cloth and the body as OBJ, and the reference's positions as NumPy arrays. Names in scene.json are
// those of solvers/inextensible.h.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "harness/scenes/scene.h"

namespace harness {

// Writes scene.json, cloth.obj and, if there is a body, body.obj. A body that moves is written as
// poses at intervals of a millisecond; between them it is read back by interpolation. With
// reference: scene.json names reference.npz, which the caller writes.
void write_scene(const std::string& folder, const SceneType& type, const SceneParameters& complete,
                 bool reference);

// Whether a scene's name is that of such a folder: "folder:PATH,content=HASH", or the path alone.
bool names_folder(std::string_view scene);

// Reads scene.json and the meshes. Throws UsageError, naming file and key, for what is no scene.
SceneType folder_scene(const std::string& name);

}  // namespace harness
