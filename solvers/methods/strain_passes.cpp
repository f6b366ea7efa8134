// Displacements. A step moves vertices by much less than an edge's length, so that single precision
// resolves displacements u from a base x as finely as a strain limit asks. With D and d = D + e the
// vectors of an edge at the base and displaced, and |D|^2 / l^2 - 1 from double,
//   |d|^2 / l^2 - 1 = |D|^2 / l^2 - 1 + (D + d) . e / l^2,
// in which nothing cancels: it is as exact as e. After `passes_from_a_base` the displaced positions
// become the base, so that passes converge to any limit that double precision can test.
//
// Vectors. Edges come in groups of one color, one vector to each quantity of a group. A mask keeps
// edges within the limit as they are; a group that is within it as a whole, as most are near
// convergence, is left at once.
#include "solvers/methods/strain_passes.h"

#include <bit>
#include <experimental/simd>
#include <map>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace inextensible {
namespace {

namespace simd = std::experimental;
using simd::element_aligned;
template <class Real, int count = ColoredEdges::width>
using Lanes = simd::simd<Real, simd::simd_abi::deduce_t<Real, count>>;
template <int count = ColoredEdges::width, class Real>
[[gnu::always_inline]] inline Lanes<Real, count> lanes(const Real* from) {
  return Lanes<Real, count>(from, element_aligned);
}
// A pass takes a group's edges as many at once as a register has room for.
constexpr int at_once = std::min<int>(ColoredEdges::width, simd::native_simd<float>::size());

// The ends of a group's edges: consecutive places, or any.
struct Adjacent {
  Adjacent(const int* first_a, const int* first_b) : a(*first_a), b(*first_b) {}
  template <int count, class Real>
  [[gnu::always_inline]] static Lanes<Real, count> read(const Real* from, int first) {
    return lanes<count>(from + first);
  }
  [[gnu::always_inline]] static void write(const Lanes<float, at_once>& x, float* to, int first) {
    x.copy_to(to + first, element_aligned);
  }
  int a, b;
};
struct Listed {
  template <int count, class Real>
  static Lanes<Real, count> read(const Real* from, const int* places) {
    return Lanes<Real, count>([&](int i) { return from[places[i]]; });
  }
  static void write(const Lanes<float, at_once>& x, float* to, const int* places) {
    for (int i = 0; i < at_once; ++i) to[places[i]] = x[i];
  }
  const int *a, *b;
};

// While it exists, numbers too small for full precision count as zero. Passes carry displacements
// on from edge to edge, ever smaller ones, and some processors take a hundred times as long for
// these; others have no such switch and no need of it.
class FlushSubnormals {
 public:
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;
#ifdef __SSE__
  FlushSubnormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040U); }
  ~FlushSubnormals() { _mm_setcsr(before_); }

 private:
  unsigned before_;
#else
  FlushSubnormals() = default;
#endif
};

constexpr int passes_from_a_base = 64;

