#include <embree3/rtcore.h>

#include <initializer_list>
#include <numeric>
#include <type_traits>

#include "harness/film/film.h"

namespace harness {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

using Triangles = std::vector<std::array<int, 3>>;

constexpr float far_away = std::numeric_limits<float>::infinity();

const Vector3d background = linear(Vector3d(0.97, 0.97, 0.98));
const Vector3d body_colour = linear(Vector3d(0.78, 0.74, 0.72));

// Vertex normals, weighted by the areas of the adjacent triangles.
Matrix3Xd normals_of(const Positions& x, const Triangles& triangles) {
  Matrix3Xd sums = Matrix3Xd::Zero(3, x.cols());
  for (const auto& t : triangles) {
    const Vector3d face = (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0]));
    for (const int corner : t) sums.col(corner) += face;
  }
  for (auto sum : sums.colwise()) {
    const double length = sum.norm();
    sum = length > 0 ? Vector3d(sum / length) : Vector3d::UnitY();
  }
  return sums;
}

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;
using Ball = std::array<float, 4>;  // middle and radius

template <class Value>
Value* buffer(const Owned<RTCGeometry>& geometry, RTCBufferType type, RTCFormat format,
              std::size_t count) {
  return static_cast<Value*>(
      rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, sizeof(Value), count));
}

Owned<RTCGeometry> triangle_geometry(RTCDevice device, const Positions& x,
                                     const Triangles& triangles) {
  Owned<RTCGeometry> made(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* points = buffer<Vector3f>(made, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                  static_cast<std::size_t>(x.cols()));
  for (Eigen::Index i = 0; i < x.cols(); ++i) points[i] = x.col(i).cast<float>();
  auto* corners =
      buffer<std::array<int, 3>>(made, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles.size());
  std::copy(triangles.begin(), triangles.end(), corners);
  rtcCommitGeometry(made.get());
  return made;
}

// Spheres about vertices, or round-ended cylinders between consecutive pairs of them.
Owned<RTCGeometry> round_geometry(RTCDevice device, const Shot& shot, RTCGeometryType type,
                                  const std::vector<int>& vertices, double radius) {
  Owned<RTCGeometry> made(rtcNewGeometry(device, type));
  auto* balls = buffer<Ball>(made, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3f p = shot.cloth.col(vertices[i]).cast<float>();
    balls[i] = {p.x(), p.y(), p.z(), static_cast<float>(radius)};
  }
  if (type == RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE) {
    auto* first =
        buffer<unsigned>(made, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, vertices.size() / 2);
    for (unsigned k = 0; 2 * k < vertices.size(); ++k) first[k] = 2 * k;
  }
  rtcCommitGeometry(made.get());
  return made;
}

Owned<RTCScene> scene_of(RTCDevice device, std::initializer_list<RTCGeometry> parts) {
  Owned<RTCScene> made(rtcNewScene(device));
  rtcSetSceneFlags(made.get(), RTC_SCENE_FLAG_ROBUST);
  for (const RTCGeometry part : parts) rtcAttachGeometry(made.get(), part);
  rtcCommitScene(made.get());
  return made;
}

RTCRay ray(const Vector3d& from, const Vector3d& to, double begin = 0) {
  const Vector3f o = from.cast<float>(), d = to.cast<float>();
  return {o.x(),       o.y(), o.z(), static_cast<float>(begin), d.x(), d.y(), d.z(), 0, far_away,
          0xFFFFFFFFU, 0,     0};
}

// 1 if a ray meets nothing, else 0.
double open(RTCScene scene, const Vector3d& from, const Vector3d& to, double begin) {
  RTCRay query = ray(from, to, begin);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &query);
  return query.tfar > 0 ? 1 : 0;
}

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  unsigned geometry = 0, primitive = 0;
  std::array<double, 3> weight{};     // of a triangle's corners, or of an edge's ends
  Vector3d face = Vector3d::UnitY();  // normal of what was hit, not of length 1
};

struct Surface {
  Vector3d point, normal, colour;
  double shine = 0;
};

