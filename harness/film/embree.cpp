#include "harness/film/embree.h"

namespace harness {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

template <class Value>
Value* buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  return static_cast<Value*>(
      rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Value), count));
}

}  // namespace

Owned<RTCGeometry> triangle_geometry(RTCDevice device, const inextensible::Positions& x,
                                     const std::vector<std::array<int, 3>>& triangles) {
  Owned<RTCGeometry> made(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* points = buffer<std::array<float, 3>>(made.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                              static_cast<std::size_t>(x.cols()));
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    for (int k = 0; k < 3; ++k)
      points[i][static_cast<std::size_t>(k)] = static_cast<float>(x(k, i));
  auto* corners = buffer<std::array<unsigned, 3>>(made.get(), RTC_BUFFER_TYPE_INDEX,
                                                  RTC_FORMAT_UINT3, triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) corners[i][k] = static_cast<unsigned>(triangles[i][k]);
  rtcCommitGeometry(made.get());
  return made;
}

Owned<RTCGeometry> rope_geometry(RTCDevice device, const Shot& shot) {
  Owned<RTCGeometry> made(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE));
  auto* points = buffer<std::array<float, 4>>(made.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                              2 * shot.edges.size());
  auto* first =
      buffer<unsigned>(made.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, shot.edges.size());
  for (std::size_t k = 0; k < shot.edges.size(); ++k) {
    for (std::size_t end = 0; end < 2; ++end) {
      const Vector3f p = shot.cloth.col(shot.edges[k][end]).cast<float>();
      points[2 * k + end] = {p.x(), p.y(), p.z(), static_cast<float>(shot.yarn)};
    }
    first[k] = static_cast<unsigned>(2 * k);
  }
  rtcCommitGeometry(made.get());
  return made;
}

Owned<RTCGeometry> knot_geometry(RTCDevice device, const Shot& shot) {
  Owned<RTCGeometry> made(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT));
  auto* points = buffer<std::array<float, 4>>(made.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                              static_cast<std::size_t>(shot.cloth.cols()));
  for (Eigen::Index i = 0; i < shot.cloth.cols(); ++i) {
    const Vector3f p = shot.cloth.col(i).cast<float>();
    points[i] = {p.x(), p.y(), p.z(), static_cast<float>(1.8 * shot.yarn)};
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

}  // namespace harness
