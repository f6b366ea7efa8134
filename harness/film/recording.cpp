#include "harness/film/recording.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "harness/base/files.h"
#include "harness/base/json_text.h"
#include "harness/judge/mechanics.h"

namespace harness {
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
nlohmann::json sags(const FilmScene& stage, const FilmRun& take) {
  nlohmann::json all = nlohmann::json::object();
  for (const Scene::Mark& mark : stage.marks) {
    nlohmann::json& sag = all[mark.name] = nlohmann::json::array();
    for (const auto& frame : take.frames) sag.push_back(mark.height - frame(1, mark.vertex));
  }
  return all;
}

nlohmann::json film_header(const Recording& recording) {
  nlohmann::json takes = nlohmann::json::array(), body = nlohmann::json::array(),
                 poses = nlohmann::json::array();
  for (const FilmRun& take : recording.takes)
    takes.push_back({{"solver", take.solver},
                     {"label", take.label},
                     {"strain_limit", take.strain_limit},
                     {"step", take.step},
                     {"detail", take.detail},
                     {"energy_gained", take.energy_gained},
                     {"frames", take.frames.size()},
                     {"largest_strain", take.largest_strain},
                     {"sag", sags(recording.stage, take)},
                     {"seconds", take.seconds}});
  for (const Eigen::Vector3d& v : recording.stage.body) body.push_back({v.x(), v.y(), v.z()});
  for (const inextensible::Pose& pose : recording.stage.body_poses) {
    const auto& r = pose.turn;
    poses.push_back({r(0, 0), r(0, 1), r(0, 2), pose.translation[0], r(1, 0), r(1, 1), r(1, 2),
                     pose.translation[1], r(2, 0), r(2, 1), r(2, 2), pose.translation[2]});
  }
  return {{"schema", "inextensible-film/1"},
          {"scene", recording.spec.scene},
          {"scene_parameters", recording.spec.parameters},
          {"frames_per_second", recording.spec.frames_per_second},
          {"vertices", recording.takes.empty() ? 0 : recording.takes[0].frames[0].cols()},
          {"triangles", recording.stage.triangles},
          {"edges", recording.stage.edges},
          {"strain_unit", strain_unit},
          {"body", body},
          {"body_triangles", recording.stage.body_triangles},
          {"body_poses", poses},
          {"takes", takes}};
}

std::string film_strains(const Recording& recording) {
  std::string bytes;
  for (const FilmRun& take : recording.takes) {
    for (const inextensible::Positions& frame : take.frames) {
      for (const double strain : strains_of_vertices(recording.stage, frame))
        bytes += static_cast<char>(static_cast<unsigned char>(
            std::min(255.0, std::round(strain / take.strain_limit / strain_unit))));
    }
  }
  return bytes;
}

std::string film_positions(const Recording& recording) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes;
  for (const FilmRun& take : recording.takes) {
    for (const inextensible::Positions& frame : take.frames) {
      const Eigen::Matrix3Xf single = frame.cast<float>();
      bytes.append(reinterpret_cast<const char*>(single.data()),
                   static_cast<std::size_t>(single.size()) * sizeof(float));
    }
  }
  return bytes;
}

}  // namespace

void write_film_header(const std::string& folder, const Recording& recording) {
  write_atomically(folder + "/film.json", compact(film_header(recording)) + "\n");
}

void write_recording(const std::string& folder, const Recording& recording) {
  write_film_header(folder, recording);
  write_atomically(folder + "/film.f32", film_positions(recording));
  write_atomically(folder + "/film.u8", film_strains(recording));
}

}  // namespace harness
