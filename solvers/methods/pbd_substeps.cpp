// PBD with substeps, which is XPBD with small steps (Macklin et al. 2016, 2019) without compliance:
// a fixed number of passes a step, one as a rule, without a test of convergence. It promises no
// strain limit. At rest under gravity an edge keeps a strain of about g h^2 / l times the edges
// below it, for one pass carries a load by one edge, or by one color.
//
// With compliance 0 and one pass from lambda = 0 an edge's multiplier is its correction (Macklin et
// al. 2016, eq. 18), and no multiplier is read again: every edge is brought to its rest length, one
// color after the other. Loops: `sweeps` passes over edges a step.
#include "solvers/methods/rows.h"
#include "solvers/methods/strain_passes.h"

namespace inextensible {
namespace {

class PbdSubsteps final : public VelocityFilter {
 public:
  PbdSubsteps(const Problem& problem, const BackendOptions& options, Along along)
      : most_(options.count("sweeps")),
        along_(along),
        passes_(StrainPasses::by_mass(problem, {0, 0}, options.number("relaxation"))) {}

  StepResult apply(const Positions& x_start, double /*h*/, Iterate x, WorkCounters& work) override {
    passes_.load(x);
    if (along_ == Along::middle) passes_.take_middle_from(x_start);
    for (int i = 0; i < most_; ++i)
      work.edge_projections += passes_.pass(StrainPasses::Order::in_turn);
    passes_.settle_contacts();
    if (!passes_.finite()) return {Status::not_finite, most_, -1, 0, "overflow"};
    passes_.store(x);
    return {Status::ok, most_};
  }

 private:
  int most_;
  Along along_;
  StrainPasses passes_;
};

}  // namespace

Backend pbd_substeps_row() {
  return {
      .name = "pbd_substeps",
      .summary = "PBD with substeps (XPBD without compliance): a fixed number of passes, no test",
      .strain_control = StrainControl::time_step,
      .settings = {{"sweeps", 1.0, "colored Gauss-Seidel passes a step", at_least_one,
                    SearchRange{1, 100}},
                   {"relaxation", 1.0, "times a correction", relaxation_range, tunable_relaxation}},
      .make_filter = make_filter<PbdSubsteps>,
      .takes_middle = true,
      .direction = Direction::local,
      .citation = "Macklin et al. 2016, 2019",
      .origin = Origin::literature,
      .label = "PBD with substeps (XPBD, compliance 0)"};
}

}  // namespace inextensible
