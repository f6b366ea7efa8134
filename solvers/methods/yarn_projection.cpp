// Yarn projection (Bender and Bayer 2008, "Parallel simulation of inextensible cloth", whose strips
// these are): every yarn of the cloth is projected as a whole, all yarns of one color (warp or
// weft, on a grid) before the next. Departures from the paper: one Newton step on positions for
// each yarn, and colored Gauss-Seidel passes over all edges between two rounds.
//
// A round is a pass over all yarns (yarn_pass.h), then passes over edges, until nothing is left to
// correct or their number is reached.
//
// fast_projection_adaptive adds fast projection's step for the whole cloth (equations 5 and 7 of
// Goldenthal et al. 2007, with C~ for C): a yarn carries corrections along itself at once, but
// across yarns they travel by passes. A step takes rounds alone, or a projection of the whole after
// each round: whichever has cost less in the last steps. The other way is tried again after a retry
// interval, which doubles while it stays more expensive; rounds that have cost twice as much as the
// other way are broken off. Costs are counted in visits of an edge, so that runs repeat exactly.
//
// Loops: three passes over links a yarn, one pass over edges; one assembly, one factorization and
// one solve a projection of the whole.
#include <algorithm>

#include "solvers/methods/rows.h"
#include "solvers/methods/yarn_pass.h"

namespace inextensible {
namespace {

// In visits of an edge by a pass, 0.7 ns, as kernels measures them: a link in a pass over yarns;
// a row's assembly, gradient and correction; a number of the factor in a solve; an operation of a
// factorization; a contact, settled.
constexpr double link_cost = 8, row_cost = 22, nonzero_cost = 0.55, operation_cost = 0.11,
                 contact_cost = 5;

// Rounds in contact, after which passes alone end a step: Newton's method overshoots where a step
// takes vertices far round an obstacle; passes do not.
constexpr int most_rounds_in_contact = 100, most_passes_alone = 100'000;

enum Way { rounds_alone, with_the_whole };  // how a step is done

// Which way is cheaper, as far as steps have shown.
class Experience {
 public:
  Way choose() {
    if (mean_[with_the_whole] == 0) return rounds_alone;
    const Way cheaper =
        mean_[rounds_alone] <= mean_[with_the_whole] ? rounds_alone : with_the_whole;
    if (cheaper != cheaper_) {
      cheaper_ = cheaper;
      until_retry_ = retry_interval_ = first_retry;
    }
    if (--until_retry_ > 0) return cheaper;
    until_retry_ = retry_interval_ = std::min(2 * retry_interval_, longest_retry);
    return cheaper == rounds_alone ? with_the_whole : rounds_alone;
  }

  bool too_expensive(int rounds, double cost) const {  // rounds alone
    const double other = mean_[with_the_whole];
    return other == 0 ? rounds >= first_rounds : cost > 2 * other;
  }
  void learn(Way way, double cost) {
    mean_[way] = mean_[way] == 0 ? cost : memory * mean_[way] + (1 - memory) * cost;
  }

 private:
  static constexpr double memory = 0.6;                       // of a mean, a step
  static constexpr int first_retry = 4, longest_retry = 128;  // steps
  static constexpr int first_rounds = 8;  // until the other way is tried for the first time

  double mean_[2] = {};  // cost of a step each way; 0: not tried yet
  Way cheaper_ = rounds_alone;
  int retry_interval_ = 0, until_retry_ = 0;  // steps until the more expensive way is tried again
};

class WholeCloth {
 public:
  WholeCloth(const Problem& problem, const BackendOptions& options)
      : system_(problem, options.strain_limit, options.word("linear_solver"),
                ConstraintSystem::Digits::few),
        target_(options.number("target")),
        forcing_(options.number("forcing")),
        x_(3, problem.vertices()),
        u_(3, problem.constraints()),
        mu_(problem.constraints()),
        before_{Positions(3, problem.vertices()), {}} {}

  void begin(const Positions& x) { x_ = x; }  // pinned vertices are where they are to be

  void take_middle_from(const Positions& x_start) {
    u_start_.resize(3, u_.cols());
    system_.edges().gradient(x_start, u_start_);
  }

