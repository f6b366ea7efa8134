#include "solvers/problem/contacts.h"

namespace inextensible {

// A depth that no picture shows and no strain notices, in shortest rest lengths; without edges, m.
constexpr double invisible = 1e-5, invisible_point = 1e-9;
// In shortest rest lengths: a vertex on its plane this far from the obstacle has left it.
// With less, planes keep changing at the corners of a polygonal obstacle.
constexpr double margin = 0.5;
// The same unit, a vertex: what edges within their limits may be away from the closest point.
constexpr double room = 0.1;
// Weight of the last step's push by edges in the expected one; less for a vertex that passes
// several edges in a step. A larger weight lets friction and edges drive each other.
constexpr double newest = 0.1;

Contacts::Contacts(const Problem& problem)
    : problem_(problem),
      friction_(problem.collider()->friction()),
      place_(problem.vertices(), -1),
      obstacle_(problem) {
  const double length = problem.constraints() > 0 ? problem.shortest_rest_length() : 0;
  tolerance_ = length > 0 ? invisible * length : invisible_point;
  margin_ = margin * length;
  slack_ = length > 0 ? room * length * std::sqrt(problem.total_mass())
                      : std::numeric_limits<double>::infinity();
  contacts_.reserve(problem.vertices());
  found_.reserve(problem.vertices());
  if (!problem.contact_inside() || friction_ == 0) return;
  candidate_.resize(3, problem.vertices());
  expected_.resize(3, problem.vertices());
  for (Positions* p : {&before_, &pulling_, &pressing_}) p->setZero(3, problem.vertices());
}

void Contacts::begin(const Positions& x_start, double time, double h) {
  const Timing measured = timing();
  for (const Contact& contact : contacts_) place_[contact.vertex] = -1;
  contacts_.clear();
  clear_ = false;
  start_ = &x_start;
  h_ = h;
  if (!problem_.body_motion()) return;
  obstacle_.place(time);
  const Pose back = obstacle_.pose().inverse();
  obstacle_.place(time + h);
  carry_ = obstacle_.pose() * back;
}

double Contacts::distance(const Positions& x) const {
  double sum = 0;
  for (int v = 0; v < problem_.vertices(); ++v) {
    double squared = (x.col(v) - start_->col(v)).squaredNorm();
    if (problem_.body_motion()) squared = std::min(squared, (x.col(v) - carried(v)).squaredNorm());
    sum += problem_.mass()[v] * squared;
  }
  return std::sqrt(sum);
}

void Contacts::put(const ContactPlane& plane, WorkCounters& work) {
  int& place = place_[plane.vertex];
  if (place < 0) {
    place = count();
    contacts_.push_back({.vertex = plane.vertex});
    ++work.contacts;
  }
  contacts_[place].normal = plane.normal;
  contacts_[place].offset = plane.offset;
}

int Contacts::find(const Positions& x, WorkCounters& work) {
  const Timing measured = timing();
  obstacle_.find(x, tolerance_, found_, work);
  for (const ContactPlane& plane : found_) put(plane, work);
  return static_cast<int>(found_.size());
}

int Contacts::update(Positions& x, WorkCounters& work) {
  const Timing measured = timing();
  int changed = 0;
  ContactPlane plane{};
  for (int c = 0; c < count(); ++c) {
    plane.vertex = vertex(c);
    auto at = x.col(plane.vertex);
    if (!holds(c)) continue;
    if (!obstacle_.plane_at(at, plane, work)) {
      plane.normal = normal(c);
      plane.offset = -std::numeric_limits<double>::infinity();  // none
    } else if (plane.normal.dot(at) - plane.offset <= margin_) {
      continue;
    }
    at -= push(c) * normal(c);
    set_push(c, 0);
    put(plane, work);
    ++changed;
  }
  changed += find(x, work);
  if (changed > 0) settle(x);
  return changed;
}

void Contacts::settle(Positions& x) {
  const Timing measured = timing();
  for (int c = 0; c < count(); ++c) {
    auto at = x.col(vertex(c));
    at += visit(gap(c, at), contacts_[c].push) * normal(c);
  }
}

// Where the step begins, as the obstacle carries it.
Eigen::Vector3d Contacts::carried(int vertex) const {
  const Eigen::Vector3d start = start_->col(vertex);
  return problem_.body_motion() ? carry_(start) : start;
}

// Coulomb's friction of a push on a vertex with this displacement; whether it is all taken.
bool Contacts::take_friction(const ContactPlane& plane, double push,
                             const Eigen::Vector3d& displacement, Positions& x) const {
  const Eigen::Vector3d slide = displacement - plane.normal.dot(displacement) * plane.normal;
  const double length = slide.norm(), most = friction_ * push;
  if (length > 0) x.col(plane.vertex) -= std::min(1.0, most / length) * slide;
  return most >= length;
}

void Contacts::apply_friction(Positions& x0, WorkCounters& work) {
  if (candidate_.size() == 0) return;
  const Timing measured = timing();
  const double scale = h_ * h_;
  expected_ = x0 + scale * pressing_;
  obstacle_.find(expected_, 0, found_, work);
  for (const ContactPlane& plane : found_) {
    put(plane, work);
    const int v = plane.vertex;
    const double push = plane.offset - plane.normal.dot(expected_.col(v));
    contacts_[place_[v]].stopped =
        take_friction(plane, push, x0.col(v) + scale * pulling_.col(v) - carried(v), x0);
  }
  candidate_ = x0;
}

void Contacts::accept(const Positions& x) {
  if (candidate_.size() == 0) return;
  const Timing measured = timing();
  const double scale = 1 / (h_ * h_), edge = margin_ / margin;
  for (int c = 0; c < count(); ++c) candidate_.col(vertex(c)) += push(c) * normal(c);
  const double *at = x.data(), *from = start_->data(), *without = candidate_.data();
  double *before = before_.data(), *pressing = pressing_.data(), *pulling = pulling_.data();
#pragma GCC ivdep
  for (Eigen::Index k = 0; k < 3 * x.cols(); k += 3) {
    double squared = 0, both = 0, now_squared = 0, before_squared = 0, now[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double moved = at[k + axis] - from[k + axis], b = before[k + axis];
      const double a = now[axis] = scale * (at[k + axis] - without[k + axis]);
      squared += moved * moved;
      both += a * b;
      now_squared += a * a;
      before_squared += b * b;
    }
    const double weight = newest * std::min(1.0, edge / std::sqrt(squared));
    const double new_part = both > 0 && now_squared < before_squared ? 1 : 0;
    const double old_part = both > 0 ? 1 - new_part : 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = now[axis], b = before[k + axis];
      pressing[k + axis] += weight * (a - pressing[k + axis]);
      pulling[k + axis] = new_part * a + old_part * b;
      before[k + axis] = a;
    }
  }
}

