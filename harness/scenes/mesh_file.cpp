#include "harness/scenes/mesh_file.h"

#include <cmath>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/files.h"

namespace harness {
namespace {

// "7", "7/1/3", "7//3", "-1": corners count from 1, or backwards from the last vertex so far.
int corner_of(const std::string& word, std::size_t vertices, const std::string& where) {
  std::size_t read = 0;
  long number = 0;
  try {
    number = std::stol(word, &read);
  } catch (const std::exception&) {
    read = 0;
  }
  if (read == 0 || (read < word.size() && word[read] != '/'))
    throw UsageError(where + ": '" + word + "' is no corner of a face, like 7 or 7/1/3");
  const auto count = static_cast<long>(vertices);
  const long index = number < 0 ? count + number : number - 1;
  if (number == 0 || index < 0 || index >= count)
    throw UsageError(where + ": no vertex " + std::to_string(number) + " among the " +
                     std::to_string(count) + " so far");
  return static_cast<int>(index);
}

}  // namespace

MeshFile read_mesh_file(const std::string& path) {
  std::istringstream lines(read_file(path, "mesh"));
  MeshFile mesh;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = "'" + path + "', line " + std::to_string(++number);
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Eigen::Vector3d v;
      words >> v.x() >> v.y() >> v.z();
      if (!words || !v.allFinite()) throw UsageError(where + ": a vertex needs three numbers");
      mesh.vertices.push_back(v);
    } else if (word == "f") {
      std::vector<int>& face = mesh.faces.emplace_back();
      while (words >> word) face.push_back(corner_of(word, mesh.vertices.size(), where));
      if (face.size() < 3) throw UsageError(where + ": a face needs three corners or more");
    }
  }
  if (mesh.faces.empty())
    throw UsageError("'" + path + "' has no faces: is it a mesh in Wavefront's OBJ format?");
  return mesh;
}

}  // namespace harness