  // Moves the positions of `passes`; adds to `cost`. false: no damping helps, nothing has moved.
  // Where J W J^T is singular, or so nearly that the projection overshoots, as it may happen to
  // cloth that lies on an obstacle, it is damped (fast_projection.cpp), more and more.
  bool project(StrainPasses& passes, Contacts* contacts, double& cost, WorkCounters& work) {
    constexpr double least_whole_damping = 1e-4, most_whole_damping = 1;  // of the diagonal
    // Largest growth of |C~|^2 that is accepted in contact: passes correct that much.
    constexpr double most_overshoot = 100;
    const WorkCounters at_first = work;
    passes.settle_contacts();
    passes.store(x_);
    Iterate x{x_, contacts};
    x.save(before_);
    const double error = linearize();
    bool projected = false;
    for (double damping = 0; !projected && damping <= most_whole_damping;
         damping = damping == 0 ? least_whole_damping : 10 * damping) {
      if (damping > 0) {
        x.restore(before_);
        linearize();
      }
      if (!system_.factor(u_, contacts, work, damping)) continue;
      if (!system_.solve(mu_, work, forcing_)) continue;  // (7)
      system_.edges().apply(u_, mu_, x_);                 // (5)
      x.settle();
      projected = !contacts || linearize() < most_overshoot * error;
    }
    if (projected) {
      passes.load(x);
    } else {
      x.restore(before_);
    }
    cost += cost_since(at_first, work);
    return projected;
  }

  const ConstraintSystem& system() const { return system_; }

 private:
  // The gradient to u_, C~ to mu_, both at x_. Returns |C~|^2.
  double linearize() {
    system_.edges().linearize(x_, u_, mu_, target_);
    if (u_start_.cols() > 0) to_middle(u_start_, u_);
    return mu_.squaredNorm();
  }

  double cost_since(const WorkCounters& before, const WorkCounters& now) const {
    const auto factorizations = static_cast<double>(now.factorizations - before.factorizations);
    const auto solves = static_cast<double>(now.back_solves - before.back_solves);
    return system_.edges().count() * (row_cost + 4 * solves) +
           solves * nonzero_cost * now.factor_nonzeros +
           factorizations * operation_cost * now.factor_flops;
  }

  ConstraintSystem system_;
  double target_, forcing_;
  Positions x_;
  Eigen::Matrix3Xd u_;        // gradient of C
  Eigen::Matrix3Xd u_start_;  // at x^n, for the middle of the step only
  Eigen::VectorXd mu_;        // C~, then h^2 dlambda
  Iterate::Record before_;    // the projection
};

class YarnProjection final : public VelocityFilter {
 public:
  YarnProjection(const Problem& problem, const BackendOptions& options, Along along,
                 std::unique_ptr<WholeCloth> whole = nullptr)
      : edges_(problem, options.strain_limit),
        along_(along),
        max_iterations_(options.count("max_iterations")),
        passes_(StrainPasses::by_mass(problem,
                                      {options.strain_limit, options.number("sweep_target")},
                                      options.number("relaxation"))),
        yarns_(problem, options.strain_limit, options.number("target"), passes_.edges()),
        sweeps_(yarns_.crossing() ? options.count("sweeps") : 0),
        whole_(std::move(whole)) {}

