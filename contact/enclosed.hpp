#pragma once
/// What lies in a body whole at the start: no surfaces cross there.

#include "contact/scene.hpp"

namespace brio {

/// Looks for each two bodies at a point of one: enough where no surfaces cross.
/// \param overlap_limit in edges: overlaps up to it are left to those who remove them.
/// \throws std::invalid_argument naming parts, depth and place.
void expect_bodies_apart(const ContactScene& scene, const Nodes& nodes, double overlap_limit = 0);

}  // namespace brio
