// Embree's objects: they free themselves, and take our meshes.
#pragma once

#include <embree3/rtcore.h>

#include <initializer_list>
#include <memory>
#include <type_traits>

#include "harness/film/tracer.h"

namespace harness {

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

Owned<RTCGeometry> triangle_geometry(RTCDevice device, const inextensible::Positions& x,
                                     const std::vector<std::array<int, 3>>& triangles);
// A cylinder with round ends for each edge of a rope, and a ball for each vertex.
Owned<RTCGeometry> rope_geometry(RTCDevice device, const Shot& shot);
Owned<RTCGeometry> knot_geometry(RTCDevice device, const Shot& shot);

Owned<RTCScene> scene_of(RTCDevice device, std::initializer_list<RTCGeometry> parts);

}  // namespace harness
