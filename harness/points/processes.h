// Solvers that are programs of their own: `bench --plugin 'cmd:./my_engine --bench'`. The scene
// goes to them as files (scenes/scene_folder.h), steps as numbers through pipes (docs/plugins.md).
#pragma once

#include "solvers/methods/backend.h"

namespace harness {

struct ProcessSolver {
  inextensible::Backend row;
  std::string version;
};

// Starts the program, which describes itself, and ends it. Throws std::runtime_error, saying what
// is wrong. command: as for a shell; its texts live until this program ends.
ProcessSolver process_solver(const std::string& command);

}  // namespace harness
