// Strain limiting: single edges are brought back within the limit, pass after pass, until all are.
//
// Edges within the limit are left alone (Provot 1995); others are brought to the target strain
// along themselves. Both ends move, shared by inverse mass, so that momentum is kept.
#include <numeric>

#include "solvers/methods/rows.h"
#include "solvers/methods/strain_passes.h"

namespace inextensible {
namespace {

// SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t next_random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

// Gauss-Seidel (Bridson, Fedkiw and Anderson 2002; Mueller et al. 2006): edge after edge, in a
// fresh random permutation each pass (Goldenthal et al. 2007, section 5). Loops: one pass over
// edges in random order, one check in order that stops at the first violation.
class GaussSeidel final : public VelocityFilter {
 public:
  GaussSeidel(const Problem& problem, const BackendOptions& options, Along along)
      : edges_(problem, options.strain_limit),
        along_(along),
        max_iterations_(options.count("max_iterations")),
        relaxation_(options.number("relaxation")),
        band_(options.strain_limit, options.number("target")),
        own_bands_(bands_of(problem, options)),
        permutation_(problem.constraints()),
        random_(options.seed) {
    std::iota(permutation_.begin(), permutation_.end(), 0);
    for (int k = 0; k < edges_.count(); ++k) {
      const double il = edges_.inverse_rest_length[k], wa = edges_.wa[k], wb = edges_.wb[k];
      records_.push_back({edges_.a[k], edges_.b[k], il * il, wa / (wa + wb)});
    }
  }

  StepResult apply(const Positions& x_start, double /*h*/, Iterate x, WorkCounters& work) override {
    for (int passes = 0;; ++passes) {
      if (edges_.permissible(x)) return {Status::ok, passes};
      if (passes == max_iterations_ || (passes % 64 == 63 && !x.positions().allFinite()))
        return refuse(Status::not_converged, passes, edges_, x, "pass limit");
      shuffle();
      const std::int64_t projections =
          along_ == Along::middle
              ? own_bands_.empty() ? pass<true, false>(x_start, x) : pass<true, true>(x_start, x)
          : own_bands_.empty() ? pass<false, false>(x_start, x)
                               : pass<false, true>(x_start, x);
      work.edge_projections += projections;
      x.settle();
      if (passes % 1024 == 1023) x.renew_planes(work);
      if (projections == 0)
        return refuse(Status::not_converged, passes, edges_, x, "an edge has no length");
    }
  }

 private:
  struct EdgeRecord {  // all that a visit needs
    int a, b;
    double inverse_square;  // 1 / l^2
    double share_a;         // w_a / (w_a + w_b), of the correction
  };

  void shuffle() {
    // Fisher-Yates, two exchanges from one random number; its halves are scaled to the range
    // (Lemire 2019, without rejection: bias below 1e-5 at these sizes).
    const auto exchange = [&](std::size_t last, std::uint64_t random32) {
      std::swap(permutation_[last], permutation_[(random32 * (last + 1)) >> 32]);
    };
    for (std::size_t i = permutation_.size(); i > 1; i -= 2) {
      const std::uint64_t random = next_random(random_);
      exchange(i - 1, random >> 32);
      exchange(i - 2, random & 0xffffffff);
    }
  }

  // One an edge where limits differ, else none.
  static std::vector<StrainBand> bands_of(const Problem& problem, const BackendOptions& options) {
    std::vector<StrainBand> bands;
    for (const double scale : problem.limit_scale())
      bands.emplace_back(scale * options.strain_limit, options.number("target"));
    return bands;
  }

  // own: limits differ.
  template <bool middle, bool own>
  std::int64_t pass(const Positions& x_start, Positions& x) const {
    double* p = x.data();
    const double* start = x_start.data();
    const StrainBand common = band_;  // in registers
    const double relaxation = relaxation_;
    std::int64_t projections = 0;
    for (const int k : permutation_) {
      const EdgeRecord& edge = records_[k];
      double* pa = p + 3 * edge.a;
      double* pb = p + 3 * edge.b;
      double d0 = pb[0] - pa[0], d1 = pb[1] - pa[1], d2 = pb[2] - pa[2];
      const double q = (d0 * d0 + d1 * d1 + d2 * d2) * edge.inverse_square;
      const StrainBand& band = own ? own_bands_[k] : common;
      if (!band.violated(q)) continue;
      if (q == 0) continue;  // no direction to correct along; the check refuses if it stays so
      const double wanted = q < band.low ? band.target_low : band.target_high;
      double excess = 1 - wanted / std::sqrt(q);
      if constexpr (middle) {
        const double *sa = start + 3 * edge.a, *sb = start + 3 * edge.b;
        const double m0 = 0.5 * (d0 + sb[0] - sa[0]), m1 = 0.5 * (d1 + sb[1] - sa[1]),
                     m2 = 0.5 * (d2 + sb[2] - sa[2]);
        const double along = (d0 * m0 + d1 * m1 + d2 * m2) * edge.inverse_square,
                     square = (m0 * m0 + m1 * m1 + m2 * m2) * edge.inverse_square;
        if (along > least_alignment * q) {
          excess = excess_along(q - wanted * wanted, along, square);
          d0 = m0, d1 = m1, d2 = m2;
        }
      }
      excess *= relaxation;
      const double sa = edge.share_a * excess, sb = excess - sa;
      pa[0] += sa * d0;
      pa[1] += sa * d1;
      pa[2] += sa * d2;
      pb[0] -= sb * d0;
      pb[1] -= sb * d1;
      pb[2] -= sb * d2;
      ++projections;
    }
    return projections;
  }

