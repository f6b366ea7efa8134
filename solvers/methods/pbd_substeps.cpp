// PBD with substeps, which is XPBD with small steps (Macklin et al. 2016, 2019) without compliance:
// a fixed number of passes a step, one as a rule, without a test of convergence. It promises no
// strain limit. At rest under gravity an edge keeps a strain of about g h^2 / l times the edges
// below it, for one pass carries a load by one edge, or by one color.
//
// With compliance 0 and one pass from lambda = 0 an edge's multiplier is its correction (Macklin et
// al. 2016, eq. 18), and no multiplier is read again: every edge is brought to its rest length, one
// color after the other. Loops: `sweeps` passes over edges and one over attachments a step.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <stdexcept>

#include "solvers/methods/rows.h"
#include "solvers/methods/strain_passes.h"

namespace inextensible {
namespace {

constexpr std::size_t most_attachments = 4;  // of a vertex: to the nearest pins

// Along edges, from one vertex to all (Dijkstra 1959); infinite where there is no way.
std::vector<double> distances_from(int start, const Problem& problem,
                                   const std::vector<std::vector<Neighbour>>& at) {
  std::vector<double> distance(problem.vertices(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[start] = 0;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [so_far, v] = open.top();
    open.pop();
    if (so_far > distance[v]) continue;
    for (const auto [to, edge] : at[v]) {
      const double length = so_far + problem.rest_length()[edge];
      if (length >= distance[to]) continue;
      distance[to] = length;
      open.emplace(length, to);
    }
  }
  return distance;
}

class PbdSubsteps final : public VelocityFilter {
 public:
  // The start is taken for the shape at rest, which straight attachments need. Throws
  // std::invalid_argument if they do not have it.
  PbdSubsteps(const Problem& problem, const BackendOptions& options, Along along)
      : most_(options.count("sweeps")),
        along_(along),
        passes_(StrainPasses::by_mass(problem, {0, 0}, options.number("relaxation"))) {
    const std::string& attachments = options.word("attachments");
    if (attachments == "straight" && !options.start)
      throw std::invalid_argument("straight attachments need the positions at rest");
    if (attachments != "none")
      attach(problem, attachments == "straight" ? &options.start->x : nullptr);
  }

  StepResult apply(const Positions& x_start, double /*h*/, Iterate iterate,
                   WorkCounters& work) override {
    passes_.load(iterate);
    if (along_ == Along::middle) passes_.take_middle_from(x_start);
    for (int i = 0; i < most_; ++i) work.edge_projections += passes_.in_turn();
    passes_.settle_contacts();
    if (!passes_.finite()) return {Status::not_finite, most_, -1, 0, "overflow"};
    Positions& x = iterate;
    passes_.store(x);
    for (const Attachment& a : attachments_) {
      const Eigen::Vector3d d = x.col(a.vertex) - x.col(a.pin);
      const double square = d.squaredNorm();
      if (square > a.distance * a.distance)
        x.col(a.vertex) = x.col(a.pin) + a.distance / std::sqrt(square) * d;
    }
    return {Status::ok, most_};
  }

 private:
  // Long-range attachments (Kim, Chentanez and Mueller 2012): no vertex is farther from a pinned
  // one than its rest distance, along edges, which inextensible edges imply, or straight, which
  // holds only where nothing shears. Momentum is not kept.
  struct Attachment {
    int vertex, pin;
    double distance;  // m
  };

  // Attaches each free vertex to its nearest pins: straight through the positions at rest, or, if
  // these are null, along edges.
  void attach(const Problem& problem, const Positions* rest) {
    const auto neighbours = neighbours_of(problem);
    std::vector<std::vector<Attachment>> nearest(problem.vertices());
    for (const int pin : problem.pinned()) {
      const std::vector<double> along_edges =
          rest ? std::vector<double>{} : distances_from(pin, problem, neighbours);
      for (int v = 0; v < problem.vertices(); ++v) {
        const double distance = rest ? (rest->col(v) - rest->col(pin)).norm() : along_edges[v];
        if (problem.inverse_mass()[v] == 0 || !std::isfinite(distance)) continue;
        const auto farther = std::find_if(nearest[v].begin(), nearest[v].end(),
                                          [&](auto& a) { return a.distance > distance; });
        nearest[v].insert(farther, {v, pin, distance});
        if (nearest[v].size() > most_attachments) nearest[v].pop_back();
      }
    }
    for (const auto& some : nearest)
      attachments_.insert(attachments_.end(), some.begin(), some.end());
  }

  int most_;
  Along along_;
  StrainPasses passes_;
  std::vector<Attachment> attachments_;
};

}  // namespace

Backend pbd_substeps_row() {
  return {
      .name = "pbd_substeps",
      .summary = "PBD with substeps (XPBD without compliance): a fixed number of passes, no test",
      .strain_control = StrainControl::time_step,
      .settings = {{"sweeps", 1.0, "colored Gauss-Seidel passes a step", at_least_one,
                    SearchRange{1, 100}},
                   {"relaxation", 1.0, "times a correction", relaxation_range, tunable_relaxation},
                   word_setting(
                       "attachments", "none",
                       "of vertices to pinned ones, at their rest distance along edges or straight",
                       {"none", "edges", "straight"})},
      .make_filter = make_filter<PbdSubsteps>,
      .takes_middle = true,
      .direction = Direction::local,
      .citation = "Macklin et al. 2016, 2019",
      .origin = Origin::literature,
      .label = "PBD with substeps (XPBD, compliance 0)"};
}

}  // namespace inextensible
