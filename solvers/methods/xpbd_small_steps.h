// XPBD with small steps (Macklin et al. 2016, 2019): a fixed number of passes a step, one as a
// rule, without a test of convergence. It promises no strain limit: strain falls as h^2, and the
// step is what buys it.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"

namespace inextensible {

class XpbdSmallSteps final : public VelocityFilter {
 public:
  // Long-range attachments (Kim, Chentanez and Mueller 2012): no vertex is farther from a pinned
  // one than its rest distance, along edges, which inextensible edges imply, or straight, which
  // holds only where nothing shears. Momentum is not kept.
  struct Settings {
    int sweeps = 1;
    double relaxation = 1;  // of a correction
    std::string_view attachments = "none";
  };
  static SettingFields<Settings> fields();
  // rest: positions (3 x n) at rest, for straight attachments; null where they are not known.
  // Throws std::invalid_argument if they are needed.
  XpbdSmallSteps(const Problem& problem, const Settings& settings, const Positions* rest,
                 Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

 private:
  struct Attachment {
    int vertex, pin;
    double distance;  // m
  };
  void attach_along_edges(const Problem& problem);
  void attach_straight(const Problem& problem, const Positions& rest);
  void keep_nearest(const Problem& problem);

  int most_;
  Along along_;
  StrainPasses passes_;
  std::vector<Attachment> attachments_;
};

Backend xpbd_small_steps_row();

}  // namespace inextensible
