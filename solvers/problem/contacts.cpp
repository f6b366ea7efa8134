#include "inextensible/problem/contacts.h"

namespace inextensible {
namespace {

// Of the shortest rest length: a depth that nobody sees and no strain notices. Without edges, m.
constexpr double invisible = 1e-5, invisible_point = 1e-9;
constexpr int rounds_with_friction = 8;

}  // namespace

Contacts::Contacts(const Problem& problem)
    : problem_(problem),
      tolerance_(problem.constraints() > 0 ? invisible * problem.shortest_rest_length()
                                           : invisible_point),
      friction_(problem.collider()->friction()),
      vertex_(problem.vertices()),
      place_(problem.vertices(), -1),
      obstacle_(problem) {
  for (std::vector<double>& column : numbers_) column.assign(problem.vertices() + lanes, 0.0);
  found_.reserve(problem.vertices());
}

void Contacts::begin(const Positions& x_start, double time, double h) {
  for (int c = 0; c < count_; ++c) place_[vertex_[c]] = -1;
  count_ = 0;
  start_ = &x_start;
  if (!problem_.body_motion()) return;
  obstacle_.place(time);
  const Pose back = obstacle_.pose().inverse();
  obstacle_.place(time + h);
  carry_ = obstacle_.pose() * back;
  h_ = h;
}

void Contacts::set_plane(int contact, const ContactPlane& plane) {
  value(normal_x, contact) = plane.normal.x();
  value(normal_y, contact) = plane.normal.y();
  value(normal_z, contact) = plane.normal.z();
  value(offset, contact) = plane.offset;
}

int Contacts::find(const Positions& x, WorkCounters& work) {
  obstacle_.find(x, tolerance_, found_, work);
  for (const ContactPlane& plane : found_) {
    int& place = place_[plane.vertex];
    if (place < 0) {
      place = count_++;
      vertex_[place] = plane.vertex;
      Eigen::Vector3d start = start_->col(plane.vertex);
      if (problem_.body_motion()) start = carry_(start);
      value(start_x, place) = start.x();
      value(start_y, place) = start.y();
      value(start_z, place) = start.z();
      for (const Number number : {push, drag_x, drag_y, drag_z}) value(number, place) = 0;
      ++work.contacts;
    }
    set_plane(place, plane);
  }
  return static_cast<int>(found_.size());
}

void Contacts::keep_in_planes(Positions& d) const {
  for (int c = 0; c < count_; ++c) {
    auto at = d.col(vertex_[c]);
    if (holds(c)) at -= normal(c).dot(at) * normal(c);
  }
}

void Contacts::keep_on_planes(const Positions& x, Positions& v) const {
  keep_in_planes(v);
  if (!problem_.body_motion()) return;
  const Pose back = carry_.inverse();
  for (int c = 0; c < count_; ++c) {
    if (!holds(c)) continue;
    const Eigen::Vector3d at = x.col(vertex_[c]), obstacle = (at - back(at)) / h_;
    v.col(vertex_[c]) += normal(c).dot(obstacle) * normal(c);
  }
}

// Where the obstacle is not convex, friction's way back may lead into it again; in the end a vertex
// goes the shortest way out.
void Contacts::push_out(Positions& x, WorkCounters& work) {
  for (int round = 0; find(x, work) > 0; ++round) {
    if (round < rounds_with_friction) {
      settle(x);
      continue;
    }
    for (const ContactPlane& plane : found_) {
      auto at = x.col(plane.vertex);
      at += (plane.offset - plane.normal.dot(at)) * plane.normal;
    }
    return;
  }
}

void Contacts::save(Record& record) const {
  for (std::size_t i = 0; i < record.done.size(); ++i) {
    const auto from = numbers_[push + i].begin();
    record.done[i].reserve(numbers_[push + i].size());
    record.done[i].assign(from, from + count_);
  }
}

void Contacts::restore(const Record& record) {
  for (std::size_t i = 0; i < record.done.size(); ++i)
    std::copy(record.done[i].begin(), record.done[i].end(), numbers_[push + i].begin());
}

}  // namespace inextensible
