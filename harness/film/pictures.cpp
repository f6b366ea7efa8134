#include <Eigen/Geometry>
#include <future>
#include <mutex>
#include <numbers>
#include <numeric>
#include <set>
#include <thread>

#include "harness/base/child_process.h"
#include "harness/base/files.h"
#include "harness/film/film.h"
#include "harness/judge/mechanics.h"

namespace harness {

using Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;
using Triangles = std::vector<std::array<int, 3>>;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FilmRun, label, strain_limit, step, detail, energy_gained,
                                   largest_strain, seconds)

namespace {

const std::string povray = "povray";

constexpr int legend_end = 4;       // strain over its limit
constexpr double line_spacing = 7;  // pixels between yarns, below which their lines are fainter

// Cloth's own colour up to the limit, warm beyond it; sRGB. `over_limit`: strain over its limit.
Vector3d strain_colour(double over_limit) {
  // Four times the limit is as red as it gets.
  static const std::vector<std::pair<double, Vector3d>> stops{
      {0, {0.80, 0.78, 0.72}},   {0.5, {0.58, 0.70, 0.80}}, {1, {0.25, 0.50, 0.75}},
      {1.5, {0.95, 0.70, 0.25}}, {4, {0.80, 0.12, 0.10}},
  };
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const auto& [low, from] = stops[i - 1];
    const auto& [high, to] = stops[i];
    if (over_limit < high)
      return from + std::max(0.0, over_limit - low) / (high - low) * (to - from);
  }
  return stops.back().second;
}

