#pragma once
/// What lies in a body at the start without being an overlap that contact sees: of bodies whose surfaces look
/// the same way where they cut each other, or that lie in one another whole, no node has come through a face.

#include "contact/scene.hpp"

namespace brio {

/// Looks as far as the candidates of the scene reach, and for each two bodies at a point of one.
/// \throws std::invalid_argument naming parts, depth and place.
void expect_nothing_enclosed(const ContactScene& scene, const Nodes& nodes);

/// The second of these alone: enough where no surfaces cross.
void expect_bodies_apart(const ContactScene& scene, const Nodes& nodes);

}  // namespace brio
