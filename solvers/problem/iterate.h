// What the iterations of a step move: positions, and, where contact is inside the solve, the planes
// that keep vertices out of the obstacle. Most methods only move vertices and call settle(); those
// that build a system of equations also read contacts().
#pragma once

#include "solvers/problem/contacts.h"

namespace inextensible {

// A view: positions and contacts outlive it.
class Iterate {
 public:
  // x: 3 x n. contacts: null, or begun (Contacts::begin).
  Iterate(Positions& x, Contacts* contacts = nullptr) : x_(&x), contacts_(contacts) {}

  // Converts to its positions wherever these are asked for.
  operator Positions&() const { return *x_; }
  Positions& positions() const { return *x_; }

  Contacts* contacts() const { return contacts_; }
  int contact_count() const { return contacts_ ? contacts_->count() : 0; }

  // After vertices have moved: those that went through their planes are put back.
  void settle() const {
    if (contacts_) contacts_->settle(*x_);
  }
  // After an iteration: planes that their vertices have left are replaced by the nearest one, and
  // vertices that are inside the obstacle now get a contact (Contacts::update).
  void renew_planes(WorkCounters& work) const {
    if (contacts_) contacts_->update(*x_, work);
  }

  // The positions without what planes have pushed, to `to` (3 x n).
  void without_pushes(Positions& to) const {
    to = *x_;
    for (int c = 0; c < contact_count(); ++c)
      to.col(contacts_->vertex(c)) -= contacts_->push(c) * contacts_->normal(c);
  }

  // To be taken up again later in the step.
  struct Record {
    Positions x;
    Contacts::Record contacts;
  };
  void save(Record& record) const {
    record.x = *x_;
    if (contacts_) contacts_->save(record.contacts);
  }
  void restore(const Record& record) const {
    *x_ = record.x;
    if (contacts_) contacts_->restore(record.contacts);
  }

 private:
  Positions* x_;
  Contacts* contacts_;
};

}  // namespace inextensible
