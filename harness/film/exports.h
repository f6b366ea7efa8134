// A take as files that other programs read.
#pragma once

#include <string>
#include <vector>

#include "harness/film/recording.h"

namespace harness {

// All write into a folder, which is made, and return the paths of what to open. A body beside the
// cloth has files of its own, <name>-body...: one where it stays, else as many as the cloth.

// Wavefront OBJ, one file a frame, <name>-0001.obj and so on: faces of a cloth, lines of a chain.
std::vector<std::string> write_obj(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name);

// VTK XML for ParaView: a .vtp a frame with the strain of every edge as a field, and a .pvd that
// plays them.
std::vector<std::string> write_vtk(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name);

// The first frame as OBJ and a point cache (PC2) for Blender's modifier "Mesh Cache", which reads
// it as an animated object.
std::vector<std::string> write_pc2(const Recording& recording, const FilmRun& take,
                                   const std::string& folder, const std::string& name);

}  // namespace harness
