#pragma once
/// What lies in a body whole at the start: no surfaces cross there.

#include "contact/scene.hpp"

namespace brio {

/// Looks for each two bodies at a point of one: enough where no surfaces cross.
/// \param overlap_limit in edges: what overlaps by no more is left to those who remove it
/// \throws std::invalid_argument naming parts, depth and place.
void expect_bodies_apart(const ContactScene& scene, const Nodes& nodes, double overlap_limit);

/// The same of bodies within the bounds of another, before anything is searched: a part that is listed twice
/// is in many pairs. \throws as above
void expect_none_enclosed(const ContactScene& scene, const Nodes& nodes, double overlap_limit);

}  // namespace brio
