// A backend of one's own: strain limiting in symmetric sweeps. Edges are visited in the order of
// the mesh, forwards and backwards in turn (symmetric Gauss-Seidel), where the paper draws a fresh
// random permutation each sweep: no random numbers, but a correction travels along a row in one
// sweep only if the row is numbered along it.
// Loops: one pass over edges a sweep, one check.
#include <solvers/plugin.h>

#include <cmath>

namespace {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::Status;
using inextensible::StepResult;

class SymmetricSweeps final : public inextensible::VelocityFilter {
 public:
  SymmetricSweeps(const Problem& problem, double strain_limit, int max_sweeps)
      : edges_(problem, strain_limit), max_sweeps_(max_sweeps) {}

  StepResult apply(const Positions& /*x_start*/, double /*h*/, inextensible::Iterate x,
                   inextensible::WorkCounters& work) override {
    for (int sweep = 0; sweep < max_sweeps_; ++sweep) {
      if (edges_.permissible(x)) return {Status::ok, sweep};
      for (int i = 0; i < edges_.count(); ++i) {
        visit(sweep % 2 == 0 ? i : edges_.count() - 1 - i, x);
        ++work.edge_projections;
      }
      x.settle();  // vertices that went into the obstacle are put back
    }
    return inextensible::refuse(Status::not_converged, max_sweeps_, edges_, x, "sweep limit");
  }

 private:
  // Brings an edge that is out of bounds to its rest length; its ends share by inverse mass.
  void visit(int k, Positions& x) const {
    const Eigen::Vector3d d = x.col(edges_.b[k]) - x.col(edges_.a[k]);
    const double ratio = d.squaredNorm() / (edges_.rest_length[k] * edges_.rest_length[k]);
    const bool inside = ratio >= edges_.permissible_low && ratio <= edges_.permissible_high;
    if (inside || ratio == 0) return;
    const Eigen::Vector3d excess = (1 - 1 / std::sqrt(ratio)) / (edges_.wa[k] + edges_.wb[k]) * d;
    // A pinned end is not written to: adding 0 would make -0 of it.
    if (edges_.wa[k] > 0) x.col(edges_.a[k]) += edges_.wa[k] * excess;
    if (edges_.wb[k] > 0) x.col(edges_.b[k]) -= edges_.wb[k] * excess;
  }

  inextensible::EdgeConstraints edges_;
  int max_sweeps_;
};

std::unique_ptr<inextensible::Stepper> make(std::shared_ptr<const Problem> problem,
                                            const inextensible::BackendOptions& options) {
  const auto sweeps = static_cast<int>(std::get<double>(options.settings.at("max_iterations")));
  auto filter = std::make_unique<SymmetricSweeps>(*problem, options.strain_limit, sweeps);
  return std::make_unique<inextensible::FilterStepper>(std::move(problem), std::move(filter));
}

}  // namespace

extern "C" const InextensiblePlugin* inextensible_plugin() {
  static const std::vector<inextensible::Backend> rows{
      {"symmetric_sweeps",
       "strain limiting, edges in the order of the mesh, forwards and backwards in turn",
       inextensible::StrainControl::strain_limit,
       true,
       {{"max_iterations", 1e5, "sweeps a step before it is refused"}},
       make}};
  static const auto plugin = inextensible_plugin_of("1.0", rows);
  return &plugin;
}
