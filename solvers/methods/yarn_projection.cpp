// Yarn projection (Bender and Bayer 2008, "Parallel simulation of inextensible cloth", whose strips
// these are): every yarn of the cloth is projected as a whole, all yarns of one color (warp or
// weft, on a grid) before the next. Departures from the paper: one Newton step on positions for
// each yarn, and colored Gauss-Seidel passes over all edges between two rounds.
//
// Loops: two passes over links forwards and one back a yarn (yarn_pass.cpp), then passes
// (strain_passes.cpp).
#include <memory>

#include "solvers/methods/rows.h"
#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/methods/yarn_pass.h"

namespace inextensible {
namespace {

class YarnProjection final : public VelocityFilter {
 public:
  // What each is for stands in fields(). With targets of 0, over-relaxed passes throw edges to the
  // other side of the band, and runs gain energy.
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 5000;
    int sweeps = 20;
    double relaxation = 1.8;
    double target = 0.8;
    double sweep_target = 0.8;
  };
  static SettingFields<Settings> fields();
  // Passes act along edges as they are.
  YarnProjection(const Problem& problem, const Settings& settings, Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

 private:
  EdgeConstraints edges_;
  int max_iterations_;
  StrainPasses passes_;
  YarnPass yarns_;
  int passes_between_;
  Along along_;
};

YarnProjection::YarnProjection(const Problem& problem, const Settings& settings, Along along)
    : edges_(problem, settings.strain_limit),
      max_iterations_(settings.max_iterations),
      passes_(StrainPasses::by_mass(problem, {settings.strain_limit, settings.sweep_target},
                                    settings.relaxation)),
      yarns_(problem, settings.strain_limit, settings.target, passes_.edges()),
      passes_between_(yarns_.crossing() ? settings.sweeps : 0),
      along_(along) {}

StepResult YarnProjection::apply(const Positions& x_start, double /*h*/, Iterate x,
                                 WorkCounters& work) {
  if (edges_.permissible(x)) return {Status::ok, 0};
  passes_.begin(x);
  if (along_ == Along::middle) yarns_.take_middle_from(x_start);
  for (int passes = 0;; ++passes) {
    if (x.contact_count() > 0 && passes == StrainPasses::most_rounds_in_contact)
      return passes_.passes_alone(edges_, x, work);  // from the candidate: nothing has been stored
    const bool stops = passes_.gives_up(passes, max_iterations_);
    passes_.settle_contacts();
    std::int64_t corrected =
        stops ? 0 : yarns_.project(passes_.positions(), passes_.held_normals(), work);
    work.edge_projections += corrected;
    if (corrected > 0) corrected = passes_.in_turn(passes_between_, work).left;
    if (corrected > 0) continue;
    passes_.store(x);
    return StrainPasses::verdict(passes, stops ? "pass limit" : nullptr, edges_, x);
  }
}

SettingFields<YarnProjection::Settings> YarnProjection::fields() {
  using S = Settings;
  return {{"max_iterations", &S::max_iterations,
           "passes over all yarns a step before it is refused", at_least_one},
          {"sweeps", &S::sweeps, "colored Gauss-Seidel passes between two passes, at most",
           count_from_zero, tunable_passes},
          {"relaxation", &S::relaxation, "times a pass's correction", relaxation_range,
           tunable_relaxation},
          {"target", &S::target, "a yarn's links are brought to this fraction of the strain limit",
           fraction, tunable_fraction},
          {"sweep_target", &S::sweep_target,
           "an edge that a pass corrects is brought to this fraction of the strain limit", fraction,
           tunable_fraction}};
}

}  // namespace

Backend yarn_projection_row() {
  return {.name = "yarn_projection",
          .summary = "every yarn projected as a whole, passes of colored Gauss-Seidel between",
          .strain_control = StrainControl::strain_limit,
          .contestant = true,
          .settings = setting_infos(YarnProjection::fields()),
          .make_filter = make_filter<YarnProjection>,
          .takes_middle = true,
          .direction = Direction::current,
          .citation = "Bender and Bayer 2008",
          .origin = Origin::project,
          .label = "yarn projection",
          .same_on_chains = "fast_projection_adaptive"};
}

}  // namespace inextensible
