// A plug-in whose copies are of different kinds, which their files' names tell. plugin_test.sh and
// interrupts_test.sh load them.
//   Misfits, that bench must refuse: another_version, taken_name, throws, and another_alignment,
//   which has flags of its own; broken, which it must find to do nothing; hangs, which never ends a
//   step. Fast projection once more:
//     plain  as it is
//     slow   every projection made four times: what bench ab must see
//     loud   prints to standard output, by C and by C++, as it is loaded, used and unloaded
//     bare   takes neither shear nor a collider
#include <dlfcn.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string_view>

#include "solvers/plugin.h"

namespace {

using namespace inextensible;

bool is(std::string_view kind) {
  Dl_info info;
  return dladdr(reinterpret_cast<const void*>(&is), &info) != 0 &&
         std::string_view(info.dli_fname).ends_with("_" + std::string(kind) + ".so");
}

void print_if_loud() {
  if (!is("loud")) return;
  std::cout << "{}\n";
  std::puts("a line of the solver's own");
}

struct AtBothEnds {
  AtBothEnds() { print_if_loud(); }
  ~AtBothEnds() { print_if_loud(); }
} const at_both_ends;

struct Nothing final : VelocityFilter {
  Nothing(const Problem&, const BackendOptions&) {}
  StepResult apply(const Positions&, double, Iterate, WorkCounters&) override {
    while (is("hangs")) pause();
    return {};
  }
};

class Repeated final : public VelocityFilter {
 public:
  Repeated(const Problem& problem, const BackendOptions& options)
      : inner_(make_velocity_filter("fast_projection", problem, {options.strain_limit})) {}

  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override {
    print_if_loud();
    for (int i = 0; i < in_vain_; ++i) {
      copy_ = x;
      inner_->apply(x_start, h, copy_, not_counted_);
    }
    return inner_->apply(x_start, h, x, work);
  }

 private:
  std::unique_ptr<VelocityFilter> inner_;
  int in_vain_ = is("slow") ? 3 : 0;
  Positions copy_;
  WorkCounters not_counted_;
};

template <class Filter>
std::unique_ptr<Stepper> make(std::shared_ptr<const Problem> problem,
                              const BackendOptions& options) {
  auto filter = std::make_unique<Filter>(*problem, options);
  return std::make_unique<FilterStepper>(std::move(problem), std::move(filter));
}

Backend row() {
  const auto limit = StrainControl::strain_limit;
  for (const char* kind : {"plain", "slow", "loud", "bare"}) {
    if (!is(kind)) continue;
    Backend sound{"sound", "fast projection once more", limit, true, {}, make<Repeated>};
    if (is("bare")) sound.takes_shear = sound.takes_collider = false;
    return sound;
  }
  return {is("taken_name") ? "shake" : "misfit", "does nothing", limit, true, {}, make<Nothing>};
}

}  // namespace

extern "C" const InextensiblePlugin* inextensible_plugin() {
  static const std::vector<Backend> rows{row()};
  static InextensiblePlugin plugin = inextensible_plugin_of("1.0", rows);
  if (is("another_version")) plugin.abi = 999;
  if (is("throws")) throw std::runtime_error("no licence\nfor today");
  return &plugin;
}
