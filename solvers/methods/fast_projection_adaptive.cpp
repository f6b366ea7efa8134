// Yarn projection while it converges quickly, fast projection's step for the whole cloth where it
// does not: a yarn carries corrections along itself at once, but across yarns they travel by
// passes.
//
// A round is a pass over all yarns (yarn_pass.h), then passes over edges, until nothing is left to
// correct or their number is reached. A step takes rounds alone, or a projection of the whole cloth
// after each round (equations 5 and 7 of Goldenthal et al. 2007, with C~ for C): whichever has cost
// less in the last steps. The other way is tried again after a retry interval, which doubles while
// it stays more expensive; rounds that have cost twice as much as the other way are broken off.
// Costs are counted in visits of an edge, not timed, so that runs repeat exactly.
//
// Loops: three passes over links a yarn, one pass over edges; one assembly, one factorization and
// one solve a projection of the whole.
#include <algorithm>
#include <memory>

#include "solvers/methods/rows.h"
#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/methods/yarn_pass.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {
namespace {

class FastProjectionAdaptive final : public VelocityFilter {
 public:
  // What each is for stands in fields().
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 5000;
    int sweeps = 20;
    double relaxation = 1.8;
    double target = 0.8;
    double sweep_target = 0.8;
    double forcing = 1e-2;
    std::string_view linear_solver = "auto";
  };
  static SettingFields<Settings> fields();
  FastProjectionAdaptive(const Problem& problem, const Settings& settings,
                         Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;
  const char* linear_solver() const override { return system_.solver_name().c_str(); }
  double reciprocal_condition() const override { return system_.reciprocal_condition(); }

 private:
  enum Way { rounds_alone, with_the_whole };  // how a step is done
  Way choose();
  bool too_expensive(int rounds, double cost) const;
  void learn(Way way, double cost);
  double linearize();
  bool project_the_whole(Contacts* contacts, WorkCounters& work);

  ConstraintSystem system_;
  Settings settings_;
  Along along_;
  StrainPasses passes_;
  YarnPass yarns_;
  Positions x_;
  Eigen::Matrix3Xd u_;        // gradient of C
  Eigen::Matrix3Xd u_start_;  // at x^n, for the middle of the step only
  Eigen::VectorXd mu_;        // C~, then h^2 dlambda
  Iterate::Record before_;    // a projection of the whole
  // What steps have cost each way, in visits of an edge; 0: not tried yet.
  struct Seen {
    double mean[2] = {};
    Way cheaper = rounds_alone;
    int retry_interval = 0, until_retry = 0;  // steps until the more expensive way is tried again
  } seen_;
};

// Largest growth of |C~|^2 that is accepted of a projection of the whole in contact: passes correct
// that much.
constexpr double most_overshoot = 100;
constexpr double least_whole_damping = 1e-4, most_whole_damping = 1;  // of the diagonal
constexpr double memory = 0.6;                                        // of a mean, a step
constexpr int first_retry = 4, longest_retry = 128;                   // steps
constexpr int first_rounds = 8;  // until a projection of the whole is tried for the first time

// In visits of an edge by a pass, 1.3 ns, as kernels measures them: a link in a pass over yarns;
// a row's assembly, gradient and correction; a number of the factor in a solve; an operation of a
// factorization; a contact, settled.
constexpr double link_cost = 3, row_cost = 12, nonzero_cost = 0.3, operation_cost = 0.06,
                 contact_cost = 5;

double cost_of(const WorkCounters& before, const WorkCounters& after, int rows) {
  const auto factorizations = static_cast<double>(after.factorizations - before.factorizations);
  const auto solves = static_cast<double>(after.back_solves - before.back_solves +
                                          after.linear_iterations - before.linear_iterations);
  return rows * (row_cost + 4 * solves) + solves * nonzero_cost * after.factor_nonzeros +
         factorizations * operation_cost * after.factor_flops;
}

FastProjectionAdaptive::FastProjectionAdaptive(const Problem& problem, const Settings& settings,
                                               Along along)
    : system_(problem, settings.strain_limit, settings.linear_solver,
              ConstraintSystem::Digits::few),
      settings_(settings),
      along_(along),
      passes_(StrainPasses::by_mass(problem, {settings.strain_limit, settings.sweep_target},
                                    settings.relaxation)),
      yarns_(problem, settings.strain_limit, settings.target, passes_.edges()),
      x_(3, problem.vertices()),
      u_(3, problem.constraints()),
      mu_(problem.constraints()),
      before_{Positions(3, problem.vertices()), {}} {
  if (!yarns_.crossing()) settings_.sweeps = 0;
  if (along == Along::middle) u_start_.resize(3, problem.constraints());
}

StepResult FastProjectionAdaptive::apply(const Positions& x_start, double /*h*/, Iterate x,
                                         WorkCounters& work) {
  const EdgeConstraints& edges = system_.edges();
  if (edges.permissible(x)) return {Status::ok, 0};
  if (along_ == Along::middle) {
    edges.gradient(x_start, u_start_);
    yarns_.take_middle_from(x_start);
    passes_.take_middle_from(x_start);
  }
  x_ = x;  // pinned vertices are where they are to be
  passes_.begin(x);
  bool regular = yarns_.crossing();  // else a yarn's projection is that of the whole
  Way way = regular ? choose() : rounds_alone;
  double cost = 0;
  for (int rounds = 0;; ++rounds) {
    if (x.contact_count() > 0 && rounds == StrainPasses::most_rounds_in_contact) {
      seen_ = {};
      return passes_.passes_alone(edges, x, work);
    }
    const bool stops = passes_.gives_up(rounds, settings_.max_iterations);
    passes_.settle_contacts();
    const std::int64_t corrected =
        stops ? 0 : yarns_.project(passes_.positions(), passes_.held_normals(), work);
    work.edge_projections += corrected;
    StrainPasses::Passed done{corrected, 0};
    if (corrected > 0) done = passes_.in_turn(settings_.sweeps, work);
    const double round = (link_cost + done.passes) * edges.count() +
                         contact_cost * (1 + done.passes) * x.contact_count();
    cost += round;
    if (done.left == 0) {
      passes_.store(x);
      if (!stops && x.find_contacts(work) > 0) {
        passes_.load(x);
        continue;
      }
      const StepResult result =
          StrainPasses::verdict(rounds, stops ? "round limit" : nullptr, edges, x);
      if (result) {
        learn(way, cost);
      } else {
        seen_ = {};  // a refused step leaves nothing behind
      }
      return result;
    }
    if (!regular) continue;
    if (way == rounds_alone && too_expensive(rounds + 1, cost)) {
      learn(rounds_alone, 2 * cost);
      way = with_the_whole;
      cost = round;
    }
    if (way == with_the_whole) {
      const WorkCounters before = work;
      regular = project_the_whole(x.contacts(), work);
      cost += cost_of(before, work, edges.count());
    }
  }
}

FastProjectionAdaptive::Way FastProjectionAdaptive::choose() {
  if (seen_.mean[with_the_whole] == 0) return rounds_alone;
  const Way cheaper =
      seen_.mean[rounds_alone] <= seen_.mean[with_the_whole] ? rounds_alone : with_the_whole;
  if (cheaper != seen_.cheaper) {
    seen_.cheaper = cheaper;
    seen_.until_retry = seen_.retry_interval = first_retry;
  }
  if (--seen_.until_retry > 0) return cheaper;
  seen_.until_retry = seen_.retry_interval = std::min(2 * seen_.retry_interval, longest_retry);
  return cheaper == rounds_alone ? with_the_whole : rounds_alone;
}

bool FastProjectionAdaptive::too_expensive(int rounds, double cost) const {
  const double other = seen_.mean[with_the_whole];
  return other == 0 ? rounds >= first_rounds : cost > 2 * other;
}

void FastProjectionAdaptive::learn(Way way, double cost) {
  double& mean = seen_.mean[way];
  mean = mean == 0 ? cost : memory * mean + (1 - memory) * cost;
}

// Where J W J^T is singular, or so nearly that the projection overshoots, as it may happen to cloth
// that lies on an obstacle, it is damped (fast_projection.cpp), more and more. false: no damping
// helps; nothing has moved then.
bool FastProjectionAdaptive::project_the_whole(Contacts* contacts, WorkCounters& work) {
  passes_.settle_contacts();
  passes_.store(x_);
  Iterate x{x_, contacts};
  x.save(before_);
  const double error = linearize();
  for (double damping = 0; damping <= most_whole_damping;
       damping = damping == 0 ? least_whole_damping : 10 * damping) {
    if (damping > 0) {
      x.restore(before_);
      linearize();
    }
    if (!system_.factor(u_, contacts, work, damping)) continue;
    if (!system_.solve(mu_, work, settings_.forcing)) continue;  // (7)
    system_.edges().apply(u_, mu_, x_);                          // (5)
    x.settle();
    if (!contacts || linearize() < most_overshoot * error) {
      passes_.load(x);
      return true;
    }
  }
  x.restore(before_);
  return false;
}

// The gradient to u_, C~ to mu_, both at x_. Returns |C~|^2.
double FastProjectionAdaptive::linearize() {
  system_.edges().linearize(x_, u_, mu_);
  if (along_ == Along::middle) to_middle(u_start_, u_);
  system_.edges().excess(settings_.target, mu_);
  return mu_.squaredNorm();
}

SettingFields<FastProjectionAdaptive::Settings> FastProjectionAdaptive::fields() {
  using S = Settings;
  return {
      {"max_iterations", &S::max_iterations, "rounds a step before it is refused", at_least_one},
      {"sweeps", &S::sweeps, "colored Gauss-Seidel passes of a round, at most", count_from_zero,
       tunable_passes},
      {"relaxation", &S::relaxation, "times a pass's correction", relaxation_range,
       tunable_relaxation},
      {"target", &S::target,
       "links and the whole cloth are projected to this fraction of the strain limit", fraction,
       tunable_fraction},
      {"sweep_target", &S::sweep_target,
       "an edge that a pass corrects is brought to this fraction of the strain limit", fraction,
       tunable_fraction},
      {"forcing", &S::forcing,
       "residual of a linear solve by conjugate gradients or in mixed precision, of the "
       "right-hand side",
       Range{1e-8, 1}, tunable_forcing},
      schur_solver_field<S>()};
}

}  // namespace

Backend fast_projection_adaptive_row() {
  return {.name = "fast_projection_adaptive",
          .summary =
              "projection of every yarn, and of the whole cloth where that converges too "
              "slowly",
          .strain_control = StrainControl::strain_limit,
          .contestant = true,
          .settings = setting_infos(FastProjectionAdaptive::fields()),
          .make_filter = make_filter<FastProjectionAdaptive>,
          .takes_middle = true,
          .direction = Direction::current,
          .citation = "Goldenthal et al. 2007; Bender and Bayer 2008",
          .origin = Origin::project,
          .label = "fast projection, adaptive"};
}

}  // namespace inextensible