// Rounding of a strain after displacements by a tenth of an edge, in q - 1; and the part of the
// band that it may take at most.
constexpr double strain_rounding = 5e-7, most_of_band = 0.01;

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
      inverse_square_(edges_.entries(), 0.0),
      groups_(edges_.entries() / width, Group{}),
      x_(Places::Zero(edges_.places(), 3)),
      u_(Displacements::Zero(edges_.places(), 3)),
      correction_(u_) {
  const double low = std::min(band.low - 1, 0.0), high = std::max(band.high - 1, 0.0);
  const double room = std::min(strain_rounding, most_of_band * high);
  const auto square = [](double target) { return target * target - 1; };
  bounds_.middle = static_cast<float>(0.5 * (low + high));
  bounds_.half = static_cast<float>(0.5 * (high - low) - room);
  bounds_.target_low = static_cast<float>(std::max(square(band.target_low), low + 2 * room));
  bounds_.target_high = static_cast<float>(std::min(square(band.target_high), high - 2 * room));
  using Key = std::array<float, sizeof(Constants) / sizeof(float)>;
  std::map<Key, int> known;
  for (int first = 0; first < edges_.entries(); first += width) {
    Constants constants{};
    for (int i = 0; i < width; ++i) {
      const int k = first + i, edge = edges_.problem_edge()[k];
      if (edge < 0) continue;
      inverse_square_[k] = 1 / (problem.rest_length()[edge] * problem.rest_length()[edge]);
      constants.inverse_square[i] = static_cast<float>(inverse_square_[k]);
      constants.share_a[i] = static_cast<float>(share_a[edge]);
      constants.share_b[i] = static_cast<float>(share_b[edge]);
      if (edges_.turned(k)) std::swap(constants.share_a[i], constants.share_b[i]);
    }
    const auto [at, is_new] = known.emplace(std::bit_cast<Key>(constants), std::ssize(constants_));
    if (is_new) constants_.push_back(constants);
    constants_of_.push_back(at->second);
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
    const std::int64_t corrected = stops ? 0 : pass(order);
    work.edge_projections += corrected;
    if (corrected > 0) {
      if (contacts_ && passes % 1024 == 1023) renew_planes(x, work);
      continue;
    }
    const bool last = stops || exact();
    store(x);
    const StepResult result = verdict(passes, stops ? "pass limit" : nullptr, edges, x);
    if (result || last) return result;
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
  u_.setZero();
  new_base();
  contacts_ = x.contacts();
  if (!contacts_) return;
  const Contacts::Timing measured = contacts_->timing();
  planes_.load(*contacts_, edges_);
}

void StrainPasses::store(Positions& x) {
  edges_.store(positions(), x);
  if (!contacts_) return;
  const Contacts::Timing measured = contacts_->timing();
  planes_.store(*contacts_, edges_);
}

void StrainPasses::new_base() {
  passes_ = 0;
  planes_measured_ = false;
}

ColoredEdges::Places& StrainPasses::positions() {
  x_ += u_.cast<double>();
  u_.setZero();
  new_base();
  return x_;
}

void StrainPasses::settle_contacts() {
  if (!contacts_) return;
  const Contacts::Timing measured = contacts_->timing();
  if (!planes_measured_) planes_.measure(x_);
  planes_measured_ = true;
  planes_.settle(u_);
}

const ColoredEdges::Places* StrainPasses::held_normals() {
  if (!contacts_ || contacts_->count() == 0) return nullptr;
  const Contacts::Timing measured = contacts_->timing();
  return &planes_.held_normals();
}

void StrainPasses::take_middle_from(const Positions& x_start) {
  start_.resize(edges_.places(), 3);
  middles_.resize(groups_.size());
  edges_.load(x_start, start_);
  new_base();
}

StrainPasses::Passed StrainPasses::in_turn(int most, WorkCounters& work) {
  Passed done{1, 0};
  while (done.passes < most && done.left > 0) {
    done.left = pass(Order::in_turn);
    work.edge_projections += done.left;
    ++done.passes;
  }
  return done;
}

std::int64_t StrainPasses::pass(Order order) {
  const FlushSubnormals flush;
  if (passes_ == passes_from_a_base) positions();
  settle_contacts();
  const bool middle = start_.rows() > 0;
  if (order == Order::in_turn)
    return middle ? pass<true, Order::in_turn>() : pass<false, Order::in_turn>();
  const std::int64_t corrected =
      middle ? pass<true, Order::at_once>() : pass<false, Order::at_once>();
  if (corrected == 0) return 0;
  u_ += correction_;
  correction_.setZero();
  return corrected;
}

// One pass, which corrects u_ itself or adds to correction_. The first from a base measures it.
template <bool middle, StrainPasses::Order order>
std::int64_t StrainPasses::pass() {
  std::int64_t corrected = 0;
  for (const ColoredEdges::Block& block : edges_.blocks())
    corrected +=
        block.adjacent ? pass<middle, order, Adjacent>(block) : pass<middle, order, Listed>(block);
  ++passes_;
  return corrected;
}

// Copies, which stores of vectors cannot change, as far as a compiler knows.
struct StrainPasses::Arrays {
  Arrays(const StrainPasses& all, Displacements& changed)
      : groups(all.groups_.data()),
        middles(all.middles_.data()),
        constants(all.constants_.data()),
        constants_of(all.constants_of_.data()),
        bounds(all.bounds_) {
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] = all.u_.col(axis).data();
      to[axis] = changed.col(axis).data();
    }
  }
  const Group* groups;
  const Middle* middles;
  const Constants* constants;
  const int* constants_of;
  Bounds bounds;
  const float* u[3];
  float* to[3];
};

