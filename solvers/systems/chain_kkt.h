// The saddle-point matrix of ICD's Newton step on chains, by block elimination along each chain.
//
// A block is a vertex and the multiplier of the edge to the next one, (x_i, lambda_i): K is block
// tridiagonal with blocks of 4 x 4, and what a block takes from the next one is 3 x 3.
#pragma once

#include "solvers/systems/kkt_system.h"

namespace inextensible {

namespace chain {
struct ChainBlock;
}

class ChainKkt final : public KktSolver {
 public:
  // Throws std::invalid_argument unless fits(problem).
  ChainKkt(const Problem& problem, const EdgeConstraints& edges);
  ~ChainKkt() override;

  // Whether each edge joins a vertex to the next one, none twice, and no pins hold vertices between
  // them: their chain would have a multiplier more than vertices.
  static bool fits(const Problem& problem);

  // A matrix that elimination in this order cannot take is left to UMFPACK.
  bool factor(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu, const Contacts* contacts,
              bool convex, WorkCounters& work) override;
  bool solve(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
             WorkCounters& work) override;
  double reciprocal_condition() const override;

 private:
  // A free vertex, in elimination order: towards the pin where there is one.
  struct Link {
    int vertex;
    int edge;        // to the next vertex; -1 at the end of a chain
    bool turned;     // the vertex is the edge's a
    bool next_free;  // the next vertex is the next link's
    double mass;     // over the mean mass
  };

  void add_run(const Problem& problem, const std::vector<int>& edge_after, int begin, int end);
  bool eliminate(const Eigen::Matrix3Xd& u);
  void substitute(Positions& p, Eigen::VectorXd& q) const;
  double subtract_product(const Positions& p, const Eigen::VectorXd& q);
  bool leave_to_umfpack(WorkCounters& work);

  const Problem& problem_;
  const EdgeConstraints& edges_;
  std::vector<Link> links_;
  std::vector<chain::ChainBlock> blocks_;  // the factor, one a link
  int negative_pivots_ = 0;
  double smallest_pivot_ = 1, largest_pivot_ = 1;
  const Eigen::Matrix3Xd* u_ = nullptr;  // of the last factor(), as is mu_
  const Eigen::VectorXd* mu_ = nullptr;
  Eigen::VectorXd curvature_;  // of each edge in H
  Positions r_, correction_p_;
  Eigen::VectorXd c_, correction_q_;
  bool left_to_umfpack_ = false;
  std::unique_ptr<KktSystem> umfpack_;  // made when first needed
};

}  // namespace inextensible
