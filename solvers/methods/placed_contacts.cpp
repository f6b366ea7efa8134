// Places without a contact have a plane of no normal, which moves nothing.
#include "solvers/methods/placed_contacts.h"

#include <algorithm>

namespace inextensible {

PlacedContacts::PlacedContacts(const ColoredEdges& edges, bool contact) {
  if (!contact) return;
  normal_ = held_ = edges.make_places();
  offset_.setZero(normal_.rows());
  push_.setZero(normal_.rows());
  blocks_.reserve(static_cast<std::size_t>(normal_.rows() / width));
}

void PlacedContacts::load(const Contacts& contacts, const ColoredEdges& edges) {
  for (const int first : blocks_) {
    normal_.middleRows<width>(first).setZero();
    held_.middleRows<width>(first).setZero();
    offset_.segment<width>(first).setZero();
    push_.segment<width>(first).setZero();
  }
  blocks_.clear();
  for (int c = 0; c < contacts.count(); ++c) {
    const int place = edges.place(contacts.vertex(c));
    const Eigen::Vector3d n = contacts.normal(c);
    if (normal_.middleRows<width>(place - place % width).isZero(0))
      blocks_.push_back(place - place % width);
    normal_.row(place) = n.transpose();
    offset_[place] = -contacts.gap(c, Eigen::Vector3d::Zero());
    push_[place] = contacts.push(c);
  }
  std::sort(blocks_.begin(), blocks_.end());
}

void PlacedContacts::store(Contacts& contacts, const ColoredEdges& edges) const {
  for (int c = 0; c < contacts.count(); ++c)
    contacts.set_push(c, push_[edges.place(contacts.vertex(c))]);
}

void PlacedContacts::settle(ColoredEdges::Places& x) {
  const std::ptrdiff_t stride = x.rows();
  for (const int first : blocks_) {
    const double* n = normal_.data() + first;
    double* at = x.data() + first;
    Contacts::visit({n, n + stride, n + 2 * stride}, offset_.data() + first, push_.data() + first,
                    {at, at + stride, at + 2 * stride});
  }
}

const ColoredEdges::Places& PlacedContacts::held_normals() {
  for (const int first : blocks_) {
    for (int axis = 0; axis < 3; ++axis) {
      const double* n = normal_.col(axis).data() + first;
      const double* pushed = push_.data() + first;
      double* held = held_.col(axis).data() + first;
      for (int i = 0; i < width; ++i) held[i] = pushed[i] > 0 ? n[i] : 0;
    }
  }
  return held_;
}

}  // namespace inextensible