// Sag of each mark at each frame below where it would hang if nothing stretched, m.
json sags(const Scene& scene, const FilmRun& take) {
  json all = json::object();
  for (const Scene::Mark& mark : scene.marks) {
    json& sag = all[mark.name] = json::array();
    for (const auto& frame : take.frames) sag.push_back(mark.height - frame(1, mark.vertex));
  }
  return all;
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

constexpr double half_angle = 12 * std::numbers::pi / 180;
constexpr double margin = 1.06;
// Distance up to which cloth stays in view, over the radius of the start: with a body, and without.
constexpr double near_body = 1.1, near_start = 3;

std::vector<Vector3d> in_sight(const Recording& recording, const std::vector<std::size_t>& frames) {
  const Positions& start = recording.takes.at(0).frames.at(0);
  const Box cloth(start.rowwise().minCoeff(), start.rowwise().maxCoeff());
  std::vector<Eigen::Index> near;  // corners of the body; not those of a floor
  const Positions whole_body = body_at(recording, 0);
  for (Eigen::Index i = 0; i < whole_body.cols(); ++i)
    if ((whole_body.col(i) - cloth.center()).norm() < 4 * cloth.diagonal().norm())
      near.push_back(i);
  const bool body = !near.empty();
  const Positions body_start = body ? Positions(whole_body(Eigen::all, near)) : start;
  const Vector3d at_first =
      Box(body_start.rowwise().minCoeff(), body_start.rowwise().maxCoeff()).center();
  double reach = 0;
  for (const Positions* x : {&start, &body_start})
    reach = std::max(reach, (x->colwise() - at_first).colwise().norm().maxCoeff());
  const double followed = (body ? near_body : near_start) * reach;
  std::vector<Vector3d> all;
  for (const FilmRun& take : recording.takes)
    for (const std::size_t shown : frames) {
      const std::size_t frame = std::min(shown, take.frames.size() - 1);
      Vector3d middle = at_first;
      if (!recording.body_poses.empty())
        middle = recording.body_poses.at(frame)(recording.body_poses[0].inverse()(middle));
      for (const auto& point : take.frames[frame].colwise())
        if ((point - middle).norm() <= followed) all.emplace_back(point);
      const Positions around = body_at(recording, frame);
      for (const Eigen::Index i : near) all.emplace_back(around.col(i));
    }
  return all;
}

struct View {
  Vector3d centre, eye;         // m
  Vector3d right, up, towards;  // unit vectors; towards: from the centre to the eye
  double size = 1;              // half of what a picture shows, m
  double aspect = 1;            // a picture's height over its width
  double tangent = 1;           // of half the angle that a picture's width covers
};

// Sees the body and the cloth of all runs at these frames, or at the last one of a run that has
// ended. Cloth that falls far leaves the picture instead of making it small.
View view_of(const Recording& recording, const std::vector<std::size_t>& frames) {
  const std::vector<Vector3d> all = in_sight(recording, frames);
  Box whole;
  for (const Vector3d& point : all) whole.extend(point);
  const bool in_a_plane = whole.sizes().z() < 1e-3 * whole.sizes().maxCoeff();
  View view;
  view.tangent = std::tan(half_angle);
  view.towards = (in_a_plane ? Vector3d(0, 0.12, 1) : Vector3d(0.55, 0.45, 1)).normalized();
  view.right = Vector3d::UnitY().cross(view.towards).normalized();
  view.up = view.towards.cross(view.right);
  Eigen::Matrix3d axes;
  axes << view.right.transpose(), view.up.transpose(), view.towards.transpose();
  Box box;
  for (const Vector3d& point : all) box.extend(axes * point);
  const Vector3d middle = box.center(), half = (0.5 * box.sizes()).cwiseMax(1e-6);
  view.aspect = std::clamp(half.y() / half.x(), 0.5, 1.3);
  double distance = 0;
  for (const Vector3d& point : all) {
    const Vector3d p = axes * point - middle;
    const double wide = std::max(std::abs(p.x()), std::abs(p.y()) / view.aspect);
    distance = std::max(distance, margin * wide / view.tangent + p.z());
  }
  view.size = std::max(half.x(), half.y());
  view.centre = axes.transpose() * middle;
  view.eye = view.centre + std::max(distance, 1e-6) * view.towards;
  return view;
}
// ---- Scenes of POV-Ray ----

// The columns of a matrix as POV-Ray's vectors, between commas.
template <class Columns>
auto vectors(const Columns& columns) {
  static const Eigen::IOFormat form(7, Eigen::DontAlignCols, ",", ",", "<", ">");
  return columns.transpose().format(form);
}

std::string texture(const std::string& pigment) { return " texture{" + pigment + " finish{F}}}\n"; }

std::string plain(const Vector3d& srgb) {
  return texture(concat("pigment{srgb", vectors(srgb), "}"));
}

// Vertex normals, weighted by the areas of the adjacent triangles.
Eigen::Matrix3Xd normals_of(const Positions& x, const Triangles& triangles) {
  Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, x.cols());
  for (const auto& t : triangles) {
    const Vector3d face = (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0]));
    for (const int corner : t) sums.col(corner) += face;
  }
  for (auto sum : sums.colwise())
    sum = sum.norm() > 0 ? Vector3d(sum.normalized()) : Vector3d::UnitY();
  return sums;
}

// The mesh without its texture. tones: of each vertex, 0 to 1, the place in a gradient.
void write_mesh(std::ostream& out, const Positions& x, const Triangles& triangles,
                const Eigen::Matrix3Xd& normals, const std::vector<double>& tones) {
  Eigen::Matrix2Xd places = Eigen::Matrix2Xd::Zero(2, x.cols());
  std::copy(tones.begin(), tones.end(), places.row(0).begin());
  const Eigen::Map<const Eigen::Matrix3Xi> corners(triangles.data()->data(), 3,
                                                   static_cast<Eigen::Index>(triangles.size()));
  const Eigen::Index count = x.cols();
  out << "mesh2{vertex_vectors{" << count << ',' << vectors(x) << "}\nnormal_vectors{" << count
      << ',' << vectors(normals) << "}\nuv_vectors{" << count << ',' << vectors(places)
      << "}\nface_indices{" << corners.cols() << ',' << vectors(corners) << "}\n";
}

