// A scene as files that other programs read and write: scene.json (configs/scene.schema.json), the
// cloth and the body as OBJ, and the reference's positions as NumPy arrays. Names in scene.json are
// those of solvers/inextensible.h.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/scenes/scene.h"

namespace harness {

// Writes scene.json, cloth.obj and, if there is a body, body.obj. A body that moves is written as
// poses at intervals of a millisecond; between them it is read back by interpolation. about: what
// scene.json says beside the physics; the second is what it says of a scene of this program.
void write_scene(const std::string& folder, const Scene& scene,
                 const nlohmann::json& about = nlohmann::json::object());
nlohmann::json about(const SceneType& type, const SceneParameters& complete);

// Through poses at equal intervals (s) from time 0 on, at rest after the last: translations on
// lines, turns about one axis between two.
BodyMotion motion_through(std::vector<Pose> poses, double interval);

// Whether a scene's name is that of such a folder: "folder:PATH,content=HASH", or the path alone.
bool names_folder(std::string_view scene);

// Reads scene.json and the meshes. Throws UsageError, naming file and key, for what is no scene.
SceneType folder_scene(const std::string& name);

}  // namespace harness
