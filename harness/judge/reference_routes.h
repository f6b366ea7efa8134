// References by computation: two unlike routes for each scene.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "harness/judge/reference.h"
#include "harness/judge/reference_pieces.h"
#include "harness/judge/route_runs.h"

namespace harness {

// Route of a scene that is no pendulum, in steps of h seconds.
std::pair<Route, Route> contact_routes(const Scene& scene, double h);

// Computes the reference of a scene by both routes. finest: the smallest step of step halving, s; 0
// chooses by the scene. tell is called with a line now and then. keep: where runs are kept so that
// the computation can be made in pieces; null: in memory. Throws UsageError if a route fails too
// early.
Reference compute_reference(const std::string& scene, const SceneParameters& complete,
                            double finest, const std::function<void(const std::string&)>& tell,
                            const KeepRun& keep = nullptr);

// In its place for a scene of one's own: one route alone, in steps of 1/400 s, whose gap is how far
// it is from itself at 1/200 s and from a start moved a little. Throws UsageError if it fails too
// early, and what `tell` throws.
Reference finer_run(const std::string& scene, const SceneParameters& complete,
                    const std::function<void(const std::string&)>& tell);

}  // namespace harness
