// A plug-in whose copies are of different kinds, which their files' names tell. plugin_test.sh and
// interrupts_test.sh load them.
//   Misfits, that bench must refuse: another_version, taken_name, throws, crashes and exits.
//   Ones that must fail in their own runs only: broken does nothing, hangs never ends a step,
//   throws_later throws in every step.
//   Gauss-Seidel in the order of the mesh:
//     plain  as it is
//     slow   every pass made four times, three of them in vain: what bench ab must see
//     loud   prints to standard output, by C and by C++, as it is loaded, used and unloaded
//     bare   takes no collider
#include <dlfcn.h>
#include <unistd.h>

#include <cfenv>
#include <clocale>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "inextensible.h"

namespace {

bool is(const char* kind) {
  Dl_info info;
  return dladdr(reinterpret_cast<const void*>(&is), &info) != 0 &&
         std::string_view(info.dli_fname).ends_with(std::string("_").append(kind).append(".so"));
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

struct Passes {
  InextensibleScene scene;
  bool slow = is("slow");
  std::vector<double> copy;
};

void* create(const InextensibleScene* scene, const double*, const char**) {
  return new Passes{.scene = *scene, .copy = {}};
}

// Corrects each edge that is out of bounds; whether there was one.
bool pass(const InextensibleScene& scene, double* x) {
  bool corrected = false;
  for (int k = 0; k < scene.edges; ++k) {
    const int a = scene.edge[2 * k], b = scene.edge[2 * k + 1];
    const double wa = scene.mass[a] > 0 ? 1 / scene.mass[a] : 0;
    const double wb = scene.mass[b] > 0 ? 1 / scene.mass[b] : 0;
    double d[3], squared = 0;
    for (int c = 0; c < 3; ++c) {
      d[c] = x[3 * b + c] - x[3 * a + c];
      squared += d[c] * d[c];
    }
    const double strain = std::sqrt(squared) / scene.rest_length[k] - 1;
    if (std::abs(strain) <= scene.strain_limit) continue;
    corrected = true;
    const double share = strain / (1 + strain) / (wa + wb);
    for (int c = 0; c < 3; ++c) {
      x[3 * a + c] += wa * share * d[c];
      x[3 * b + c] -= wb * share * d[c];
    }
  }
  return corrected;
}

int filter(void* object, InextensibleStep* step) {
  auto& [scene, slow, copy] = *static_cast<Passes*>(object);
  print_if_loud();
  while (is("hangs")) pause();
  if (is("throws_later")) throw 42;
  if (is("broken")) return INEXTENSIBLE_OK;
  do {
    for (int i = 0; slow && i < 3; ++i) {
      copy.assign(step->x, step->x + 3 * scene.vertices);
      pass(scene, copy.data());
    }
    if (step->iterations++ == 100'000) {
      step->reason = "too many passes";
      return INEXTENSIBLE_NOT_CONVERGED;
    }
    step->edge_projections += scene.edges;
    if (step->settle) step->settle(step);
  } while (pass(scene, step->x));
  return std::isfinite(step->x[0]) ? INEXTENSIBLE_OK : INEXTENSIBLE_NOT_FINITE;
}

void destroy(void* object) { delete static_cast<Passes*>(object); }

}  // namespace

extern "C" const InextensiblePlugin* inextensible_plugin() {
  static InextensibleMethod method{};
  const bool misfit = is("broken") || is("hangs") || is("throws_later");
  method.name = is("taken_name") ? "shake" : misfit ? "misfit" : "sound";
  method.summary = misfit ? "does nothing of use" : "Gauss-Seidel in the order of the mesh";
  method.kind = INEXTENSIBLE_FILTER;
  method.flags = is("bare") ? 0 : INEXTENSIBLE_TAKES_COLLIDER;
  method.direction = INEXTENSIBLE_LOCAL;
  method.create = create;
  method.step = filter;
  method.destroy = destroy;
  static InextensiblePlugin plugin{INEXTENSIBLE_BUILD, "1.0", 1, &method};
  if (is("another_version")) plugin.abi = 999;
  if (is("throws")) throw std::runtime_error("no licence\nfor today");
  if (is("crashes")) std::raise(SIGSEGV);
  if (is("exits")) std::exit(3);
  std::fesetround(FE_UPWARD);  // none of this is to reach the program
  std::setlocale(LC_ALL, "C.UTF-8");
  return &plugin;
}