// One large light, a weak one from above, and a weaker one at the camera.
void write_camera_and_lights(std::ostream& out, const View& view, const Vector3d& eye, double far) {
  constexpr double size = 0.44;  // of the large light, over its distance
  const Vector3d up = Vector3d::UnitY(),
                 key = (-0.5 * view.right + 1.1 * up + 0.75 * view.towards).normalized(),
                 across = key.cross(view.towards).normalized(), along = key.cross(across);
  out << "#version 3.7;global_settings{assumed_gamma 1}background{srgb<0.97,0.97,0.98>}\n"
      << "#declare F=finish{ambient 0.16 diffuse 1 specular 0.04 roughness 0.02}\n"
      << "camera{location" << vectors(eye) << "direction" << vectors(-view.towards) << "right"
      << vectors(2 * view.tangent * view.right) << "up"
      << vectors(2 * view.tangent * view.aspect * view.up) << "}\nlight_source{"
      << vectors(far * key) << "rgb 0.72 area_light" << vectors(far * size * across) << ','
      << vectors(far * size * along) << ",3,3 adaptive 0 jitter}\nlight_source{"
      << vectors(far * up) << "rgb 0.3 shadowless}\nlight_source{" << vectors(eye)
      << "rgb 0.12 shadowless}\n";
}

// Cloth is drawn as triangles and yarns, a chain as a rope with knots.
std::string povray_scene(const Recording& recording, const View& view, const FilmRun& run,
                         std::size_t frame, int width) {
  const Scene& scene = recording.scene;
  // POV-Ray's tolerances are absolute, about 0.001: half of the picture is ten units long.
  constexpr double half = 10, far = 100 * half;
  const double scale = half / view.size;
  const auto scaled = [&](const Positions& x) {
    return Positions(scale * (x.colwise() - view.centre));
  };
  const Positions x = scaled(run.frames.at(frame));
  const Vector3d eye = scale * (view.eye - view.centre);
  const std::vector<double>& lengths = scene.problem->rest_length();
  const double edge = scale * std::accumulate(lengths.begin(), lengths.end(), 0.0) /
                      std::max(1.0, static_cast<double>(lengths.size()));  // the mean
  const double pixel = 2 * view.tangent * eye.norm() / width;
  const bool rope = scene.triangles.empty();
  const double radius = rope ? std::max(1.2 * pixel, std::min(0.009 * half, 0.25 * edge))
                             : std::clamp(0.05 * edge, 0.4 * pixel, 0.9 * pixel);
  // A line hides this much of what is behind it: the closer lines are, the fainter they are.
  const double shade = 0.35 * std::min(1.0, edge / (line_spacing * pixel));

  std::ostringstream out;
  write_camera_and_lights(out, view, eye, far);
  out << "#declare Line=texture{pigment{rgb 0 transmit " << 1 - shade
      << "}finish{ambient 0 diffuse 0}}\n";
  std::vector<double> strains, most(static_cast<std::size_t>(x.cols()), 0);
  append_strains(*scene.problem, run.frames[frame], strains);
  for (std::size_t k = 0; k < strains.size(); ++k) {
    const auto [a, b] = scene.problem->edges()[k];
    for (const int end : {a, b}) most[end] = std::max(most[end], strains[k]);
    if ((x.col(a) - x.col(b)).norm() < 1e-6 * half) continue;  // POV-Ray refuses it
    out << "cylinder{" << vectors(x(Eigen::all, {a, b})) << ',' << radius
        << (rope ? plain(strain_colour(strains[k] / run.strain_limit))
                 : " texture{Line}no_shadow}\n");
  }
  for (Eigen::Index v = 0; rope && v < x.cols(); ++v)
    out << "sphere{" << vectors(x.col(v)) << ',' << 1.8 * radius
        << plain(strain_colour(most[v] / run.strain_limit));
  if (!rope) {
    // A gradient repeats itself from 1 on.
    for (double& tone : most) tone = std::min(tone / run.strain_limit / legend_end, 0.9999);
    write_mesh(out, x, scene.triangles, normals_of(x, scene.triangles), most);
    std::string stops;
    for (int i = 0; i <= 16 * legend_end; ++i)
      stops += concat("[", i / (16.0 * legend_end), " srgb", vectors(strain_colour(i / 16.0)), "]");
    out << texture("uv_mapping pigment{gradient x color_map{" + stops + "}}");
  }
  if (!recording.body.vertices.empty()) {
    // A little smaller than it is, so that cloth is seen where it cuts a corner of the body.
    const Positions body = scaled(body_at(recording, frame));
    const Eigen::Matrix3Xd normals = normals_of(body, recording.body.triangles);
    const double thickness = std::clamp(0.25 * edge, 0.004 * half, 0.03 * half);
    write_mesh(out, body - thickness * normals, recording.body.triangles, normals, {});
    out << plain({0.78, 0.74, 0.72});
  }
  return out.str();
}