template <bool middle, StrainPasses::Order order, class Ends>
std::int64_t StrainPasses::pass(const ColoredEdges::Block& block) {
  std::int64_t corrected = 0;
  const Arrays arrays(*this, order == Order::in_turn ? u_ : correction_);
  const int *a = edges_.a().data(), *b = edges_.b().data();
  const int end = block.first + block.count;
  if (passes_ == 0)
    for (int k = block.first; k < end; k += width) measure<middle>(k, Ends{a + k, b + k});
  for (int k = block.first; k < end; k += width)
    for (int first = 0; first < width; first += at_once)
      corrected += correct<middle, order>(k / width, first, Ends{a + k, b + k}, arrays);
  return corrected;
}

template <bool middle, class Ends>
[[gnu::always_inline]] inline void StrainPasses::measure(int k, const Ends& ends) {
  using simd::where, std::experimental::static_simd_cast;
  Group& group = groups_[k / width];
  const auto edge = [&](const Places& x, int axis) {
    const double* from = x.data() + axis * x.rows();
    return ends.template read<width>(from, ends.b) - ends.template read<width>(from, ends.a);
  };
  Lanes<double> square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Lanes<double> d = edge(x_, axis);
    square += d * d;
    static_simd_cast<float>(d).copy_to(group.d[axis], element_aligned);
    if constexpr (middle) {
      const Lanes<double> m = 0.5 * (edge(start_, axis) + d);
      static_simd_cast<float>(m).copy_to(middles_[k / width].m[axis], element_aligned);
    }
  }
  const Lanes<double> strain = square * lanes(&inverse_square_[k]) - 1;
  static_simd_cast<float>(strain).copy_to(group.strain, element_aligned);
}

// Adds to the ends what corrects the group's edges from `first` on; no place occurs twice.
// `middle`: along the edges in the middle of the step.
template <bool middle, StrainPasses::Order order, class Ends>
[[gnu::always_inline]] inline int StrainPasses::correct(int k, int first, const Ends& ends,
                                                        const Arrays& arrays) {
  using simd::where;
  using Some = Lanes<float, at_once>;
  const auto some = [first](const float* from) { return lanes<at_once>(from + first); };
  const auto a = ends.a + first, b = ends.b + first;
  const Bounds& bounds = arrays.bounds;
  const Group& group = arrays.groups[k];
  const Constants& constants = arrays.constants[arrays.constants_of[k]];
  Some at_a[3], at_b[3], e[3], d[3];
  Some growth = 0;
  const Some scale = some(constants.inverse_square);
  for (int axis = 0; axis < 3; ++axis) {
    const float* u = arrays.u[axis];
    const Some base = some(group.d[axis]);
    at_a[axis] = ends.template read<at_once>(u, a);
    at_b[axis] = ends.template read<at_once>(u, b);
    e[axis] = at_b[axis] - at_a[axis];
    d[axis] = base + e[axis];
    growth += (base + d[axis]) * e[axis];
  }
  const Some strain = some(group.strain) + growth * scale;
  const Some off = strain - bounds.middle;
  // What is no edge, or has no length and so no direction, is within the limit.
  const auto violated = abs(off) > bounds.half && strain != -1;
  const int violations = popcount(violated);
  if (violations == 0) return 0;
  Some strained = strain - bounds.target_high;
  where(off < 0, strained) = strain - bounds.target_low;
  Some q = 0;
  for (int axis = 0; axis < 3; ++axis) q += d[axis] * d[axis];
  Some along = q, square = q;
  if constexpr (middle) {
    Some m[3];
    Some p = 0, r = 0;
    for (int axis = 0; axis < 3; ++axis) {
      m[axis] = some(arrays.middles[k].m[axis]) + 0.5F * e[axis];
      p += d[axis] * m[axis];
      r += m[axis] * m[axis];
    }
    const auto aligned = p > static_cast<float>(least_alignment) * q;
    where(aligned, along) = p;
    where(aligned, square) = r;
    for (int axis = 0; axis < 3; ++axis) where(aligned, d[axis]) = m[axis];
  }
  Some s = excess_along(strained, Some(along * scale), Some(square * scale));
  where(!violated, s) = 0;
  const Some sa = some(constants.share_a) * s, sb = some(constants.share_b) * s;
  for (int axis = 0; axis < 3; ++axis) {
    float* to = arrays.to[axis];
    if constexpr (order == Order::at_once) {
      at_a[axis] = ends.template read<at_once>(to, a);
      at_b[axis] = ends.template read<at_once>(to, b);
    }
    ends.write(at_a[axis] + sa * d[axis], to, a);
    ends.write(at_b[axis] - sb * d[axis], to, b);
  }
  return violations;
}

