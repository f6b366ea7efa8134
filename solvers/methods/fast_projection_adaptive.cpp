// A round is a pass over all yarns (yarn_pass.h), then sweeps until nothing is left to correct
// or their number is up. Rounds alone, or after each of them a projection of the whole cloth
// (equations 5 and 7 of Goldenthal et al. 2007, with C~ for C): each step goes the way that has
// cost less in the last ones. The other way is tried again now and then, ever more seldom while it
// is in vain, and rounds that cost more than twice what the other way does are broken off: so that
// this is never much dearer than the better of the two. Prices are counted in visits of an edge,
// not taken from a clock, so that runs repeat exactly.
//
// Loops: three passes over links a yarn, one over edges a sweep; one assembly, one factorization
// and one solve a projection of the whole.
#include "solvers/methods/fast_projection_adaptive.h"

#include <algorithm>

namespace inextensible {
namespace {

// Of |C~|^2 by a projection of the whole with contacts: what friction makes of it sweeps mend, but
// not more.
constexpr double most_overshoot = 100;
constexpr double memory = 0.6;                           // of a mean, a step
constexpr int first_holiday = 4, longest_holiday = 128;  // steps
constexpr int most_rounds_in_contact = 100;
constexpr int first_rounds = 8;  // until a projection of the whole is tried for the first time

// In visits of an edge by a sweep, 1.3 ns, as kernels measures them: a link in a pass over yarns;
// a row's assembly, gradient and correction; a number of the factor in a solve; an operation of a
// factorization; a contact, settled.
constexpr double link_price = 3, row_price = 12, nonzero_price = 0.3, operation_price = 0.06,
                 contact_price = 5;

double price_of(const WorkCounters& before, const WorkCounters& after, int rows) {
  const auto factorizations = static_cast<double>(after.factorizations - before.factorizations);
  const auto solves = static_cast<double>(after.back_solves - before.back_solves +
                                          after.linear_iterations - before.linear_iterations);
  return rows * (row_price + 4 * solves) + solves * nonzero_price * after.factor_nonzeros +
         factorizations * operation_price * after.factor_flops;
}

}  // namespace

FastProjectionAdaptive::FastProjectionAdaptive(const Problem& problem, const Settings& settings)
    : system_(problem, settings.strain_limit, settings.linear_solver,
              ConstraintSystem::Digits::few),
      settings_(settings),
      sweep_(StrainPasses::by_mass(problem, {settings.strain_limit, settings.sweep_target},
                                   settings.relaxation)),
      yarns_(problem, settings.strain_limit, settings.target, sweep_.edges()),
      x_(3, problem.vertices()),
      u_(3, problem.constraints()),
      mu_(problem.constraints()) {
  if (!yarns_.crossing()) settings_.sweeps = 0;
}

StepResult FastProjectionAdaptive::apply(const Positions& /*x_start*/, double /*h*/, Positions& x,
                                         WorkCounters& work) {
  const EdgeConstraints& edges = system_.edges();
  if (edges.permissible(x)) return {Status::ok, 0};
  x_ = x;  // pinned vertices are where they are to be
  sweep_.load(x);
  bool regular = yarns_.crossing();  // else a yarn's projection is that of the whole
  Way way = regular ? choose() : rounds_alone;
  double price = 0;
  if (contacts_) contacts_->save(start_record_);
  for (int rounds = 0;; ++rounds) {
    // Newton's method overshoots where a step takes vertices far round an obstacle; sweeps do not.
    if (touches() && rounds == most_rounds_in_contact) {
      contacts_->restore(start_record_);
      seen_ = {};
      return sweep_.limit(StrainPasses::Order::in_turn, StrainPasses::far_too_many, edges, x, work);
    }
    const bool gives_up =
        rounds == settings_.max_iterations || (rounds % 64 == 63 && !sweep_.finite());
    sweep_.settle_contacts();
    const std::int64_t corrected = gives_up ? 0 : yarns_.project(sweep_.positions(), work);
    work.edge_projections += corrected;
    StrainPasses::Swept swept{corrected, 0};
    if (corrected > 0) swept = sweep_.in_turn(settings_.sweeps, work);
    const int touching = contacts_ ? contacts_->count() : 0;
    const double round =
        (link_price + swept.sweeps) * edges.count() + contact_price * (1 + swept.sweeps) * touching;
    price += round;
    if (swept.left == 0) {
      sweep_.store(x);
      if (contacts_ && !gives_up && contacts_->find(x, work) > 0) continue;
      if (edges.permissible(x)) {
        learn(way, price);
        return {Status::ok, rounds};
      }
      seen_ = {};  // a refused step leaves nothing behind
      return refuse(Status::not_converged, rounds, edges, x,
                    gives_up ? "round limit" : "an edge has no length");
    }
    if (!regular) continue;
    if (way == rounds_alone && too_dear(rounds + 1, price)) {
      learn(rounds_alone, 2 * price);
      way = with_the_whole;
      price = round;
    }
    if (way == with_the_whole) {
      const WorkCounters before = work;
      regular = project_the_whole(work);
      price += price_of(before, work, edges.count());
    }
  }
}

FastProjectionAdaptive::Way FastProjectionAdaptive::choose() {
  if (seen_.mean[with_the_whole] == 0) return rounds_alone;
  const Way cheaper =
      seen_.mean[rounds_alone] <= seen_.mean[with_the_whole] ? rounds_alone : with_the_whole;
  if (cheaper != seen_.cheaper) {
    seen_.cheaper = cheaper;
    seen_.until_trial = seen_.holiday = first_holiday;
  }
  if (--seen_.until_trial > 0) return cheaper;
  seen_.until_trial = seen_.holiday = std::min(2 * seen_.holiday, longest_holiday);
  return cheaper == rounds_alone ? with_the_whole : rounds_alone;
}

bool FastProjectionAdaptive::too_dear(int rounds, double price) const {
  const double other = seen_.mean[with_the_whole];
  return other == 0 ? rounds >= first_rounds : price > 2 * other;
}

void FastProjectionAdaptive::learn(Way way, double price) {
  double& mean = seen_.mean[way];
  mean = mean == 0 ? price : memory * mean + (1 - memory) * price;
}

// false: J W J^T is singular, or so nearly that the projection overshoots, as it may happen to
// cloth that lies on an obstacle; nothing has moved then.
bool FastProjectionAdaptive::project_the_whole(WorkCounters& work) {
  sweep_.settle_contacts();
  sweep_.store(x_);
  system_.edges().linearize(x_, u_, mu_);
  system_.edges().excess(settings_.target, mu_);
  const double error = mu_.squaredNorm();
  if (!system_.factor(u_, work) || !system_.solve(mu_, work, settings_.forcing))
    return false;                      // (7)
  system_.edges().apply(u_, mu_, x_);  // (5)
  if (contacts_) {
    contacts_->save(record_);
    contacts_->settle(x_);
    system_.edges().linearize(x_, u_, mu_);
    system_.edges().excess(settings_.target, mu_);
    if (!(mu_.squaredNorm() < most_overshoot * error)) {
      contacts_->restore(record_);
      return false;
    }
  }
  sweep_.load(x_);
  return true;
}

SettingFields<FastProjectionAdaptive::Settings> FastProjectionAdaptive::fields() {
  using S = Settings;
  return {
      {"max_iterations", &S::max_iterations, "rounds a step before it is refused", at_least_one},
      {"sweeps", &S::sweeps, "colored Gauss-Seidel sweeps of a round, at most", count_from_zero,
       SearchRange{0, 60}},
      {"relaxation", &S::relaxation, "times a sweep's correction", relaxation_range,
       tunable_relaxation},
      {"target", &S::target,
       "links and the whole cloth are projected to this fraction of the strain limit", fraction,
       tunable_fraction},
      {"sweep_target", &S::sweep_target,
       "an edge that a sweep corrects is brought to this fraction of the strain limit", fraction,
       tunable_fraction},
      {"forcing", &S::forcing,
       "residual of a linear solve by conjugate gradients or in mixed precision, of the "
       "right-hand side",
       Range{1e-8, 1}, tunable_forcing},
      schur_solver_field<S>()};
}

Backend fast_projection_adaptive_row() {
  return {.name = "fast_projection_adaptive",
          .summary =
              "projection of every yarn, and of the whole cloth where that converges too "
              "slowly",
          .knob = Knob::strain_limit,
          .contestant = true,
          .settings = setting_infos(FastProjectionAdaptive::fields()),
          .make = make_filter_stepper<FastProjectionAdaptive>,
          .direction = Direction::current,
          .citation = "Goldenthal et al. 2007; Bender and Bayer 2008",
          .label = "fast projection, adaptive"};
}

Backend fast_projection_adaptive_bdf2_row() {
  Backend row = inside_bdf2<FastProjectionAdaptive>(fast_projection_adaptive_row());
  row.name = "fast_projection_adaptive_bdf2";
  row.summary = "the same inside the two-step formula BDF2: second order";
  row.citation = "Goldenthal et al. 2007; Bender and Bayer 2008; English and Bridson 2008";
  row.label = "fast projection, adaptive, in BDF2";
  return row;
}

}  // namespace inextensible
