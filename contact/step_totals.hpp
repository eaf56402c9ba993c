#pragma once
/// What the contacts of a step come to.

namespace brio {

struct ContactScene;

/// Impulses of slave nodes from those of the contacts.
void sum_impulses(ContactScene& scene);
/// Contacts, active ones and the deepest overlap into the step.
void count_contacts(ContactScene& scene);
/// The step into the totals.
void add_to_totals(ContactScene& scene);

}  // namespace brio