PlacedContacts::PlacedContacts(const ColoredEdges& edges, bool contact) {
  if (!contact) return;
  normal_.setZero(edges.places(), 3);
  held_ = normal_;
  offset_.setZero(edges.places());
  block_of_.assign(static_cast<std::size_t>(edges.places() / width), -1);
  blocks_.reserve(block_of_.size());
}

void PlacedContacts::load(const Contacts& contacts, const ColoredEdges& edges) {
  for (const Block& block : blocks_) {
    normal_.middleRows<width>(block.first).setZero();
    held_.middleRows<width>(block.first).setZero();
    offset_.segment<width>(block.first).setZero();
    block_of_[block.first / width] = -1;
  }
  blocks_.clear();
  for (int c = 0; c < contacts.count(); ++c) block_of_[edges.place(contacts.vertex(c)) / width] = 0;
  for (std::size_t i = 0; i < block_of_.size(); ++i) {
    if (block_of_[i] < 0) continue;
    block_of_[i] = static_cast<int>(std::ssize(blocks_));
    blocks_.emplace_back().first = static_cast<int>(i) * width;
  }
  for (int c = 0; c < contacts.count(); ++c) {
    const int place = edges.place(contacts.vertex(c)), i = place % width;
    const Eigen::Vector3d& normal = contacts.normal(c);
    Block& block = blocks_[block_of_[place / width]];
    for (int axis = 0; axis < 3; ++axis) {
      normal_(place, axis) = normal[axis];
      block.normal[axis][i] = static_cast<float>(normal[axis]);
    }
    offset_[place] = -contacts.gap(c, Eigen::Vector3d::Zero());
    block.push[i] = static_cast<float>(contacts.push(c));
  }
}

void PlacedContacts::store(Contacts& contacts, const ColoredEdges& edges) const {
  for (int c = 0; c < contacts.count(); ++c) {
    const int place = edges.place(contacts.vertex(c));
    contacts.set_push(c, blocks_[block_of_[place / width]].push[place % width]);
  }
}

void PlacedContacts::measure(const ColoredEdges::Places& base) {
  for (Block& block : blocks_) {
    Lanes<double> depth = lanes(&offset_[block.first]);
    for (int axis = 0; axis < 3; ++axis)
      depth -= lanes(&normal_(block.first, axis)) * lanes(&base(block.first, axis));
    std::experimental::static_simd_cast<float>(depth).copy_to(block.depth, element_aligned);
  }
}

void PlacedContacts::settle(ColoredEdges::Displacements& u) {
  using Some = Lanes<float, at_once>;
  float* const to[3] = {u.col(0).data(), u.col(1).data(), u.col(2).data()};
  for (Block& block : blocks_)
    for (int first = 0; first < width; first += at_once) {
      const auto some = [first](const float* from) { return lanes<at_once>(from + first); };
      Some at[3], normal[3];
      Some gap = -some(block.depth);
      for (int axis = 0; axis < 3; ++axis) {
        at[axis] = some(to[axis] + block.first);
        normal[axis] = some(block.normal[axis]);
        gap += normal[axis] * at[axis];
      }
      Some push = some(block.push);
      const Some more = Contacts::visit(gap, push);
      push.copy_to(block.push + first, element_aligned);
      for (int axis = 0; axis < 3; ++axis)
        (at[axis] + more * normal[axis]).copy_to(to[axis] + block.first + first, element_aligned);
    }
}

const ColoredEdges::Places& PlacedContacts::held_normals() {
  for (const Block& block : blocks_) {
    const auto holds = Eigen::Map<const Eigen::Array<float, width, 1>>(block.push) > 0;
    for (int axis = 0; axis < 3; ++axis)
      held_.col(axis).segment<width>(block.first) =
          holds.select(normal_.col(axis).segment<width>(block.first), 0);
  }
  return held_;
}

}  // namespace inextensible