void Contacts::keep_in_planes(Positions& d) const {
  const Timing measured = timing();
  for (int c = 0; c < count(); ++c) {
    auto at = d.col(vertex(c));
    if (holds(c)) at -= normal(c).dot(at) * normal(c);
  }
}

void Contacts::keep_on_planes(const Positions& x, Positions& v) const {
  keep_in_planes(v);
  if (!problem_.body_motion()) return;
  const Pose back = carry_.inverse();
  for (int c = 0; c < count(); ++c) {
    if (!holds(c)) continue;
    const Eigen::Vector3d at = x.col(vertex(c)), obstacle = (at - back(at)) / h_;
    v.col(vertex(c)) += normal(c).dot(obstacle) * normal(c);
  }
}

Eigen::Vector3d Contacts::end_velocity(int contact, const Eigen::Vector3d& mean,
                                       const Eigen::Vector3d& own) const {
  if (stopped(contact)) return mean;
  return own - normal(contact).dot(own - mean) * normal(contact);
}

// With friction of this push, unless contacts were kept inside the solve and friction came before.
void Contacts::push_out(Positions& x, WorkCounters& work) {
  obstacle_.find(x, tolerance_, found_, work);
  for (const ContactPlane& plane : found_) {
    auto at = x.col(plane.vertex);
    const double depth = plane.offset - plane.normal.dot(at);
    at += depth * plane.normal;
    put(plane, work);
    contacts_[place_[plane.vertex]].push += depth;
    if (!problem_.contact_inside()) take_friction(plane, depth, at - carried(plane.vertex), x);
  }
  if (problem_.contact_inside() || friction_ == 0) return;
  // Where the obstacle is not convex, friction may move vertices into it again.
  obstacle_.find(x, tolerance_, found_, work);
  for (const ContactPlane& plane : found_) {
    auto at = x.col(plane.vertex);
    at += (plane.offset - plane.normal.dot(at)) * plane.normal;
  }
}

void Contacts::save(Record& record) const {
  record.reserve(contacts_.capacity());
  record = contacts_;
}

void Contacts::restore(const Record& record) {
  for (; contacts_.size() > record.size(); contacts_.pop_back())
    place_[contacts_.back().vertex] = -1;
  std::ranges::copy(record, contacts_.begin());
}

}  // namespace inextensible