  StepResult apply(const Positions& x_start, double /*h*/, Iterate x, WorkCounters& work) override {
    if (edges_.permissible(x)) return {Status::ok, 0};
    passes_.load(x);
    if (x.contacts()) x.contacts()->save(begun_);
    if (along_ == Along::middle)
      yarns_.take_middle_from(x_start);  // passes: along edges as they are
    if (whole_) {
      whole_->begin(x);
      if (along_ == Along::middle) {
        whole_->take_middle_from(x_start);
        passes_.take_middle_from(x_start);
      }
    }
    bool whole = whole_ && yarns_.crossing();
    Way way = whole ? experience_.choose() : rounds_alone;
    double cost = 0;
    for (int rounds = 0;; ++rounds) {
      if (x.contact_count() > 0 && rounds == most_rounds_in_contact) {  // from the last x stored
        experience_ = {};
        x.contacts()->restore(begun_);
        return passes_.limit(StrainPasses::Order::in_turn, most_passes_alone, edges_, x, work);
      }
      const bool stops = passes_.gives_up(rounds, max_iterations_);
      const auto done = stops ? StrainPasses::Passed{0, 0} : round(work);
      const double spent = (link_cost + done.passes) * edges_.count() +
                           contact_cost * (1 + done.passes) * x.contact_count();
      cost += spent;
      if (done.left == 0) {
        const bool exact = passes_.exact();
        passes_.store(x);
        if (whole_ && !stops && x.contacts() && x.contacts()->find(x, work) > 0) {
          passes_.load(x);
          continue;
        }
        const StepResult result =
            StrainPasses::verdict(rounds, stops ? "round limit" : nullptr, edges_, x);
        if (!result && !stops && !exact) continue;
        experience_.learn(way, cost);
        if (!result) experience_ = {};  // a refused step leaves nothing behind
        return result;
      }
      if (!whole) continue;
      if (way == rounds_alone && experience_.too_expensive(rounds + 1, cost)) {
        experience_.learn(rounds_alone, 2 * cost);
        way = with_the_whole;
        cost = spent;
      }
      if (way == with_the_whole) whole = whole_->project(passes_, x.contacts(), cost, work);
    }
  }

  const char* linear_solver() const override {
    return whole_ ? whole_->system().solver_name().c_str() : "";
  }

 private:
  StrainPasses::Passed round(WorkCounters& work) {
    passes_.settle_contacts();
    const std::int64_t violated = yarns_.project(passes_.positions(), passes_.held_normals(), work);
    work.edge_projections += violated;
    return violated > 0 ? passes_.in_turn(sweeps_, work) : StrainPasses::Passed{0, 0};
  }

  EdgeConstraints edges_;
  Along along_;
  int max_iterations_;
  StrainPasses passes_;
  YarnPass yarns_;
  int sweeps_;  // where yarns cross; elsewhere a yarn's projection is that of the whole
  std::unique_ptr<WholeCloth> whole_;  // of fast_projection_adaptive
  Experience experience_;
  Contacts::Record begun_;  // contacts at the candidate
};

std::unique_ptr<VelocityFilter> make_adaptive(const Problem& problem, const BackendOptions& options,
                                              Along along) {
  return std::make_unique<YarnProjection>(problem, options, along,
                                          std::make_unique<WholeCloth>(problem, options));
}

// With targets of 0, over-relaxed passes throw edges across the band, and runs gain energy.
std::vector<SettingInfo> round_settings(const char* target) {
  return {iteration_limit(5000, "rounds a step before it is refused"),
          {"sweeps", 20.0, "colored Gauss-Seidel passes of a round, at most", count_from_zero,
           tunable_passes},
          {"relaxation", 1.8, "times a pass's correction", relaxation_range, tunable_relaxation},
          {"target", 0.8, target, fraction, tunable_fraction},
          {"sweep_target", 0.8, pass_target, fraction, tunable_fraction}};
}

}  // namespace

Backend yarn_projection_row() {
  return {
      .name = "yarn_projection",
      .summary = "every yarn projected as a whole, passes of colored Gauss-Seidel between",
      .settings = round_settings("a yarn's links are brought to this fraction of the strain limit"),
      .make_filter = make_filter<YarnProjection>,
      .takes_middle = true,
      .direction = Direction::current,
      .citation = "Bender and Bayer 2008",
      .origin = Origin::project,
      .label = "yarn projection",
      .same_on_chains = "fast_projection_adaptive"};
}

Backend fast_projection_adaptive_row() {
  std::vector<SettingInfo> settings = round_settings(
      "links and the whole cloth are projected to this fraction of the strain limit");
  settings.push_back({"forcing", 1e-2,
                      "residual of a linear solve in mixed precision, of the right-hand side",
                      Range{1e-8, 1}, tunable_forcing});
  settings.push_back(schur_solver());
  return {
      .name = "fast_projection_adaptive",
      .summary = "projection of every yarn, and of the whole cloth where that converges too slowly",
      .settings = std::move(settings),
      .make_filter = make_adaptive,
      .takes_middle = true,
      .direction = Direction::current,
      .citation = "Goldenthal et al. 2007; Bender and Bayer 2008",
      .origin = Origin::project,
      .label = "fast projection, adaptive"};
}

}  // namespace inextensible
