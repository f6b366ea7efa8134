// What contacts do to the systems of projections, against dense algebra.
#include "support/contact.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "solvers/systems/contact_terms.h"
#include "solvers/systems/schur_complement.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using testing::Ground;
using testing::Random;
using testing::uniform;

// Cloth, some of it pressed into a ground.
struct Pressed {
  explicit Pressed(std::uint64_t seed, double friction = 0.4)
      : random(seed),
        mesh(testing::random_mesh(
            random, 4, 5, 2,
            std::make_shared<const Ground>(Eigen::Vector3d(0.3, 1, 0.2), 1, friction))),
        x(testing::perturbed(random, mesh, 0.2)),
        contacts(*mesh.problem) {
    contacts.begin(mesh.x, 0, 0.01);
    contacts.find(x, work);
  }

  Random random;
  testing::RandomMesh mesh;
  Positions x;
  WorkCounters work;
  Contacts contacts;
};

// J (3 n columns) with gradients u.
Eigen::MatrixXd jacobian(const EdgeConstraints& edges, int n, const Eigen::Matrix3Xd& u) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(edges.count(), 3 * n);
  for (int k = 0; k < edges.count(); ++k) {
    const auto e = static_cast<std::size_t>(k);
    j.block<1, 3>(k, 3 * edges.a[e]) = -u.col(k).transpose();
    j.block<1, 3>(k, 3 * edges.b[e]) = u.col(k).transpose();
  }
  return j;
}

// W, with (I - n n^T) where a plane holds a vertex.
Eigen::MatrixXd mobility(const Problem& problem, const Contacts& contacts) {
  const int n = problem.vertices();
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int v = 0; v < n; ++v) {
    w.block<3, 3>(3 * v, 3 * v) =
        problem.inverse_mass()[static_cast<std::size_t>(v)] * Eigen::Matrix3d::Identity();
  }
  for (int c = 0; c < contacts.count(); ++c) {
    const int v = contacts.vertex(c);
    const Eigen::Vector3d normal = contacts.normal(c);
    if (contacts.holds(c))
      w.block<3, 3>(3 * v, 3 * v) *= Eigen::Matrix3d::Identity() - normal * normal.transpose();
  }
  return w;
}

TEST(ContactTerms, MakeTheMatrixOfVerticesThatMoveWithinTheirPlanes) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Pressed cloth(seed);
    const Problem& problem = *cloth.mesh.problem;
    const int n = problem.vertices();
    Positions x = cloth.x;
    cloth.contacts.settle(x);
    for (int v = 0; v < n; v += 2) x(1, v) += 0.5;  // some are let go of
    cloth.contacts.settle(x);
    int held = 0;
    for (int c = 0; c < cloth.contacts.count(); ++c) held += cloth.contacts.holds(c);
    ASSERT_GT(held, 0);

    const EdgeConstraints edges(problem, 0.01);
    Eigen::Matrix3Xd u(3, edges.count()), u_start(3, edges.count());
    edges.gradient(x, u);
    edges.gradient(cloth.mesh.x, u_start);
    const Eigen::MatrixXd w = mobility(problem, cloth.contacts);
    const Eigen::MatrixXd j = jacobian(edges, n, u), j_start = jacobian(edges, n, u_start);

    for (const auto triangle :
         {SymmetricPattern::Triangle::lower, SymmetricPattern::Triangle::upper}) {
      const SchurComplement schur(edges, n, triangle);
      const SymmetricPattern& pattern = schur.pattern();
      std::vector<double> values(static_cast<std::size_t>(pattern.entries()));
      schur.assemble(u, values.data());
      ContactTerms(edges, n, pattern.column_start, pattern.row_index)
          .subtract(cloth.contacts, problem.inverse_mass().data(), u, u, values.data());
      const Eigen::MatrixXd dense = j * w * j.transpose();
      for (int l = 0; l < pattern.n; ++l) {
        for (int i = pattern.column_start[static_cast<std::size_t>(l)];
             i < pattern.column_start[static_cast<std::size_t>(l) + 1]; ++i) {
          EXPECT_NEAR(values[static_cast<std::size_t>(i)],
                      dense(pattern.row_index[static_cast<std::size_t>(i)], l), 1e-12);
        }
      }
    }
    const UnsymmetricSchurComplement whole(edges, n);
    std::vector<double> values(whole.row_index.size());
    whole.assemble(u, u_start, values.data());
    ContactTerms(edges, n, whole.column_start, whole.row_index)
        .subtract(cloth.contacts, problem.inverse_mass().data(), u, u_start, values.data());
    const Eigen::MatrixXd dense = j * w * j_start.transpose();
    for (int l = 0; l < edges.count(); ++l) {
      for (int i = whole.column_start[static_cast<std::size_t>(l)];
           i < whole.column_start[static_cast<std::size_t>(l) + 1]; ++i) {
        EXPECT_NEAR(values[static_cast<std::size_t>(i)],
                    dense(whole.row_index[static_cast<std::size_t>(i)], l), 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace inextensible
