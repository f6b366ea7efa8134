#include "solvers/stepping/bdf2_history.h"

namespace inextensible {
namespace {

constexpr double largest_growth = 2;  // the formula is stable below 1 + sqrt 2

}  // namespace

Bdf2History::Bdf2History(const Problem& problem) : problem_(problem) {
  for (Positions* p : {&x_, &v_, &x_known_, &v_known_}) p->resize(3, problem.vertices());
}

bool Bdf2History::leads_to(const State& state, double h) {
  if (problem_.pins_follow_body())
    for (const int vertex : problem_.pinned()) x_known_.col(vertex) = state.x.col(vertex);
  return h_ > 0 && h <= largest_growth * h_ && state.x == x_known_ && state.v == v_known_;
}

void Bdf2History::restart(const State& state, double h, const Positions& acceleration) {
  x_ = state.x - h * state.v + (0.5 * h * h) * acceleration;
  v_ = state.v - h * acceleration;
  h_ = h;
  ++restarts_;
}

Bdf2Coefficients Bdf2History::coefficients(double h) const {
  const double w = h / h_, alpha = (1 + w) * (1 + w) / (1 + 2 * w);
  return {alpha, 1 - alpha, h * (1 + w) / (1 + 2 * w)};
}

void Bdf2History::add_step(const State& start, double h, const Positions& x,
                           const Positions& acceleration, const Contacts* contacts, Positions& v) {
  x_ = start.x;
  v_ = start.v;
  for (int contact = 0; contacts && contact < contacts->count(); ++contact) {
    if (!contacts->holds(contact)) continue;
    const int i = contacts->vertex(contact);
    v.col(i) = (x.col(i) - start.x.col(i)) / h;
    x_.col(i) = x.col(i) - h * v.col(i) + (0.5 * h * h) * acceleration.col(i);
    v_.col(i) = v.col(i) - h * acceleration.col(i);
  }
  for (const int vertex : problem_.pinned()) v.col(vertex).setZero();
  x_known_ = x;
  v_known_ = v;
  h_ = h;
}

}  // namespace inextensible