std::string traced(const std::string& scene, int width, int height, bool still) {
  // Input from a file and output to none: POV-Ray may be forbidden to read or write others.
  const ProgramResult ran =
      run_program({povray, "+I/dev/stdin", "+O-", "+FN", concat("+W", width), concat("+H", height),
                   "+WT1", "+AM1", still ? "+A0.15" : "+A0.3", "+R3", "-J", "-D", "-V", "-GA"},
                  std::numeric_limits<double>::infinity(), scene);
  if (ran.exit_code != 0)
    throw FileError("the scene", "trace", povray + (": " + ran.last_error_line()));
  return ran.out;
}

}  // namespace

void check_povray() {
  if (run_program({povray, "--version"}, std::numeric_limits<double>::infinity()).exit_code != 0)
    throw UsageError("pictures need POV-Ray (Debian: apt-get install povray); .obj does not");
}

void write_pictures(const std::string& folder, const Recording& recording, const PictureSpec& spec,
                    const std::function<void(std::size_t, std::size_t)>& told) {
  const View view = view_of(recording, spec.frames);
  const int height = std::max(1, static_cast<int>(std::lround(spec.width * view.aspect)));
  std::set<std::pair<std::size_t, std::size_t>> distinct;  // take and frame
  for (std::size_t take = 0; take < recording.takes.size(); ++take)
    for (const std::size_t frame : spec.frames)
      distinct.emplace(take, std::min(frame, recording.takes[take].frames.size() - 1));
  const std::vector pictures(distinct.begin(), distinct.end());
  std::mutex lock;
  std::size_t done = 0;
  on_all_cores(pictures.size(), [&](std::size_t i) {
    if (interrupted()) throw Interrupted();
    const auto [take, frame] = pictures[i];
    const std::string scene =
        povray_scene(recording, view, recording.takes[take], frame, spec.width);
    write_atomically(concat(folder, "/", take, "-", frame, ".png"),
                     traced(scene, spec.width, height, spec.still));
    const std::lock_guard held(lock);
    told(++done, pictures.size());
  });
  json legend = json::array(), takes = json::array();
  for (int i = 0; i <= 16 * legend_end; ++i) {
    const Vector3d rgb = 255 * strain_colour(i / 16.0);
    legend.push_back(
        json::array({std::lround(rgb.x()), std::lround(rgb.y()), std::lround(rgb.z())}));
  }
  for (const FilmRun& take : recording.takes) {
    json& made = takes.emplace_back(take);
    made["frames"] = take.frames.size();
    made["sag"] = sags(recording.scene, take);
  }
  const json header{
      {"width", spec.width},     {"height", height},
      {"frames", spec.frames},   {"frames_per_second", recording.spec.frames_per_second},
      {"takes", takes},          {"legend", legend},
      {"legend_end", legend_end}};
  write_atomically(folder + "/film.json", compact(header) + "\n");
}

}  // namespace harness
