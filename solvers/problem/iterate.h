// What the iterations of a step move: positions, and, where contact is inside the solve, the planes
// that keep vertices out of the obstacle. A method moves vertices and calls settle(); whether there
// is an obstacle is none of its concern.
#pragma once

#include "solvers/problem/contacts.h"

namespace inextensible {

// A view: positions and contacts outlive it.
class Iterate {
 public:
  // x: 3 x n. contacts: null, or begun (Contacts::begin).
  Iterate(Positions& x, Contacts* contacts = nullptr) : x_(&x), contacts_(contacts) {}

  // Wherever positions are asked for.
  operator Positions&() const { return *x_; }
  Positions& positions() const { return *x_; }

  Contacts* contacts() const { return contacts_; }
  int touching() const { return contacts_ ? contacts_->count() : 0; }  // contacts

  // After vertices have moved: those that went through their planes are put back.
  void settle() const {
    if (contacts_) contacts_->settle(*x_);
  }
  // After an iteration: every contact takes the plane that is nearest now (Contacts::update).
  void renew_planes(WorkCounters& work) const {
    if (contacts_) contacts_->update(*x_, work);
  }
  // Contacts of vertices that are inside the obstacle and have none; returns how many are inside.
  int find_contacts(WorkCounters& work) const { return contacts_ ? contacts_->find(*x_, work) : 0; }

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
