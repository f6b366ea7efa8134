// What engines share: a class around an engine becomes a method of the C interface.
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <exception>
#include <string>

#include "inextensible.h"

namespace engines {

inline Eigen::Map<Eigen::Matrix3Xd> columns(double* vectors, Eigen::Index count) {
  return {vectors, 3, count};
}
inline Eigen::Map<const Eigen::Matrix3Xd> columns(const double* vectors, Eigen::Index count) {
  return {vectors, 3, count};
}

// Base of engines; each has a constructor from scene and settings, which throws std::exception for
// a scene that it does not take, and
//   int put_in(InextensibleStep&)    the state at the start of the step
//   int step(InextensibleStep&)
//   void take_out(InextensibleStep&)  the state at its end
struct Engine {
  void accept() {}  // after a step that was not refused
  void build() {}   // anew, after an exception, when the engine's state cannot be trusted
};

template <class E>
void* create(const InextensibleScene* scene, const double* settings, const char** reason) {
  static std::string why;
  try {
    return new E(*scene, settings);
  } catch (const std::exception& error) {
    why = error.what();
    *reason = why.c_str();
    return nullptr;
  }
}

template <class E>
int take_step(void* object, InextensibleStep* step) {
  E& engine = *static_cast<E*>(object);
  using Clock = std::chrono::steady_clock;
  auto seconds = [last = Clock::now()]() mutable {
    const auto before = last;
    last = Clock::now();
    return std::chrono::duration<double>(last - before).count();
  };
  try {
    if (const int refused = engine.put_in(*step)) return refused;
    step->copy_seconds += seconds();
    if (const int refused = engine.step(*step)) return refused;
    seconds();
    engine.take_out(*step);
    step->copy_seconds += seconds();
  } catch (const std::exception&) {
    engine.build();
    step->reason = "the engine gave up";
    return INEXTENSIBLE_NOT_CONVERGED;
  }
  const Eigen::Index n = engine.vertices;
  if (!std::isfinite(columns(step->x, n).sum() + columns(step->v, n).sum())) {
    step->reason = "a number overflowed";
    return INEXTENSIBLE_NOT_FINITE;
  }
  engine.accept();
  return INEXTENSIBLE_OK;
}

template <class E>
void destroy(void* object) {
  delete static_cast<E*>(object);
}

// The plug-in of one engine. The version names the engine; `kind` and `label` are what follows it
// in the summary and in figures.
template <class E, int count>
const InextensiblePlugin* plugin_of(const char* name, const std::string& engine,
                                    const std::string& kind, const std::string& label,
                                    const char* citation, int flags, int direction,
                                    const InextensibleSetting (&settings)[count]) {
  static const std::string version = engine, summary = engine + ", " + kind,
                           short_name = engine + " " + label;
  static const InextensibleMethod method = {
      name,
      summary.c_str(),
      short_name.c_str(),
      citation,
      INEXTENSIBLE_STEP,
      flags | INEXTENSIBLE_NO_LIMIT | INEXTENSIBLE_MOMENTUM | INEXTENSIBLE_ENGINE,
      direction,
      count,
      settings,
      create<E>,
      take_step<E>,
      destroy<E>};
  static const InextensiblePlugin plugin = {INEXTENSIBLE_BUILD, version.c_str(), 1, &method};
  return &plugin;
}

}  // namespace engines
