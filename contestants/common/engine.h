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

// Thrown out of a step that is refused. After any other exception bench makes a new engine.
struct Refusal {
  InextensibleResult result;
  const char* reason;  // a literal
};

// E has a constructor from scene and settings, which throws std::exception for a scene that it does
// not take, and put_in (the state at the start of the step), step, and take_out (that at its end).
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
int take_step(void* object, InextensibleStep* step) try {
  E& engine = *static_cast<E*>(object);
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  engine.put_in(*step);
  const auto is_in = Clock::now();
  engine.step(*step);
  const auto stepped = Clock::now();
  engine.take_out(*step);
  const std::chrono::duration<double> copying = is_in - begin + (Clock::now() - stepped);
  step->copy_seconds = copying.count();
  return INEXTENSIBLE_OK;
} catch (const Refusal& refusal) {
  step->reason = refusal.reason;
  return refusal.result;
}

template <class E>
void destroy(void* object) {
  delete static_cast<E*>(object);
}

// For engines with vertices and links, to which bench gives all other forces.
constexpr int takes_forces = INEXTENSIBLE_TAKES_SHEAR | INEXTENSIBLE_TAKES_BENDING |
                             INEXTENSIBLE_TAKES_DRAG | INEXTENSIBLE_WANTS_FORCES;

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
