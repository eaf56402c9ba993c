#pragma once
/// Bodies completely inside of others at the start: no surfaces cross there.

#include "contact/scene.hpp"

namespace brio {

/// Examines for each two bodies a point of one: sufficient where no surfaces cross.
/// \param overlap_limit in edges: smaller overlaps are removed elsewhere
/// \throws std::invalid_argument naming parts, depth and place.
void expect_bodies_apart(const ContactScene& scene, const Nodes& nodes, double overlap_limit);

/// The same of bodies within the bounds of another, before anything is searched: a part that is listed twice
/// is in many pairs. \throws as above
void expect_none_enclosed(const ContactScene& scene, const Nodes& nodes, double overlap_limit);

}  // namespace brio
