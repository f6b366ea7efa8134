// Contacts of a step: planes that keep vertices out of the obstacle, their pushes, lagged friction.
//
// A plane of normal n pushes and never pulls:
//   push >= 0,  n . x >= offset,  push (n . x - offset) = 0,
// which settle() brings about vertex by vertex, by projected Gauss-Seidel (Jourdan, Alart and Jean
// 1998): the push is kept, so that a plane releases a vertex that is pulled away from it.
//
// Friction is lagged: it is found before edges and planes are solved, and held fixed meanwhile.
// With the push of the same step in Coulomb's cone, a tight ring locks itself: no positions satisfy
// edges, planes and friction together. What edges will do to a vertex is expected to be what they
// have done (Kaufman et al. 2008 and Li et al. 2020 lag the push in this way):
// * They press with a mean over some ten steps. A vertex that is `depth` inside with it is pushed
//   by as much, and friction takes at most mu depth off its displacement along the surface.
// * They pull along the surface by the lesser of what they did in the last two steps, and by
//   nothing where these contradict each other. Friction takes this off beforehand, so that a vertex
//   sticks under a steady pull; from rest it creeps by what that pull moves it in one or two steps.
// On an obstacle that moves, displacements are counted from where the obstacle carries the vertex.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solvers/problem/obstacle.h"
#include "solvers/problem/stopwatch.h"

namespace inextensible {

// max(x, 0) of a number or of a vector of numbers; of vectors, compilers make a call of max().
template <class Real>
[[gnu::always_inline]] inline Real positive_part(const Real& x) {
  using std::abs;
  return Real(0.5F) * (x + abs(x));
}

class Contacts {
 public:
  // The problem has a collider, and outlives this.
  explicit Contacts(const Problem& problem);

  // A step of h begins at x_start (3 x n) and `time`, s; there are no contacts. The obstacle is
  // where it will be when the step ends.
  void begin(const Positions& x_start, double time, double h);

  // Friction, once a step, on the candidate x0 (3 x n, the end of the step without edges and
  // planes): shortens the displacement of vertices along the surface. Vertices that are expected to
  // touch get a contact.
  void apply_friction(Positions& x0, WorkCounters& work);
  // The candidate after it, until accept(); empty without friction.
  const Positions& candidate() const { return candidate_; }
  // The step is accepted, and ended at x before the collision filter: what edges did to the
  // candidate is expected of them in the next step.
  void accept(const Positions& x);

  // Gives every vertex of x that is inside a contact with the plane that is nearest now. Returns
  // how many were inside, deeper than `tolerance()`.
  int find(const Positions& x, WorkCounters& work);
  // As find(); and a contact that holds a vertex which has left the surroundings of its plane takes
  // the nearest one, as the old one excludes half of space. Then settles. Returns how many planes
  // are new or replaced.
  int update(Positions& x, WorkCounters& work);
  double tolerance() const { return tolerance_; }  // m

  // Visits every contact once, at x (3 x n).
  void settle(Positions& x);

  // One visit of a contact, or of several side by side, whose vertex is `gap` above its plane.
  // Returns by how much the push grows, which is how far the vertex moves along the normal.
  template <class Real>
  [[gnu::always_inline]] static Real visit(const Real& gap, Real& push) {
    const Real before = push;
    push = positive_part(Real(before - gap));
    return push - before;
  }

  // Takes from displacements d (3 x n, m) what leads through or out of planes that hold vertices.
  void keep_in_planes(Positions& d) const;
  // The same of velocities v (3 x n, m/s) of vertices at x, for planes as they move.
  void keep_on_planes(const Positions& x, Positions& v) const;

  // The velocity at the end of a step of the vertex that a contact holds: `mean` over the step,
  // `own` by the stepper's formula. Along the normal it is the mean one, so that nothing bounces.
  // Along the surface, where friction and weight go on acting, it is the stepper's own, unless
  // friction has stopped the vertex in this step.
  Eigen::Vector3d end_velocity(int contact, const Eigen::Vector3d& mean,
                               const Eigen::Vector3d& own) const;

  // The end of every step: leaves no vertex inside. Not needed where clear().
  void push_out(Positions& x, WorkCounters& work);
  // The step is solved, and find() has found nothing at its end.
  void set_clear() { clear_ = true; }
  bool clear() const { return clear_; }

  // |x - x_start| in the norm of M, each vertex from where it began or from where the obstacle
  // would have carried it, whichever is nearer; and how much of it may come from edges that drift
  // within their limits.
  double distance(const Positions& x) const;
  double slack() const { return slack_; }

  // Adds the seconds of its scope to measure()'s sum; one inside another adds nothing.
  class Timing {
   public:
    explicit Timing(double*& sum)
        : place_(sum), sum_(std::exchange(sum, nullptr)), stopwatch_(sum_ != nullptr) {}
    ~Timing() {
      if (!sum_) return;
      *sum_ += stopwatch_();
      place_ = sum_;
    }
    Timing(const Timing&) = delete;
    Timing& operator=(const Timing&) = delete;

   private:
    double*& place_;
    double* sum_;
    Stopwatch stopwatch_;
  };
  Timing timing() const { return Timing(seconds_); }
  // sum: s, outlives this; null: no clock is read, as at first.
  void measure(double* sum) { seconds_ = sum; }

  struct Contact {
    int vertex;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double offset = 0, push = 0;  // m, along the normal
    bool stopped = false;         // friction took all of its slide
  };
  int count() const { return static_cast<int>(contacts_.size()); }
  int vertex(int contact) const { return contacts_[contact].vertex; }
  const Eigen::Vector3d& normal(int contact) const { return contacts_[contact].normal; }
  bool holds(int contact) const { return push(contact) > 0; }
  bool stopped(int contact) const { return contacts_[contact].stopped; }
  double push(int contact) const { return contacts_[contact].push; }
  void set_push(int contact, double push) { contacts_[contact].push = push; }
  // Height of its vertex at x above the plane, m.
  double gap(int contact, const Eigen::Vector3d& x) const {
    return normal(contact).dot(x) - contacts_[contact].offset;
  }

  // A snapshot for rollback with the positions of that time. Contacts found since are forgotten.
  using Record = std::vector<Contact>;
  void save(Record& record) const;
  void restore(const Record& record);

 private:
  void put(const ContactPlane& plane, WorkCounters& work);
  Eigen::Vector3d carried(int vertex) const;
  bool take_friction(const ContactPlane& plane, double push, const Eigen::Vector3d& displacement,
                     Positions& x) const;

  const Problem& problem_;
  mutable double* seconds_ = nullptr;
  double tolerance_ = 0, margin_ = 0, slack_ = 0, friction_;
  const Positions* start_ = nullptr;
  // Motion of the obstacle during the step, and the step's length, s.
  Pose carry_;
  double h_ = 0;
  bool clear_ = false;
  std::vector<Contact> contacts_;
  std::vector<int> place_;  // of a vertex's contact, or -1
  Obstacle obstacle_;
  std::vector<ContactPlane> found_;
  // With friction only: the candidate after it, where edges are expected to take it, and what they
  // have done to vertices, m/s^2: in the last step; along surfaces; towards them.
  Positions candidate_, expected_, before_, pulling_, pressing_;
};

// What the iterations of a step move: positions, and, where contact is inside the solve, the planes
// that keep vertices out of the obstacle. Most methods only move vertices and call settle(); those
// that build a system of equations also read contacts(). A view: both outlive it.
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

  // A snapshot for rollback within the step.
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
