// The edges of a problem in colors: edges of one color share no vertex, so that they can be
// corrected side by side. Vertices get new places, such that the ends of consecutive edges are
// consecutive too wherever the mesh is as regular as woven cloth, and are gathered elsewhere.
#pragma once

#include <set>
#include <span>

#include "solvers/problem/problem.h"

namespace inextensible {

// The colors that are taken at each place.
class Palette {
 public:
  explicit Palette(std::size_t places) : taken_(places) {}
  // The first color that is free at all of these places; takes it there.
  int take(std::span<const int> places);

 private:
  std::vector<std::set<int>> taken_;
};

class ColoredEdges {
 public:
  explicit ColoredEdges(const Problem& problem);

  // Blocks are whole groups of this many entries, filled up with entries that are not edges: their
  // ends are places that no edge of the block has, problem_edge() is -1.
  static constexpr int width = 16;

  // Entries first ... first + count - 1, all of one color. If `adjacent`, entry first + i joins the
  // places a()[first] + i and b()[first] + i, and no place occurs twice.
  struct Block {
    int first, count, color;
    bool adjacent;
  };
  const std::vector<Block>& blocks() const { return blocks_; }  // by ascending color

  int entries() const { return static_cast<int>(a_.size()); }
  const std::vector<int>& a() const { return a_; }  // places of both ends of each entry
  const std::vector<int>& b() const { return b_; }
  const std::vector<int>& problem_edge() const { return problem_edge_; }
  // Whether a() is the place of the problem's b.
  bool turned(int entry) const { return turned_[entry]; }
  int vertex(int place) const { return vertex_[place]; }
  int place(int vertex) const { return place_[vertex]; }

  // Positions by place: x, y and z apart. Places without a vertex copy vertex 0, so that they are
  // finite where it is. store() leaves pinned vertices alone.
  using Places = Eigen::MatrixX3d;
  using Displacements = Eigen::MatrixX3f;  // of places, m
  Eigen::Index places() const { return static_cast<Eigen::Index>(vertex_.size()); }
  void load(const Positions& x, Places& places) const;
  void store(const Places& places, Positions& x) const;

 private:
  struct Link;
  void number_vertices(const Problem& problem);
  std::vector<Link> links_by_kind(const Problem& problem) const;
  void color(std::vector<Link>& links) const;
  void make_blocks(std::vector<Link>& links);
  void add_entry(int a, int b, int edge, bool turned);
  void add_run(std::span<const Link> links);
  void add_list(std::span<const Link> links);

  int lane_ = 0;             // places from one lane to the next
  std::vector<int> vertex_;  // at a place, 0 where there is none
  std::vector<int> place_;   // of a vertex
  std::vector<int> moving_;  // vertices that are not pinned
  std::vector<Block> blocks_;
  std::vector<int> a_, b_, problem_edge_;
  std::vector<bool> turned_;
};

}  // namespace inextensible
