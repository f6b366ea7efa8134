#include "harness/film/pictures.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <map>
#include <mutex>
#include <numeric>
#include <set>
#include <thread>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"

namespace harness {
namespace {

constexpr int legend_end = 4;       // strain over its limit
constexpr double line_spacing = 7;  // pixels between yarns, below which their lines are fainter

// Cloth's own colour up to the limit, warm beyond it; linear. `over_limit`: strain over its limit.
Eigen::Vector3d strain_colour(double over_limit) {
  struct Stop {
    double at;
    Eigen::Vector3d rgb;
  };
  // Four times the limit is as red as it gets.
  static const std::array<Stop, 5> stops{{{0, {0.80, 0.78, 0.72}},
                                          {0.5, {0.58, 0.70, 0.80}},
                                          {1, {0.25, 0.50, 0.75}},
                                          {1.5, {0.95, 0.70, 0.25}},
                                          {4, {0.80, 0.12, 0.10}}}};
  for (std::size_t i = 1; i < stops.size(); ++i) {
    if (!(over_limit < stops[i].at)) continue;
    const double part =
        std::max(0.0, over_limit - stops[i - 1].at) / (stops[i].at - stops[i - 1].at);
    return linear(Eigen::Vector3d(stops[i - 1].rgb + part * (stops[i].rgb - stops[i - 1].rgb)));
  }
  return linear(stops.back().rgb);
}

// Color of each vertex, by the largest strain of its edges.
Eigen::Matrix3Xd colours_of(const FilmScene& stage, const inextensible::Positions& x,
                            double limit) {
  const std::vector<double> most = strains_of_vertices(stage, x);
  Eigen::Matrix3Xd colours(3, x.cols());
  for (Eigen::Index v = 0; v < x.cols(); ++v) colours.col(v) = strain_colour(most[v] / limit);
  return colours;
}

using Side = std::pair<int, int>;

std::vector<std::uint8_t> yarns_of(const FilmScene& stage) {
  std::set<Side> edges;
  for (const auto& [a, b] : stage.edges) edges.insert(std::minmax(a, b));
  std::vector<std::uint8_t> sides;
  sides.reserve(stage.triangles.size());
  for (const auto& t : stage.triangles) {
    unsigned yarns = 0;
    for (unsigned k = 0; k < 3; ++k)
      if (edges.contains(std::minmax(t[k], t[(k + 1) % 3]))) yarns |= 1U << k;
    sides.push_back(static_cast<std::uint8_t>(yarns));
  }
  return sides;
}

// Mean length of the cloth's edges, m; 0 without edges.
double mean_edge(const FilmScene& stage) {
  if (stage.rest_length.empty()) return 0;
  return std::accumulate(stage.rest_length.begin(), stage.rest_length.end(), 0.0) /
         static_cast<double>(stage.rest_length.size());
}

struct Picture {
  std::size_t take, frame;
};

std::vector<Picture> distinct(const Recording& recording, const std::vector<std::size_t>& frames) {
  std::vector<Picture> pictures;
  for (std::size_t take = 0; take < recording.takes.size(); ++take) {
    std::set<std::size_t> shown;
    for (const std::size_t frame : frames)
      shown.insert(std::min(frame, recording.takes[take].frames.size() - 1));
    for (const std::size_t frame : shown) pictures.push_back({take, frame});
  }
  return pictures;
}

std::string ppm(const Pixels& pixels) {
  return "P6\n" + std::to_string(pixels.width) + " " + std::to_string(pixels.height) + "\n255\n" +
         std::string(pixels.rgb.begin(), pixels.rgb.end());
}

// Calls work(0) to work(count - 1) on all cores. Rethrows what one of them threw.
void on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::future<void>> others;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
    others.push_back(std::async(std::launch::async, loop));
  loop();
  for (std::future<void>& other : others) other.get();
}

}  // namespace

std::vector<std::array<int, 3>> oriented(std::vector<std::array<int, 3>> triangles) {
  std::map<Side, std::vector<std::size_t>> beside;
  const auto from = [&](std::size_t t, std::size_t k) { return triangles[t][k % 3]; };
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      beside[std::minmax(from(i, k), from(i, k + 1))].push_back(i);
  std::vector<char> seen(triangles.size(), 0);
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    std::vector<std::size_t> reached;
    if (!seen[first]) reached.push_back(first);
    seen[first] = 1;
    for (std::size_t at = 0; at < reached.size(); ++at) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = from(reached[at], k), b = from(reached[at], k + 1);
        for (const std::size_t next : beside[std::minmax(a, b)]) {
          if (seen[next]) continue;
          seen[next] = 1;
          reached.push_back(next);
          for (std::size_t i = 0; i < 3; ++i) {
            if (from(next, i) != a || from(next, i + 1) != b) continue;
            std::swap(triangles[next][1], triangles[next][2]);  // it passed in the same direction
            break;
          }
        }
      }
    }
  }
  return triangles;
}

Shot shot_of(const Recording& recording, const View& view, std::size_t take, std::size_t frame,
             int width) {
  const FilmScene& stage = recording.stage;
  const FilmRun& shown = recording.takes.at(take);
  Shot shot;
  shot.cloth = shown.frames.at(frame);
  shot.triangles = stage.triangles;
  shot.colours = colours_of(stage, shot.cloth, shown.strain_limit);
  if (!stage.body.empty()) shot.body = body_at(stage, frame);
  shot.body_triangles = stage.body_triangles;
  const double edge = mean_edge(stage), distance = (view.eye - view.centre).norm();
  const double pixel = 2 * view.tangent * distance / width;  // m
  shot.thickness = std::clamp(0.25 * edge, 0.004 * view.size, 0.03 * view.size);
  if (stage.triangles.empty()) {
    shot.edges = stage.edges;
    shot.yarn = std::max(1.2 * pixel, std::min(0.009 * view.size, 0.25 * edge));
    return shot;
  }
  shot.yarns = yarns_of(stage);
  shot.yarn = std::clamp(0.05 * edge, 0.4 * pixel, 0.9 * pixel);
  shot.yarn_shade = 0.5 * std::min(1.0, edge / (line_spacing * pixel));
  return shot;
}

void write_pictures(const std::string& folder, const Recording& recording, const PictureSpec& spec,
                    const std::function<bool()>& interrupted,
                    const std::function<void(std::size_t, std::size_t)>& told) {
  const View view = view_of(recording, spec.frames);
  const std::vector<Picture> pictures = distinct(recording, spec.frames);
  std::mutex lock;
  std::size_t done = 0;
  on_all_cores(pictures.size(), [&](std::size_t i) {
    if (interrupted()) throw Interrupted();
    const auto [take, frame] = pictures[i];
    const Shot shot = shot_of(recording, view, take, frame, spec.width);
    const std::string name = std::to_string(take) + "-" + std::to_string(frame) + ".ppm";
    write_atomically(folder + "/" + name, ppm(trace(shot, view, spec.width, spec.samples)));
    const std::lock_guard held(lock);
    told(++done, pictures.size());
  });
  nlohmann::json legend = nlohmann::json::array();
  for (int i = 0; i <= 16 * legend_end; ++i) legend.push_back(shade(strain_colour(i / 16.0)));
  const nlohmann::json header{{"width", spec.width},
                              {"height", view.height(spec.width)},
                              {"frames", spec.frames},
                              {"legend", legend},
                              {"legend_end", legend_end}};
  write_atomically(folder + "/pictures.json", compact(header) + "\n");
}

}  // namespace harness
