#include "contact/impulse_log.hpp"

#include <algorithm>

#include "contact/scene.hpp"
#include "src/base/index.hpp"

namespace brio {

void ImpulseLog::begin_step() {
  impulse.assign(wanted.size(), Vector3d{});
  friction.assign(wanted.size(), Vector3d{});
  supports.clear();
}

void ImpulseLog::add(int first, int second, const Vector3d& of_second, const Vector3d& of_friction) {
  const std::array<int, 2> pair{std::min(first, second), std::max(first, second)};
  const auto at = std::lower_bound(wanted.begin(), wanted.end(), pair);
  if (at == wanted.end() || *at != pair) return;
  const auto add_to = [&](Vector3d& sum, const Vector3d& value) {
    if (first == second) {
      sum += absolute(value);
    } else {
      sum += first < second ? value : -value;
    }
  };
  add_to(impulse[index(at - wanted.begin())], of_second);
  add_to(friction[index(at - wanted.begin())], of_friction);
}

void ImpulseLog::add(const std::map<int, Vector3d>& impulse_of_part) {
  const auto count = static_cast<double>(impulse_of_part.size());
  for (auto a = impulse_of_part.begin(); a != impulse_of_part.end(); ++a)
    for (auto b = std::next(a); b != impulse_of_part.end(); ++b)
      add(a->first, b->first, (a->second - b->second) / count, Vector3d{});
}

int ImpulseLog::part_of(const ContactScene& scene, std::span<const int> slaves) const {
  int part = -1;
  for (const int slave : slaves)
    if (const int node = scene.surface.node[index(slave)]; node >= 0)
      part = std::max(part, part_of_node[index(node)]);
  return part;
}

void log_contacts(ContactScene& scene) {
  ImpulseLog& log = *scene.log;
  for (const Contact& contact : scene.contacts) {
    if (contact.impulse == 0) continue;
    const auto own = index(contact.own);
    const std::span<const int> nodes(contact.node);
    log.add(log.part_of(scene, nodes.first(own)), log.part_of(scene, nodes.subspan(own)),
            contact.impulse * contact.normal + contact.friction, contact.friction);
  }
}

}  // namespace brio
