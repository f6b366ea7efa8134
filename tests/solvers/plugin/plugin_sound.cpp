// Fast projection as plug-ins, by KIND_...; plugin_test.sh loads them.
//   plain  as it is
//   slow   every projection made four times: what bench ab must see
//   loud   prints to standard output, by C and by C++, as it is loaded, used and unloaded
//   start  with a set-up that needs the start's positions, and fails without
//   bare   takes neither shear nor a collider
#include <cstdio>
#include <iostream>
#include <stdexcept>

#include "solvers/plugin.h"

namespace {

using namespace inextensible;

#if defined(KIND_slow)
constexpr int in_vain = 3;
#else
constexpr int in_vain = 0;
#endif

#if defined(KIND_loud)
void print() {
  std::cout << "{}\n";
  std::puts("a line of the solver's own");
}
struct AtBothEnds {
  AtBothEnds() { print(); }
  ~AtBothEnds() { print(); }
} const at_both_ends;
#else
void print() {}
#endif

class Repeated final : public VelocityFilter {
 public:
  Repeated(const Problem& problem, double strain_limit)
      : inner_(make_velocity_filter("fast_projection", problem, {strain_limit})) {}

  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override {
    print();
    for (int i = 0; i < in_vain; ++i) {
      copy_ = x;
      inner_->apply(x_start, h, copy_, not_counted_);
    }
    return inner_->apply(x_start, h, x, work);
  }

 private:
  std::unique_ptr<VelocityFilter> inner_;
  Positions copy_;
  WorkCounters not_counted_;
};

std::unique_ptr<Stepper> make(std::shared_ptr<const Problem> problem,
                              const BackendOptions& options) {
#if defined(KIND_start)
  if (!options.start) throw std::runtime_error("no start");
  const State& start = *options.start;
  if (start.x.cols() != problem->vertices() || start.v.cols() != problem->vertices())
    throw std::runtime_error("a start of another size");
  for (const Edge& edge : problem->edges()) {
    if (start.x.col(edge.a) == start.x.col(edge.b))
      throw std::runtime_error("a start without positions");
  }
#endif
  auto filter = std::make_unique<Repeated>(*problem, options.strain_limit);
  return std::make_unique<FilterStepper>(std::move(problem), std::move(filter));
}

Backend row() {
  Backend backend{"sound", "fast projection once more", StrainControl::strain_limit, true, {},
                  make};
#if defined(KIND_bare)
  backend.takes_shear = backend.takes_collider = false;
#endif
  return backend;
}

}  // namespace

extern "C" const InextensiblePlugin* inextensible_plugin() {
  static const std::vector<Backend> rows{row()};
  static InextensiblePlugin plugin = inextensible_plugin_of("1.0", rows);
  return &plugin;
}
