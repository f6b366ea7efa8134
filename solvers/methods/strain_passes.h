// Passes of strain corrections over colored edges, for jacobi, gauss_seidel_colored, pbd_substeps
// and the projections with passes: in single precision, on displacements from a base in double.
#pragma once

#include <cstdint>

#include "solvers/methods/colored_edges.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

// Which edges are corrected, and what to, in q = |d|^2 / l^2 and |d| / l.
struct StrainBand {
  // target: of the strain limit, 0 to 1. The band is a few roundings narrower than what is
  // permissible, so that none comes between a pass that corrects nothing and the check.
  StrainBand(double strain_limit, double target);

  bool violated(double q) const {  // true on NaN
    return static_cast<int>(q < low) | static_cast<int>(!(q <= high));
  }

  double low, high;
  double target_low, target_high;
};

// The s of |d - s m| = wanted, by the form that does not cancel: strained = |d|^2 - wanted^2,
// along = d . m and square = |m|^2, m an edge in the middle of the step, all over its rest length.
template <class Real>
[[gnu::always_inline]] inline Real excess_along(Real strained, Real along, Real square) {
  using std::sqrt;
  return strained / (along + sqrt(positive_part(along * along - square * strained)));
}

// The planes of a step's contacts, side by side with the places of colored edges: passes settle
// them in vectors, without looking up a vertex. Elsewhere the normal is 0, which moves nothing.
class PlacedContacts {
 public:
  // contact: whether there may be contacts at all; else nothing is allocated.
  PlacedContacts(const ColoredEdges& edges, bool contact);

  // Reads the planes and pushes of `contacts`, needed again whenever those have changed.
  void load(const Contacts& contacts, const ColoredEdges& edges);
  void store(Contacts& contacts, const ColoredEdges& edges) const;  // the pushes
  void measure(const ColoredEdges::Places& base);  // displacements are counted from here on
  void settle(ColoredEdges::Displacements& u);     // Contacts::settle(), at base + u
  const ColoredEdges::Places& held_normals();      // as StrainPasses::held_normals()

 private:
  static constexpr int width = ColoredEdges::width;  // places that are settled side by side

  struct Block {
    int first;  // place
    alignas(64) float normal[3][width];
    float depth[width];  // of the base below its plane, m
    float push[width];
  };

  std::vector<Block> blocks_;  // those that have a contact
  std::vector<int> block_of_;  // in blocks_, of each `width` places; -1: none
  ColoredEdges::Places normal_, held_;
  Eigen::ArrayXd offset_;
};

class StrainPasses {
 public:
  // A correction moves the ends of edge k by share_a[k] and share_b[k] of its way to the target.
  StrainPasses(const Problem& problem, const StrainBand& band, const std::vector<double>& share_a,
               const std::vector<double>& share_b);

  // The shares of Gauss-Seidel: by inverse mass, times `relaxation`.
  static StrainPasses by_mass(const Problem& problem, const StrainBand& band, double relaxation);

  // Positions (3 x n) in and out, and contacts with them. store() leaves pinned vertices alone.
  // Contacts of x are settled before each pass from now on, so that they hold wherever a pass finds
  // nothing to correct.
  void load(Iterate x);
  void store(Positions& x);
  // From now on corrections point along the edges as they are in the middle of the step from
  // x_start (3 x n) to where they are. Until the first call they point along the edges as they are.
  void take_middle_from(const Positions& x_start);
  bool finite() const { return u_.allFinite() && x_.allFinite(); }
  ColoredEdges::Places& positions();  // to be read and moved before the next pass
  const ColoredEdges& edges() const { return edges_; }
  // Whether the last pass saw strains from double, unless it has corrected some: where it found
  // nothing, neither will another one from the positions as stored.
  bool exact() const { return passes_ <= 1; }
  void settle_contacts();  // at positions()
  // Normals of planes that hold their vertex, by place, zero elsewhere; null: no contacts.
  const ColoredEdges::Places* held_normals();

  // One pass; returns how many edges it corrected. One of no length has no direction and is none.
  enum class Order {
    in_turn,  // in the order of edges(), each from where the last one left its ends
    at_once   // all from the same positions; the corrections are summed
  };
  std::int64_t pass(Order order);
  // Passes in turn until one corrects nothing, at most `most` of them, all counted; `left`: what
  // the last one corrected, 1 if there was none.
  struct Passed {
    std::int64_t left;
    int passes;
  };
  Passed in_turn(int most, WorkCounters& work);

  // Passes until one finds nothing to correct, at most `most_passes`; the last one, which is the
  // test of convergence, is not counted. Refuses x if an edge (of `edges`, in any order) is still
  // beyond its limit.
  StepResult limit(Order order, int most_passes, const EdgeConstraints& edges, Iterate x,
                   WorkCounters& work);
  // Whether to stop after this many passes: at most `most`, fewer where positions overflow.
  bool gives_up(int passes, int most) const {
    return passes == most || (passes % 64 == 63 && !finite());
  }
  // Ok if x, as stored, is within the limit. `limit`: why passes were given up; null: nothing was
  // left to correct.
  static StepResult verdict(int passes, const char* limit, const EdgeConstraints& edges,
                            const Positions& x);

 private:
  static constexpr int width = ColoredEdges::width;

  // Edges of one color side by side, at the base.
  struct Group {
    alignas(64) float d[3][width];  // m
    float strain[width];            // |d|^2 / l^2 - 1
  };
  struct Middle {                   // of a group
    alignas(64) float m[3][width];  // (d at the base + d at the start of the step) / 2
  };
  // What groups of equal edges have in common, so that less is read in a pass.
  struct Constants {
    alignas(64) float inverse_square[width];  // 1 / l^2; 0: no edge
    float share_a[width], share_b[width];
  };
  struct Bounds {        // of q - 1
    float middle, half;  // of the band
    float target_low, target_high;
  };
  using Places = ColoredEdges::Places;
  using Displacements = ColoredEdges::Displacements;

  void renew_planes(Iterate x, WorkCounters& work);
  void new_base();
  template <bool middle, Order order>
  std::int64_t pass();
  template <bool middle, Order order, class Ends>
  std::int64_t pass(const ColoredEdges::Block& block);
  template <bool middle, class Ends>
  void measure(int k, const Ends& ends);
  struct Arrays;  // what a pass reads and moves
  template <bool middle, Order order, class Ends>
  static int correct(int k, int first, const Ends& ends, const Arrays& arrays);

  Contacts* contacts_ = nullptr;
  ColoredEdges edges_;
  PlacedContacts planes_;  // of contacts_
  Bounds bounds_;
  std::vector<double> inverse_square_;  // by entry
  std::vector<Group> groups_;
  std::vector<Middle> middles_;  // empty: not asked for
  std::vector<Constants> constants_;
  std::vector<int> constants_of_;  // a group
  Places x_;                       // the base
  Places start_;                   // of the step; empty: middles are not asked for
  Displacements u_, correction_;
  int passes_ = 0;                // from this base
  bool planes_measured_ = false;  // at this base
};

}  // namespace inextensible
