// The yarns of woven cloth, each projected as a whole.
#pragma once

#include "solvers/methods/strain_passes.h"

namespace inextensible {

// Edges of the problem in a row, each sharing a vertex with the next; no vertex comes twice.
struct Yarn {
  std::vector<int> vertices;  // one more than edges
  std::vector<int> edges;
  int color;  // yarns of one color share no vertex
};

// The yarns of the problem, found from its edges alone. Every edge is in one. Longest first within
// a color; colors from 0 on, the one with most edges first.
std::vector<Yarn> yarns_of(const Problem& problem);

class YarnPass {
 public:
  // Links strained beyond `target` of the limit are brought to it, in a yarn that has one beyond
  // the limit. `places` outlive this: where vertices are in the positions of project().
  YarnPass(const Problem& problem, double strain_limit, double target, const ColoredEdges& places);

  // One step of Newton's method for every yarn, color after color. Returns how many links were
  // beyond the limit; one without length counts as none. normals: of planes that hold the vertices
  // of places, or zero; the equations are those of vertices that move within their planes only, and
  // the caller settles contacts afterwards. null: there are none.
  std::int64_t project(ColoredEdges::Places& x, const ColoredEdges::Places* normals,
                       WorkCounters& work);

  // From now on corrections act along links as they are in the middle of the step from x_start (3 x
  // n), but for those turned by more than 90 degrees. A pass then is Newton's method with J(m) W
  // J(m)^T for J(x_j) W J(m)^T. Until the first call they act along the links as they are.
  void take_middle_from(const Positions& x_start);

  bool crossing() const { return crossing_; }  // whether yarns share vertices

 private:
  static constexpr int lanes = 8;
  // Yarns of one color side by side, one a lane; shorter ones are padded with null links. A yarn
  // alone is `joined` in its middle: two lanes lead there from its ends.
  struct Bundle {
    int links, first, used;  // first: row of vertices and links in the arrays below; used: lanes
    bool joined;
  };
  void add_bundle(const Problem& problem, std::span<const Yarn> yarns, bool joined);
  struct View;  // of a bundle and the positions
  template <int used, bool contact, bool middle>
  std::int64_t project(const View& yarns, WorkCounters& work);
  template <int used, bool middle>
  void linearize(const View& yarns, double (&violated)[lanes]);
  template <int used, bool contact>
  void eliminate(const View& yarns, const double (&solved)[lanes]);
  template <bool contact>
  void join(const View& halves);
  template <int used>
  void substitute(const View& yarns) const;

  StrainBand band_;
  double target_low_, target_high_;  // of q - 1 = |d|^2 / l^2 - 1
  bool crossing_ = false;
  std::vector<Bundle> bundles_;
  // Rows of `lanes` numbers. Of vertices: place, inverse mass; of the link to the next vertex: rest
  // length and its inverse (0: no link).
  std::vector<int> place_;
  std::vector<double> inverse_mass_, rest_, inverse_rest_;
  struct Row {
    alignas(64) double g[3][lanes];  // d / l of a link, or that of the middle of the step
    alignas(64) double off[lanes];   // coupling with the link before
    alignas(64) double inverse_pivot[lanes];
    alignas(64) double c[lanes];      // right-hand side, then the multiplier
    alignas(64) double along[lanes];  // g along the normal at the link's end; with contacts only
  };
  std::vector<Row> rows_;  // the first is zero: no link comes before
  // d / l at the start of the step, x, y and z of a row of links; empty: not asked for.
  std::vector<double> start_g_;
  const ColoredEdges& places_;
};

}  // namespace inextensible
