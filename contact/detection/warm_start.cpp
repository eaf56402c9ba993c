#include "contact/detection/warm_start.hpp"

#include <cmath>

#include "contact/geometry/closest_point.hpp"

namespace brio {

namespace {

/// Contacts whose directions differ by more than 60 degrees do not inherit from each other.
constexpr double inherited_direction = 0.5;

void add(const Contact& last, double share, Contact& contact) {
  contact.impulse += share * last.impulse;
  const Vector3d friction = share * last.friction;
  contact.friction += friction - dot(contact.normal, friction) * contact.normal;
}
// Whether closest points lie on the same corners: a foot that leaves an edge for the faces beside it is new
// on both of them.
bool same_pair(const Contact& a, const Contact& b) {
  bool same = a.node == b.node;
  for (std::size_t k = 0; k < 5; ++k)
    same = same && (std::abs(a.weight[k]) > no_weight) == (std::abs(b.weight[k]) > no_weight);
  return same;
}
bool inherits(const Contact& contact, const Contact& last) {
  return last.body == contact.body && dot(last.normal, contact.normal) > inherited_direction;
}

}  // namespace

void warm_start(std::span<const Contact> last, double step_ratio, std::span<Contact> contacts,
                std::vector<std::uint8_t>& taken) {
  taken.assign(last.size() + contacts.size(), 0);
  std::uint8_t* found = taken.data() + last.size();
  std::size_t old_begin = 0;
  for (std::size_t begin = 0, end = 0; begin < contacts.size(); begin = end) {
    const int slave = contacts[begin].slave;
    while (end < contacts.size() && contacts[end].slave == slave) ++end;
    while (old_begin < last.size() && last[old_begin].slave < slave) ++old_begin;
    std::size_t old_end = old_begin;
    while (old_end < last.size() && last[old_end].slave == slave) ++old_end;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = old_begin; j < old_end && found[i] == 0; ++j) {
        if (taken[j] != 0 || !same_pair(last[j], contacts[i]) || !inherits(contacts[i], last[j])) continue;
        add(last[j], step_ratio, contacts[i]);
        taken[j] = found[i] = 1;
      }
    const auto is_heir = [&](std::size_t i, const Contact& ended) {
      return found[i] == 0 && inherits(contacts[i], ended);
    };
    for (std::size_t j = old_begin; j < old_end; ++j) {
      if (taken[j] != 0 || last[j].impulse == 0) continue;
      int heirs = 0;
      for (std::size_t i = begin; i < end; ++i) heirs += is_heir(i, last[j]);
      for (std::size_t i = begin; i < end; ++i)
        if (is_heir(i, last[j])) add(last[j], step_ratio / heirs, contacts[i]);
    }
    old_begin = old_end;
  }
}

}  // namespace brio
