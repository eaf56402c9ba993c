#include "contact/step_totals.hpp"

#include <algorithm>

#include "contact/scene.hpp"
#include "src/base/index.hpp"

namespace brio {

void sum_impulses(ContactScene& scene) {
  scene.pushed.for_each([&](std::size_t s) {
    scene.normal_impulse[s] = {};
    scene.friction_impulse[s] = {};
  });
  scene.pushed.clear();
  for (const Contact& contact : scene.contacts) {
    if (contact.impulse == 0) continue;
    for (std::size_t k = 0; k < 5; ++k) {
      const auto s = index(contact.node[k]);
      scene.pushed.insert(contact.node[k]);
      scene.normal_impulse[s] += contact.weight[k] * contact.impulse * contact.normal;
      scene.friction_impulse[s] += contact.weight[k] * contact.friction;
    }
  }
}

void count_contacts(ContactScene& scene) {
  ContactStep& step = scene.step;
  step.contacts = static_cast<int>(scene.contacts.size());
  for (const Contact& contact : scene.contacts) {
    step.deepest_overlap = std::max(step.deepest_overlap, -contact.gap);
    if (contact.impulse > 0) ++step.active;
  }
}

void add_to_totals(ContactScene& scene) {
  const ContactStep& step = scene.step;
  ContactTotals& totals = scene.totals;
  ++totals.steps;
  totals.contacts += static_cast<std::uint64_t>(step.contacts);
  totals.passes += static_cast<std::uint64_t>(step.passes);
  totals.most_contacts = std::max(totals.most_contacts, step.contacts);
  totals.normal_work += step.normal_work();
  totals.normal_work_added += std::max(0.0, step.normal_work());
  totals.largest_normal_work = std::max(totals.largest_normal_work, totals.normal_work);
  totals.friction_work += step.friction_work();
  totals.deepest_overlap = std::max(totals.deepest_overlap, step.deepest_overlap);
}

}  // namespace brio
