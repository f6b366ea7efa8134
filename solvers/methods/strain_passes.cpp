// Edges come in groups of one color. A group is tested first; where none of its edges violates the
// limit, which near convergence is most groups, square roots and divisions are left out, elsewhere
// a mask keeps the edges within the limit as they are. Each step is a loop of fixed length without
// branches, which compilers turn into a few vector instructions (GCC 12: two vectors of eight).
// Square roots and divisions are 60 % of a pass that corrects every edge (floor_ratio in kernels).
#include "solvers/methods/strain_passes.h"

#include <algorithm>
#include <cmath>

namespace inextensible {
namespace {

constexpr int width = ColoredEdges::width;

// x, y and z of both ends of a group's edges.
struct Ends {
  Ends(double* places, std::ptrdiff_t stride, int a, int b)
      : ax(places + a),
        ay(ax + stride),
        az(ay + stride),
        bx(places + b),
        by(bx + stride),
        bz(by + stride) {}
  double *ax, *ay, *az, *bx, *by, *bz;
};

// Adds to the ends at `to` what corrects the edges between those at `from`; no place occurs twice.
// `middle`: along the edges in the middle of the step from `start`.
template <bool middle>
inline int correct(const Ends& from, const Ends& start, const Ends& to,
                   const double* inverse_square, const double* share_a, const double* share_b,
                   const StrainBand& band) {
  double q[width], excess[width];
  [[maybe_unused]] double from_start[width];  // 1: along m, 0: along d
  std::int64_t violations = 0;
  for (int i = 0; i < width; ++i) {
    const double d0 = from.bx[i] - from.ax[i];
    const double d1 = from.by[i] - from.ay[i];
    const double d2 = from.bz[i] - from.az[i];
    q[i] = (d0 * d0 + d1 * d1 + d2 * d2) * inverse_square[i];
    violations += band.violated(q[i]) && q[i] != 0 ? 1 : 0;
  }
  if (violations == 0) return 0;
  for (int i = 0; i < width; ++i) {
    const double wanted = q[i] < band.low ? band.target_low : band.target_high;
    double all = 1 - wanted / std::sqrt(q[i]);
    if constexpr (middle) {
      const double d0 = from.bx[i] - from.ax[i], d1 = from.by[i] - from.ay[i],
                   d2 = from.bz[i] - from.az[i];
      const double m0 = 0.5 * (d0 + start.bx[i] - start.ax[i]),
                   m1 = 0.5 * (d1 + start.by[i] - start.ay[i]),
                   m2 = 0.5 * (d2 + start.bz[i] - start.az[i]);
      const double p = (d0 * m0 + d1 * m1 + d2 * m2) * inverse_square[i];
      const double r = (m0 * m0 + m1 * m1 + m2 * m2) * inverse_square[i];
      const bool aligned = p > least_alignment * q[i];
      all = aligned ? excess_along(q[i], p, r, wanted) : all;
      from_start[i] = aligned ? 1 : 0;
    }
    excess[i] = band.violated(q[i]) && q[i] != 0 ? all : 0;
  }
#pragma GCC ivdep
  for (int i = 0; i < width; ++i) {
    double d0 = from.bx[i] - from.ax[i];
    double d1 = from.by[i] - from.ay[i];
    double d2 = from.bz[i] - from.az[i];
    if constexpr (middle) {
      const double half = 0.5 * from_start[i];
      d0 += half * (start.bx[i] - start.ax[i] - d0);
      d1 += half * (start.by[i] - start.ay[i] - d1);
      d2 += half * (start.bz[i] - start.az[i] - d2);
    }
    const double sa = share_a[i] * excess[i], sb = share_b[i] * excess[i];
    to.ax[i] += sa * d0;
    to.ay[i] += sa * d1;
    to.az[i] += sa * d2;
    to.bx[i] -= sb * d0;
    to.by[i] -= sb * d1;
    to.bz[i] -= sb * d2;
  }
  return static_cast<int>(violations);
}

}  // namespace

StrainBand::StrainBand(double strain_limit, double target)
    : low(PermissibleSquares(strain_limit).low * (1 + 1e-15)),
      high(PermissibleSquares(strain_limit).high * (1 - 1e-15)),
      target_low(std::max(1 - target * strain_limit, std::sqrt(low) * (1 + 1e-15))),
      target_high(std::min(1 + target * strain_limit, std::sqrt(high) * (1 - 1e-15))) {}

StrainPasses::StrainPasses(const Problem& problem, const StrainBand& band,
                           const std::vector<double>& share_a, const std::vector<double>& share_b)
    : edges_(problem),
      planes_(edges_, problem.contact_inside()),
      band_(band),
      inverse_square_(edges_.entries()),
      share_a_(edges_.entries()),
      share_b_(edges_.entries()),
      x_(edges_.make_places()),
      correction_(edges_.make_places()) {
  for (int k = 0; k < edges_.entries(); ++k) {
    const int edge = edges_.problem_edge()[k];
    inverse_square_[k] = share_a_[k] = share_b_[k] = 0;  // q = 0: never corrected
    if (edge < 0) continue;
    const double l = problem.rest_length()[edge];
    inverse_square_[k] = 1 / (l * l);
    share_a_[k] = share_a[edge];
    share_b_[k] = share_b[edge];
    if (edges_.turned(k)) std::swap(share_a_[k], share_b_[k]);
  }
}

StrainPasses StrainPasses::by_mass(const Problem& problem, const StrainBand& band,
                                   double relaxation) {
  std::vector<double> share_a, share_b;
  for (const Edge& edge : problem.edges()) {
    const double wa = problem.inverse_mass()[edge.a];
    const double wb = problem.inverse_mass()[edge.b];
    share_a.push_back(relaxation * (wa / (wa + wb)));
    share_b.push_back(relaxation - share_a.back());
  }
  return {problem, band, share_a, share_b};
}

StepResult StrainPasses::limit(Order order, int most_passes, const EdgeConstraints& edges,
                               Iterate x, WorkCounters& work) {
  load(x);
  for (int passes = 0;; ++passes) {
    const bool stops = gives_up(passes, most_passes);
    const std::int64_t corrected = stops ? 0 : order == Order::in_turn ? in_turn() : at_once();
    work.edge_projections += corrected;
    if (corrected > 0) {
      if (contacts_ && passes % 1024 == 1023) renew_planes(x, work);
      continue;
    }
    store(x);
    return verdict(passes, stops ? "pass limit" : nullptr, edges, x);
  }
}

StepResult StrainPasses::verdict(int passes, const char* limit, const EdgeConstraints& edges,
                                 const Positions& x) {
  if (edges.permissible(x)) return {Status::ok, passes};
  return refuse(Status::not_converged, passes, edges, x, limit ? limit : "an edge has no length");
}

// By way of x, where vertices lie as contacts know them.
void StrainPasses::renew_planes(Iterate x, WorkCounters& work) {
  store(x);
  if (contacts_->update(x, work) > 0) load(x);
}

void StrainPasses::load(Iterate x) {
  edges_.load(x, x_);
  contacts_ = x.contacts();
  if (!contacts_) return;
  const Contacts::Timing measured = contacts_->timing();
  planes_.load(*contacts_, edges_);
}

void StrainPasses::store(Positions& x) const {
  edges_.store(x_, x);
  if (!contacts_) return;
  const Contacts::Timing measured = contacts_->timing();
  planes_.store(*contacts_, edges_);
}

void StrainPasses::settle_contacts() {
  if (!contacts_) return;
  const Contacts::Timing measured = contacts_->timing();
  planes_.settle(x_);
}

const ColoredEdges::Places* StrainPasses::held_normals() {
  if (!contacts_ || contacts_->count() == 0) return nullptr;
  const Contacts::Timing measured = contacts_->timing();
  return &planes_.held_normals();
}

void StrainPasses::take_middle_from(const Positions& x_start) {
  if (start_.rows() == 0) start_ = edges_.make_places();
  edges_.load(x_start, start_);
}

std::int64_t StrainPasses::in_turn() {
  settle_contacts();
  return start_.rows() > 0 ? pass<true, true>(x_) : pass<true, false>(x_);
}

StrainPasses::Passed StrainPasses::in_turn(int most, WorkCounters& work) {
  Passed done{1, 0};
  while (done.passes < most && done.left > 0) {
    done.left = in_turn();
    work.edge_projections += done.left;
    ++done.passes;
  }
  return done;
}

std::int64_t StrainPasses::at_once() {
  settle_contacts();
  const std::int64_t corrected =
      start_.rows() > 0 ? pass<false, true>(correction_) : pass<false, false>(correction_);
  if (corrected == 0) return 0;
  x_ += correction_;
  correction_.setZero();
  return corrected;
}

template <bool in_place, bool middle>
std::int64_t StrainPasses::pass(ColoredEdges::Places& to) {
  const int *a = edges_.a().data(), *b = edges_.b().data();
  const std::ptrdiff_t stride = x_.rows();
  std::int64_t corrected = 0;
  for (const ColoredEdges::Block& block : edges_.blocks()) {
    for (int k = block.first; k < block.first + block.count; k += width) {
      const auto correct_at = [&](const Ends& x, const Ends& start, const Ends& sum) {
        return correct<middle>(x, start, in_place ? x : sum, inverse_square_.data() + k,
                               share_a_.data() + k, share_b_.data() + k, band_);
      };
      if (block.adjacent) {
        const Ends x(x_.data(), stride, a[k], b[k]);
        const Ends start = middle ? Ends(start_.data(), stride, a[k], b[k]) : x;
        corrected += correct_at(x, start, {to.data(), stride, a[k], b[k]});
        continue;
      }
      double gathered[3][6 * width];  // positions, sums, positions at the start
      const auto gather = [&](const ColoredEdges::Places& places, double* out) {
        for (int axis = 0; axis < 3; ++axis) {
          const double* p = places.col(axis).data();
          for (int i = 0; i < width; ++i) out[2 * axis * width + i] = p[a[k + i]];
          for (int i = 0; i < width; ++i) out[(2 * axis + 1) * width + i] = p[b[k + i]];
        }
      };
      gather(x_, gathered[0]);
      double* out = gathered[in_place ? 0 : 1];
      if (!in_place) gather(to, out);
      if (middle) gather(start_, gathered[2]);
      const int here =
          correct_at({gathered[0], 2 * width, 0, width},
                     {gathered[middle ? 2 : 0], 2 * width, 0, width}, {out, 2 * width, 0, width});
      if (here == 0) continue;
      corrected += here;
      for (int axis = 0; axis < 3; ++axis) {
        double* p = to.col(axis).data();
        for (int i = 0; i < width; ++i) p[a[k + i]] = out[2 * axis * width + i];
        for (int i = 0; i < width; ++i) p[b[k + i]] = out[(2 * axis + 1) * width + i];
      }
    }
  }
  return corrected;
}

PlacedContacts::PlacedContacts(const ColoredEdges& edges, bool contact) {
  if (!contact) return;
  normal_ = held_ = edges.make_places();
  offset_.setZero(normal_.rows());
  push_.setZero(normal_.rows());
  blocks_.reserve(static_cast<std::size_t>(normal_.rows() / width));
}

void PlacedContacts::load(const Contacts& contacts, const ColoredEdges& edges) {
  for (const int first : blocks_) {
    for (ColoredEdges::Places* p : {&normal_, &held_}) p->middleRows<width>(first).setZero();
    for (Eigen::ArrayXd* a : {&offset_, &push_}) a->segment<width>(first).setZero();
  }
  blocks_.clear();
  for (int c = 0; c < contacts.count(); ++c) {
    const int place = edges.place(contacts.vertex(c)), first = place - place % width;
    if (normal_.middleRows<width>(first).isZero(0)) blocks_.push_back(first);
    normal_.row(place) = contacts.normal(c).transpose();
    offset_[place] = -contacts.gap(c, Eigen::Vector3d::Zero());
    push_[place] = contacts.push(c);
  }
  std::sort(blocks_.begin(), blocks_.end());
}

void PlacedContacts::store(Contacts& contacts, const ColoredEdges& edges) const {
  for (int c = 0; c < contacts.count(); ++c)
    contacts.set_push(c, push_[edges.place(contacts.vertex(c))]);
}

void PlacedContacts::settle(ColoredEdges::Places& x) {
  const std::ptrdiff_t stride = x.rows();
  for (const int first : blocks_) {
    const double* n = normal_.data() + first;
    double* at = x.data() + first;
    Contacts::visit({n, n + stride, n + 2 * stride}, offset_.data() + first, push_.data() + first,
                    {at, at + stride, at + 2 * stride});
  }
}

const ColoredEdges::Places& PlacedContacts::held_normals() {
  for (const int first : blocks_) {
    for (int axis = 0; axis < 3; ++axis) {
      held_.col(axis).segment<width>(first) =
          (push_.segment<width>(first) > 0).select(normal_.col(axis).segment<width>(first), 0);
    }
  }
  return held_;
}

}  // namespace inextensible