class Tracer {
 public:
  Tracer(const Shot& shot, const View& view, int samples)
      : shot_(shot), view_(view), count_(samples * samples), device_(rtcNewDevice("threads=1")) {
    if (!device_) throw std::runtime_error("Embree cannot start");
    normals_ = normals_of(shot.cloth, shot.recording.scene.triangles);
    body_normals_ = normals_of(shot.body, shot.recording.body.triangles);
    const auto body = triangle_geometry(device_.get(), shot.body, shot.recording.body.triangles);
    body_ = scene_of(device_.get(), {body.get()});
    if (shot.recording.scene.triangles.empty()) {
      std::vector<int> ends, vertices(static_cast<std::size_t>(shot.cloth.cols()));
      for (const auto& [a, b] : shot.recording.scene.problem->edges())
        ends.insert(ends.end(), {a, b});
      std::iota(vertices.begin(), vertices.end(), 0);
      const auto rope = round_geometry(device_.get(), shot, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE,
                                       ends, shot.yarn),
                 knots = round_geometry(device_.get(), shot, RTC_GEOMETRY_TYPE_SPHERE_POINT,
                                        vertices, 1.8 * shot.yarn);
      cloth_ = scene_of(device_.get(), {rope.get(), knots.get()});
      all_ = scene_of(device_.get(), {rope.get(), knots.get(), body.get()});
    } else {
      const auto cloth =
          triangle_geometry(device_.get(), shot.cloth, shot.recording.scene.triangles);
      cloth_ = scene_of(device_.get(), {cloth.get()});
      all_ = scene_of(device_.get(), {cloth.get(), body.get()});
    }
    light_ = (-0.5 * view.right + 1.1 * Vector3d::UnitY() + 0.75 * view.towards).normalized();
    const Vector3d across = light_.cross(view.towards).normalized(), along = light_.cross(across);
    constexpr double light_radius = 0.22;  // over its distance
    // Points of a disk and of a half-sphere, evenly spread: Fibonacci's lattice.
    constexpr double golden = 2.399963229728653;  // the golden angle, rad
    for (int i = 0; i < 2 * count_; ++i) {
      const double radius = std::sqrt((i + 0.5) / (2 * count_));
      const double x = radius * std::cos(golden * i), y = radius * std::sin(golden * i);
      to_light_.push_back((light_ + light_radius * (x * across + y * along)).normalized());
      to_sky_.emplace_back(x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y)));
    }
  }

  Vector3d colour(const Vector3d& direction, int sample) const {
    const Hit cloth = first(cloth_.get(), view_.eye, direction);
    const Hit body = first(body_.get(), view_.eye, direction);
    const double apart = std::max(1e-4 * view_.size, shot_.thickness);
    if (std::isinf(cloth.distance) && std::isinf(body.distance)) return background;
    if (cloth.distance < body.distance + shot_.thickness)
      return lit(shot_.recording.scene.triangles.empty() ? on_rope(cloth, direction)
                                                         : on_cloth(cloth, direction),
                 direction, sample, apart);
    Surface surface = on_triangle(body, direction, shot_.body,
                                  shot_.recording.body.triangles[body.primitive], body_normals_);
    surface.colour = body_colour;
    surface.shine = 0.06;
    return lit(surface, direction, sample, apart);
  }

 private:
  static Hit first(RTCScene scene, const Vector3d& from, const Vector3d& to) {
    RTCRayHit query{ray(from, to), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
    Hit hit;
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.distance = query.ray.tfar;
    hit.geometry = query.hit.geomID;
    hit.primitive = query.hit.primID;
    const double u = query.hit.u, v = query.hit.v;
    hit.weight = {1 - u - v, u, v};
    hit.face = {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z};
    return hit;
  }

  // The shading normal, towards the viewer, and a point on the smooth surface that the corners'
  // normals describe (Hanika, Hacking the shadow terminator, 2021), so that the flat triangles of a
  // coarse mesh cast no visible shadows on each other.
  Surface on_triangle(const Hit& hit, const Vector3d& direction, const Positions& x,
                      const std::array<int, 3>& corners, const Matrix3Xd& normals) const {
    const double facing = hit.face.dot(direction) > 0 ? -1 : 1;
    Surface surface;
    surface.point = surface.normal = surface.colour = Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      surface.point += hit.weight[k] * x.col(corners[k]);
      surface.normal += hit.weight[k] * facing * normals.col(corners[k]);
    }
    Vector3d raised = surface.point;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d normal = facing * normals.col(corners[k]);
      const double below = std::min(0.0, (surface.point - x.col(corners[k])).dot(normal));
      raised -= hit.weight[k] * below * normal;
    }
    surface.point = raised;
    surface.normal.normalize();
    return surface;
  }

  // Coverage of a point by a yarn's line, 0 to 1.
  double line(const Hit& hit) const {
    const auto& t = shot_.recording.scene.triangles[hit.primitive];
    const unsigned drawn = shot_.yarns[hit.primitive];
    if (drawn == 0) return 0;
    const double twice_area = hit.face.norm();
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(drawn >> k & 1U)) continue;
      const std::size_t next = (k + 1) % 3, opposite = (k + 2) % 3;
      const double side = (shot_.cloth.col(t[next]) - shot_.cloth.col(t[k])).norm();
      const double away = side > 0 ? hit.weight[opposite] * twice_area / side : 0;
      most = std::max(most, std::clamp(1.5 - away / shot_.yarn, 0.0, 1.0));
    }
    return most;
  }

  Surface on_cloth(const Hit& hit, const Vector3d& direction) const {
    const auto& corners = shot_.recording.scene.triangles[hit.primitive];
    Surface surface = on_triangle(hit, direction, shot_.cloth, corners, normals_);
    for (std::size_t k = 0; k < 3; ++k)
      surface.colour += hit.weight[k] * shot_.colours.col(corners[k]);
    surface.colour *= 1 - shot_.yarn_shade * line(hit);
    surface.shine = 0.03;
    return surface;
  }

  Surface on_rope(const Hit& hit, const Vector3d& direction) const {
    Surface surface;
    surface.point = view_.eye + hit.distance * direction;
    surface.normal = hit.face.normalized();
    if (hit.geometry == 0) {
      const auto [a, b] = shot_.recording.scene.problem->edges()[hit.primitive];
      surface.colour = hit.weight[0] * shot_.colours.col(a) + hit.weight[1] * shot_.colours.col(b);
    } else {
      surface.colour = shot_.colours.col(hit.primitive);
    }
    surface.shine = 0.05;
    return surface;
  }

  // One light, the sky, and a little from the camera.
  Vector3d lit(const Surface& surface, const Vector3d& direction, int sample, double begin) const {
    constexpr double key = 0.72, sky = 0.36, camera = 0.12;
    const Vector3d& n = surface.normal;
    const Vector3d across = n.unitOrthogonal(), along = n.cross(across);
    const Vector3d from = surface.point + 0.02 * begin * n;
    const double direct = std::max(0.0, n.dot(light_));
    double sun = 0, sky_seen = 0;
    for (int i = 0; i < 2; ++i) {
      const auto number = static_cast<std::size_t>(sample + count_ * i);
      const Vector3d& s = to_sky_[number];
      sun += 0.5 * direct * open(all_.get(), from, to_light_[number], begin);
      sky_seen += 0.5 * open(all_.get(), from, s.x() * across + s.y() * along + s.z() * n, begin);
    }
    const double above = 0.75 + 0.25 * n.y();  // the sky is brighter than the ground
    const Vector3d half = (light_ - direction).normalized();
    const double gleam = direct > 0 ? std::pow(std::max(0.0, n.dot(half)), 24) * sun : 0;
    const double light =
        key * sun + sky * above * sky_seen + camera * std::max(0.0, -n.dot(direction));
    return light * surface.colour + surface.shine * gleam * Vector3d::Ones();
  }

  const Shot& shot_;
  const View& view_;
  int count_;  // samples a pixel
  Owned<RTCDevice> device_;
  Owned<RTCScene> cloth_, body_, all_;
  Matrix3Xd normals_, body_normals_;
  Vector3d light_;                           // towards the middle of the light
  std::vector<Vector3d> to_light_, to_sky_;  // of all samples; to_sky_ about the normal, as z
};

}  // namespace

