// Gauss-Seidel strain limiting (Bridson, Fedkiw and Anderson 2002; Mueller et al. 2006): edge after
// edge, in a fresh random permutation each pass (Goldenthal et al. 2007, section 5), until the
// maximum strain is permissible.
//
// One visit moves both ends of an edge along it, shared by inverse mass, so that momentum is kept.
// Edges within the limit are left alone (Provot 1995); others are brought to the target strain.
// Loops: one pass over edges in random order, one check in order that stops at the first violation.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/methods/rows.h"
#include "solvers/methods/strain_limiting.h"

namespace inextensible {
namespace {

class GaussSeidel final : public VelocityFilter {
 public:
  using Settings = LimiterSettings;
  static SettingFields<Settings> fields() { return Settings::fields(); }
  GaussSeidel(const Problem& problem, const Settings& settings, Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

 private:
  struct EdgeRecord {  // all that a visit needs
    int a, b;
    double inverse_square;  // 1 / l^2
    double share_a;         // w_a / (w_a + w_b), of the correction
  };
  void shuffle();
  template <bool middle>
  std::int64_t pass(const Positions& x_start, Positions& x) const;

  EdgeConstraints edges_;
  int max_iterations_;
  StrainBand band_;
  double relaxation_;
  Along along_;
  std::vector<EdgeRecord> records_;
  std::vector<int> permutation_;
  std::uint64_t random_;  // SplitMix64 state
};

// SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t next_random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

GaussSeidel::GaussSeidel(const Problem& problem, const Settings& settings, Along along)
    : edges_(problem, settings.strain_limit),
      max_iterations_(settings.max_iterations),
      band_(settings.strain_limit, settings.target),
      relaxation_(settings.relaxation),
      along_(along),
      records_(problem.constraints()),
      permutation_(problem.constraints()),
      random_(settings.seed) {
  std::iota(permutation_.begin(), permutation_.end(), 0);
  for (std::size_t k = 0; k < records_.size(); ++k) {
    const double il = edges_.inverse_rest_length[k];
    records_[k] = {edges_.a[k], edges_.b[k], il * il, edges_.wa[k] / (edges_.wa[k] + edges_.wb[k])};
  }
}

void GaussSeidel::shuffle() {
  // Fisher-Yates, two exchanges from one random number; its halves are scaled to the range (Lemire
  // 2019, without rejection: bias below 1e-5 at these sizes).
  const auto exchange = [&](std::size_t last, std::uint64_t random32) {
    std::swap(permutation_[last], permutation_[(random32 * (last + 1)) >> 32]);
  };
  for (std::size_t i = permutation_.size(); i > 1; i -= 2) {
    const std::uint64_t random = next_random(random_);
    exchange(i - 1, random >> 32);
    exchange(i - 2, random & 0xffffffff);
  }
}

template <bool middle>
std::int64_t GaussSeidel::pass(const Positions& x_start, Positions& x) const {
  double* p = x.data();
  const double* start = x_start.data();
  const StrainBand band = band_;  // in registers
  const double relaxation = relaxation_;
  std::int64_t projections = 0;
  for (const int k : permutation_) {
    const EdgeRecord& edge = records_[k];
    double* pa = p + 3 * edge.a;
    double* pb = p + 3 * edge.b;
    double d0 = pb[0] - pa[0], d1 = pb[1] - pa[1], d2 = pb[2] - pa[2];
    const double q = (d0 * d0 + d1 * d1 + d2 * d2) * edge.inverse_square;
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
        excess = excess_along(q, along, square, wanted);
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

StepResult GaussSeidel::apply(const Positions& x_start, double /*h*/, Iterate x,
                              WorkCounters& work) {
  for (int passes = 0;; ++passes) {
    if (edges_.permissible(x)) return {Status::ok, passes};
    if (passes == max_iterations_ || (passes % 64 == 63 && !x.positions().allFinite())) {
      return refuse(Status::not_converged, passes, edges_, x, "pass limit");
    }
    shuffle();
    const std::int64_t projections =
        along_ == Along::middle ? pass<true>(x_start, x) : pass<false>(x_start, x);
    work.edge_projections += projections;
    x.settle();
    if (passes % 1024 == 1023) x.renew_planes(work);
    if (projections == 0)
      return refuse(Status::not_converged, passes, edges_, x, "an edge has no length");
  }
}

}  // namespace

Backend gauss_seidel_row() {
  return {.name = "gauss_seidel",
          .summary = "strain limiting: edge after edge, in random order",
          .strain_control = StrainControl::strain_limit,
          .contestant = true,
          .settings = setting_infos(GaussSeidel::fields()),
          .make_filter = make_filter<GaussSeidel>,
          .takes_middle = true,
          .direction = Direction::local,
          .citation = "Bridson, Fedkiw and Anderson 2002; Mueller et al. 2006",
          .origin = Origin::paper,
          .label = "Gauss-Seidel strain limiting"};
}

}  // namespace inextensible
