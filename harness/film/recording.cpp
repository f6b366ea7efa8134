#include "harness/film/recording.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "harness/base/files.h"
#include "harness/base/json.h"
#include "harness/judge/mechanics.h"

namespace harness {

using nlohmann::json;

namespace {

constexpr double strain_unit = 1.0 / 60;  // of a take's limit; colours end at four times that

}  // namespace

std::vector<double> strains(const FilmScene& stage, const inextensible::Positions& x) {
  std::vector<double> all;
  all.reserve(stage.edges.size());
  for (std::size_t k = 0; k < stage.edges.size(); ++k) {
    const auto [a, b] = stage.edges[k];
    all.push_back(strain_size(x, a, b, stage.rest_length[k]));
  }
  return all;
}

std::vector<double> strains_of_vertices(const FilmScene& stage, const inextensible::Positions& x) {
  std::vector<double> most(static_cast<std::size_t>(x.cols()), 0);
  const std::vector<double> all = strains(stage, x);
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const int end : stage.edges[k]) most[end] = std::max(most[end], all[k]);
  return most;
}

inextensible::Positions body_at(const FilmScene& stage, std::size_t frame) {
  const inextensible::Pose pose =
      stage.body_poses.empty() ? inextensible::Pose{} : stage.body_poses.at(frame);
  inextensible::Positions x(3, stage.body.size());
  for (std::size_t i = 0; i < stage.body.size(); ++i)
    x.col(static_cast<Eigen::Index>(i)) = pose(stage.body[i]);
  return x;
}

namespace {

// Sag of each mark at each frame: how far below the height where it would hang if nothing
// stretched, m.
json sags(const FilmScene& stage, const FilmRun& take) {
  json all = json::object();
  for (const Scene::Mark& mark : stage.marks) {
    json& sag = all[mark.name] = json::array();
    for (const auto& frame : take.frames) sag.push_back(mark.height - frame(1, mark.vertex));
  }
  return all;
}

json film_header(const Recording& recording) {
  const FilmScene& stage = recording.stage;
  json takes = json::array(), body = json::array(), poses = json::array();
  for (const FilmRun& take : recording.takes)
    takes.push_back({{"solver", take.solver},
                     {"label", take.label},
                     {"strain_limit", take.strain_limit},
                     {"step", take.step},
                     {"detail", take.detail},
                     {"energy_gained", take.energy_gained},
                     {"frames", take.frames.size()},
                     {"largest_strain", take.largest_strain},
                     {"sag", sags(stage, take)},
                     {"seconds", take.seconds}});
  for (const Eigen::Vector3d& v : stage.body) body.push_back({v.x(), v.y(), v.z()});
  for (const inextensible::Pose& pose : stage.body_poses) {
    json& rows = poses.emplace_back(json::array());
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) rows.push_back(pose.turn(i, k));
      rows.push_back(pose.translation[i]);
    }
  }
  return {{"schema", "inextensible-film/1"},
          {"scene", recording.spec.scene},
          {"scene_parameters", recording.spec.parameters},
          {"frames_per_second", recording.spec.frames_per_second},
          {"vertices", recording.takes.empty() ? 0 : recording.takes[0].frames[0].cols()},
          {"triangles", stage.triangles},
          {"edges", stage.edges},
          {"strain_unit", strain_unit},
          {"body", body},
          {"body_triangles", stage.body_triangles},
          {"body_poses", poses},
          {"takes", takes}};
}

template <class Append>
std::string of_every_frame(const Recording& recording, Append append) {
  std::string bytes;
  for (const FilmRun& take : recording.takes) {
    for (const inextensible::Positions& frame : take.frames) append(bytes, take, frame);
  }
  return bytes;
}

}  // namespace

void write_film_header(const std::string& folder, const Recording& recording) {
  write_atomically(folder + "/film.json", compact(film_header(recording)) + "\n");
}

void write_recording(const std::string& folder, const Recording& recording) {
  write_film_header(folder, recording);
  static_assert(std::endian::native == std::endian::little);
  const auto positions = [](std::string& bytes, const FilmRun&, const inextensible::Positions& x) {
    const Eigen::Matrix3Xf single = x.cast<float>();
    bytes.append(reinterpret_cast<const char*>(single.data()),
                 static_cast<std::size_t>(single.size()) * sizeof(float));
  };
  const auto strains = [&](std::string& bytes, const FilmRun& take,
                           const inextensible::Positions& x) {
    for (const double strain : strains_of_vertices(recording.stage, x))
      bytes += static_cast<char>(static_cast<unsigned char>(
          std::min(255.0, std::round(strain / take.strain_limit / strain_unit))));
  };
  write_atomically(folder + "/film.f32", of_every_frame(recording, positions));
  write_atomically(folder + "/film.u8", of_every_frame(recording, strains));
}

}  // namespace harness