Vector3d linear(const Vector3d& srgb) {
  return srgb.unaryExpr(
      [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); });
}

std::array<std::uint8_t, 3> shade(const Vector3d& rgb) {
  const auto encoded = [](double light) {
    light = std::clamp(light, 0.0, 1.0);
    const double srgb =
        light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * srgb));
  };
  return {encoded(rgb.x()), encoded(rgb.y()), encoded(rgb.z())};
}

Pixels trace(const Shot& shot, const View& view, int width, int samples) {
  const Tracer tracer(shot, view, samples);
  Pixels pixels{width, view.height(width), {}};
  pixels.rgb.reserve(3 * static_cast<std::size_t>(pixels.width) *
                     static_cast<std::size_t>(pixels.height));
  for (int row = 0; row < pixels.height; ++row) {
    for (int column = 0; column < pixels.width; ++column) {
      Vector3d sum = Vector3d::Zero();
      for (int sample = 0; sample < samples * samples; ++sample) {
        const int place = sample % samples, line = sample / samples;
        const double right = (place + 0.5) / samples, down = (line + 0.5) / samples;
        const Vector3d direction =
            view.ray(2 * (column + right) / pixels.width - 1, 1 - 2 * (row + down) / pixels.height);
        sum += tracer.colour(direction, sample);
      }
      const auto pixel = shade(sum / (samples * samples));
      pixels.rgb.insert(pixels.rgb.end(), pixel.begin(), pixel.end());
    }
  }
  return pixels;
}

}  // namespace harness
