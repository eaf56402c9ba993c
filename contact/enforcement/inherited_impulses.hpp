#pragma once
/// Warm start of contacts by distances.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/pair.hpp"

namespace brio {

/// Start from the impulses of the last step, scaled by the ratio of the steps: those of the same pair. What a
/// contact carried that has ended goes in equal parts to those that are new, of the same node or edge with
/// the same body, that push about the same way. Both lists are ordered by Contact::slave.
/// \param taken working space
void inherit_impulses(std::span<const Contact> last, double step_ratio, std::span<Contact> contacts,
                      std::vector<std::uint8_t>& taken);

}  // namespace brio
