#include "solvers/systems/active_contacts.h"

#include <algorithm>

namespace inextensible {

ActiveContacts::ActiveContacts(const Problem& problem) {
  if (!problem.contact_inside()) return;
  free_.resize(3, problem.vertices());
  reaction_.resize(problem.vertices());
}

void ActiveContacts::begin(Iterate x0) {
  contacts_ = x0.contact_count() > 0 ? x0.contacts() : nullptr;
  if (contacts_) x0.without_pushes(free_);
}

void ActiveContacts::write_candidate(Positions& x) const {
  if (!contacts_) return;
  x = free_;
  hold(x);
}

void ActiveContacts::hold(Positions& x) const {
  if (!contacts_) return;
  const Contacts::Timing measured = contacts_->timing();
  for (int c = 0; c < contacts_->count(); ++c) {
    auto at = x.col(contacts_->vertex(c));
    if (contacts_->holds(c)) at -= contacts_->gap(c, at) * contacts_->normal(c);
  }
}

void ActiveContacts::take_reactions(const Eigen::VectorXd& mass, Positions& f) {
  if (!contacts_) return;
  for (int c = 0; c < contacts_->count(); ++c) {
    const int vertex = contacts_->vertex(c);
    const Eigen::Vector3d normal = contacts_->normal(c);
    const double reaction = contacts_->holds(c) ? normal.dot(f.col(vertex)) : 0;
    reaction_[c] = reaction / mass[vertex];
    f.col(vertex) -= reaction * normal;
  }
}

bool ActiveContacts::update(const Positions& x) {
  if (!contacts_) return false;
  const Contacts::Timing measured = contacts_->timing();
  bool changed = false;
  for (int c = 0; c < contacts_->count(); ++c) {
    const int vertex = contacts_->vertex(c);
    if (contacts_->holds(c)) {
      const double push = reaction_[c] - contacts_->gap(c, free_.col(vertex));
      contacts_->set_push(c, std::max(push, 0.0));
      changed |= push < 0;
    } else if (const double gap = contacts_->gap(c, x.col(vertex)); gap < -contacts_->tolerance()) {
      contacts_->set_push(c, -gap);
      changed = true;
    }
  }
  return changed;
}

}  // namespace inextensible