  EdgeConstraints edges_;
  Along along_;
  int max_iterations_;
  double relaxation_;
  StrainBand band_;
  std::vector<StrainBand> own_bands_;
  std::vector<EdgeRecord> records_;
  std::vector<int> permutation_;
  std::uint64_t random_;  // SplitMix64 state
};

// Passes over colored edges until one, which sees all edges in their final places, corrects none.
class PassLimiter final : public VelocityFilter {
 public:
  PassLimiter(const Problem& problem, const BackendOptions& options, Along along,
              StrainPasses::Order order, StrainPasses passes)
      : edges_(problem, options.strain_limit),
        along_(along),
        max_iterations_(options.count("max_iterations")),
        order_(order),
        passes_(std::move(passes)) {}
  StepResult apply(const Positions& x_start, double /*h*/, Iterate x, WorkCounters& work) override {
    if (along_ == Along::middle) passes_.take_middle_from(x_start);
    return passes_.limit(order_, max_iterations_, edges_, x, work);
  }

 private:
  EdgeConstraints edges_;
  Along along_;
  int max_iterations_;
  StrainPasses::Order order_;
  StrainPasses passes_;
};

// Gauss-Seidel in colors: edges that share no vertex are corrected side by side, as limiters for
// parallel processors do (Fratarcangeli, Tibaldo and Pellacini 2016).
//
// A pass equals one that visits edges one after the other, color after color. The order is the same
// in every pass; the random one of gauss_seidel takes about a third more passes. What colors win on
// one processor is vectors (strain_passes.cpp). Loops: one pass over edges.
std::unique_ptr<VelocityFilter> make_colored(const Problem& problem, const BackendOptions& options,
                                             Along along) {
  return std::make_unique<PassLimiter>(
      problem, options, along, StrainPasses::Order::in_turn,
      StrainPasses::by_mass(problem, {options.strain_limit, options.number("target")},
                            options.number("relaxation")));
}

// Jacobi (Provot 1995; Bridson, Fedkiw and Anderson 2002): all edges corrected from the same state,
// the corrections averaged.
//
// Averaging: edge k's correction is divided by the mean valence of its ends, weighted by their
// inverse masses,
//   omega_k = (w_a + w_b) / (w_a deg_a + w_b deg_b),
// the same factor at both ends, so momentum is kept (dividing by each vertex's own valence would
// not). Linearized, the pass is x -= W J^T S J x with every row of S J W J^T summing in absolute
// value to at most 1, hence all its eigenvalues lie in [0, 1]: it converges at any valence and any
// masses, and up to relaxation 2. The default, 1.8, takes about a third fewer passes than the plain
// average on the drape. Loops: one pass over edges, one over vertices.
std::unique_ptr<VelocityFilter> make_jacobi(const Problem& problem, const BackendOptions& options,
                                            Along along) {
  std::vector<int> valence(problem.vertices(), 0);
  for (const auto [a, b] : problem.edges()) {
    ++valence[a];
    ++valence[b];
  }
  const double relaxation = options.number("relaxation");
  std::vector<double> share_a, share_b;
  for (const auto [a, b] : problem.edges()) {
    const double wa = problem.inverse_mass()[a], wb = problem.inverse_mass()[b];
    const double share = relaxation / (wa * valence[a] + wb * valence[b]);
    share_a.push_back(wa * share);
    share_b.push_back(wb * share);
  }
  return std::make_unique<PassLimiter>(
      problem, options, along, StrainPasses::Order::at_once,
      StrainPasses(problem, {options.strain_limit, options.number("target")}, share_a, share_b));
}

std::vector<SettingInfo> limiter_settings(double relaxation) {
  return {iteration_limit(1e5, "passes a step before it is refused"),
          {"target", 0.0, "a corrected edge is brought to this fraction of the strain limit",
           fraction, tunable_fraction},
          {"relaxation", relaxation, "times the correction", relaxation_range, tunable_relaxation}};
}

}  // namespace

Backend gauss_seidel_row() {
  return {.name = "gauss_seidel",
          .summary = "strain limiting: edge after edge, in random order",
          .settings = limiter_settings(1),
          .make_filter = make_filter<GaussSeidel>,
          .takes_middle = true,
          .direction = Direction::local,
          .citation = "Bridson, Fedkiw and Anderson 2002; Mueller et al. 2006",
          .origin = Origin::paper,
          .label = "Gauss-Seidel strain limiting"};
}

Backend gauss_seidel_colored_row() {
  return {.name = "gauss_seidel_colored",
          .summary = "strain limiting: edges that share no vertex side by side in vectors",
          .settings = limiter_settings(1),
          .make_filter = make_colored,
          .takes_middle = true,
          .direction = Direction::local,
          .citation = "Fratarcangeli, Tibaldo and Pellacini 2016",
          .origin = Origin::literature,
          .label = "Gauss-Seidel strain limiting, colored",
          .family = "gauss_seidel"};
}

Backend jacobi_row() {
  return {.name = "jacobi",
          .summary = "strain limiting: all edges corrected at once, averaged",
          .settings = limiter_settings(1.8),
          .make_filter = make_jacobi,
          .takes_middle = true,
          .direction = Direction::local,
          .citation = "Provot 1995; Bridson, Fedkiw and Anderson 2002",
          .origin = Origin::paper,
          .label = "Jacobi strain limiting"};
}

}  // namespace inextensible
