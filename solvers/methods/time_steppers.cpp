#include <string_view>

#include "solvers/methods/backend.h"
#include "solvers/stepping/bdf2.h"
#include "solvers/stepping/midpoint_stepper.h"

namespace inextensible {
namespace {

using Made = std::unique_ptr<Stepper>;
using Shared = std::shared_ptr<const Problem>;

Made backward_euler(Shared problem, const Backend& method, const BackendOptions& options) {
  if (method.make) return method.make(std::move(problem), options);
  auto filter = method.make_filter(*problem, options, Along::edges);
  return std::make_unique<FilterStepper>(std::move(problem), std::move(filter));
}

Made bdf2(Shared problem, const Backend& method, const BackendOptions& options) {
  if (method.make) {
    auto one_step = method.make(problem, options);
    return std::make_unique<Bdf2OfEuler>(std::move(problem), std::move(one_step));
  }
  auto filter = method.make_filter(*problem, options, Along::edges);
  return std::make_unique<Bdf2Stepper>(std::move(problem), std::move(filter));
}

constexpr const char* spectral_radius = "spectral_radius";

Made midpoint(Shared problem, const Backend& method, const BackendOptions& options) {
  auto filter = method.make_filter(*problem, options, Along::middle);
  return std::make_unique<MidpointStepper>(std::move(problem), std::move(filter),
                                           options.number(spectral_radius));
}

}  // namespace

std::span<const TimeStepper> time_steppers() {
  static const std::vector<TimeStepper> all{
      {"backward_euler", backward_euler},
      // Symplectic where forces act along the start of the step. With velocities of half steps it
      // is the arithmetic of backward_euler.
      {"verlet", backward_euler, Origin::paper, "Verlet 1967"},
      {"bdf2", bdf2, Origin::literature, "Choi and Ko 2002; English and Bridson 2008", "in BDF2",
       Velocities::whole_step},
      {"midpoint",
       midpoint,
       Origin::literature,
       "Simo and Tarnow 1992; Gonzalez 1999",
       "in the midpoint rule",
       Velocities::whole_step,
       Along::middle,
       {{spectral_radius, 0.8,
         "what an edge keeps of its rate when it bounces off its limit; 1 conserves", Range{0, 1},
         SearchRange{0, 1}}}}};
  return all;
}

const char* mismatch(const Backend& method, const TimeStepper& stepper) {
  if (std::string_view(method.stepper) == stepper.name) return nullptr;
  if (!method.make_filter) {
    return method.backward_euler && stepper.around == bdf2 ? nullptr
                                                           : "the method is a time step of its own";
  }
  if (std::string_view(stepper.name) == "verlet")
    return "its forces act along the edges at the start of a step, the method's do not";
  if (method.direction == Direction::start)
    return "forces along the edges at the start of a step are of second order in its own stepper "
           "and of first order elsewhere";
  if (stepper.along == Along::middle && method.direction == Direction::end)
    return "the method's forces act along the edges at the end of a step, by definition; the "
           "stepper wants those of its middle";
  if (stepper.along == Along::middle && !method.takes_middle)
    return "the method corrects edges along themselves; the stepper wants their middles";
  return nullptr;
}

}  // namespace inextensible
