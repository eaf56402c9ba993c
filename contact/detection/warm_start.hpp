#pragma once
/// Warm start of contact impulses.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/pair.hpp"

namespace brio {

/// Start from the impulses of the same pair in the last step, scaled by the ratio of the time steps. The
/// impulse of a contact that has ended is distributed equally to new contacts of the same node or edge with
/// the same body and about the same normal. Both lists are ordered by Contact::slave. \param taken working
/// space
void warm_start(std::span<const Contact> last, double step_ratio, std::span<Contact> contacts,
                std::vector<std::uint8_t>& taken);

}  // namespace brio
