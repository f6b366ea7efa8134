// Contact and friction of single vertices against their definitions.
#include "solvers/problem/contacts.h"

#include "support/motion.h"

namespace inextensible {
namespace {

using Eigen::Vector3d, testing::Ground, testing::Random, testing::random_vector, testing::uniform;

// Points that fell through a ground: n of them, where they began, and where they would be.
struct Fallen {
  Fallen(Random& random, int n, double friction)
      : ground(std::make_shared<const Ground>(random_vector(random, 1), uniform(random, -1, 1),
                                              friction)),
        problem(testing::points(n, ground)),
        start(3, n),
        candidate(3, n),
        contacts(problem) {
    for (int v = 0; v < n; ++v) {
      start.col(v) = random_vector(random, 1);
      candidate.col(v) = start.col(v) + random_vector(random, 1);
    }
    contacts.begin(start, 0, 0.01);
    found = contacts.find(candidate, work);
  }

  std::shared_ptr<const Ground> ground;
  Problem problem;
  Positions start, candidate;
  WorkCounters work;
  Contacts contacts;
  int found;
};

// Without edges the expected way is the candidate's.
TEST(Contacts, FrictionTakesFromTheWayWhatCoulombGrants) {
  testing::for_seeds(30, [&](testing::Random& random, std::uint64_t) {
    const double mu = uniform(random, 0.1, 1);
    Fallen fallen(random, 20, mu);
    Contacts contacts(fallen.problem);
    contacts.begin(fallen.start, 0, 0.01);
    Positions x = fallen.candidate;
    contacts.apply_friction(x, fallen.work);
    for (int v = 0; v < 20; ++v) {
      const Vector3d n = fallen.ground->normal, way = fallen.candidate.col(v) - fallen.start.col(v);
      const Vector3d slide = way - n.dot(way) * n;
      const double depth = fallen.ground->offset - n.dot(fallen.candidate.col(v));
      // Sticks, or slides on the way that it was going, by what friction leaves of it.
      const double left = depth > 0 ? std::max(0.0, slide.norm() - mu * depth) : slide.norm();
      const Vector3d moved = x.col(v) - fallen.start.col(v), slid = moved - n.dot(moved) * n;
      EXPECT_NEAR((slid - left * slide.normalized()).norm(), 0, 1e-14);
      // A plane's push comes later.
      EXPECT_NEAR(n.dot(x.col(v) - fallen.candidate.col(v)), 0, 1e-14);
    }
  });
}

// What edges have done twice in the same direction is expected of them, and held by friction before
// they do it again; what they did once is not.
TEST(Contacts, FrictionHoldsWhatEdgesPullSteadily) {
  const auto ground = std::make_shared<const Ground>(Vector3d(0, 1, 0), 0, 0.5);
  const Problem problem = testing::points(1, ground);
  Contacts contacts(problem);
  WorkCounters work;
  constexpr double h = 0.01, fall = 1e-3, pull = 2e-4;  // m a step, below mu fall
  const Positions start = Positions::Zero(3, 1);
  double slid = 0;
  for (int step = 0; step < 4; ++step) {
    contacts.begin(start, step * h, h);
    Positions x = start;
    x(1, 0) -= fall;
    contacts.apply_friction(x, work);
    contacts.settle(x);
    x(0, 0) += pull;  // the edges
    slid = x(0, 0);
    contacts.accept(x);
    EXPECT_NEAR(slid, step < 2 ? pull : 0, 1e-15);
  }
}

// What pushes and pulls later counts as if it had at once: however the way there was divided, a
// vertex is on its plane if it would be behind it, and where it would be without one otherwise.
TEST(Contacts, SettlePushesWhatIsInsideOntoItsPlane) {
  testing::for_seeds(30, [&](testing::Random& random, std::uint64_t seed) {
    const int n = 1 + static_cast<int>(seed);  // whole lanes and parts of one
    Fallen fallen(random, n, 0.5);
    Contacts& contacts = fallen.contacts;
    EXPECT_EQ(contacts.count(), fallen.found);
    EXPECT_EQ(fallen.work.contacts, fallen.found);
    Positions x = fallen.candidate, free = x;
    for (int visit = 0; visit < 10; ++visit) {
      contacts.settle(x);
      Positions expected = free;
      for (int c = 0; c < contacts.count(); ++c) {
        const int v = contacts.vertex(c);
        const double depth = -contacts.gap(c, free.col(v));
        EXPECT_TRUE(depth > 0 || visit > 0);
        EXPECT_EQ(contacts.holds(c), depth > 0);
        if (depth > 0) expected.col(v) += depth * contacts.normal(c);
      }
      EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-13);
      if (visit == 0) {
        EXPECT_EQ(contacts.find(x, fallen.work), 0);
        continue;  // settled twice
      }
      const Positions pull = 0.3 * testing::random_matrix(random, 3, n);
      x += pull;
      free += pull;
    }
  });
}

TEST(Contacts, RestoreTakesUpWhatWasSavedAndBeginForgets) {
  Random random(3);
  Fallen fallen(random, 20, 0.3);
  Contacts& contacts = fallen.contacts;
  Positions x = fallen.candidate;
  contacts.settle(x);
  const Positions saved = x;
  const int known = contacts.count();
  Contacts::Record record;
  contacts.save(record);
  const auto pulled = [&] {
    Positions y = saved;
    y.array() += 0.1;
    contacts.settle(y);
    return y;
  };
  const Positions first = pulled();
  Positions deep = saved - 10 * fallen.ground->normal.replicate(1, 20);
  EXPECT_EQ(contacts.find(deep, fallen.work), 20);
  EXPECT_EQ(contacts.count(), 20);
  contacts.restore(record);
  EXPECT_EQ(contacts.count(), known);  // those found since are forgotten
  EXPECT_EQ(pulled(), first);
  EXPECT_EQ(contacts.find(deep, fallen.work), 20);
  contacts.begin(fallen.start, 0, 0.01);
  EXPECT_EQ(contacts.count(), 0);
  Positions untouched = fallen.candidate;
  contacts.settle(untouched);
  EXPECT_EQ(untouched, fallen.candidate);
  EXPECT_EQ(contacts.find(untouched, fallen.work), fallen.found);
}

}  // namespace
}  // namespace inextensible
