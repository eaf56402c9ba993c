#pragma once
/// Decides without rounding whether and when a moving node meets a moving face. Shares no arithmetic with the
/// code it judges: the given doubles are rational numbers, everything else is integers.

#include <optional>

#include "contact/geometry/velocity_check.hpp"
#include "tests/contact/geometry/exact_polynomial.hpp"

namespace brio::exact {

/// The earliest time of contact in [0, 1], if there is one. Boundaries count as inside.
std::optional<Number> first_contact(const MovingNode& node, const MovingFace& face);

/// Whether the node is within `distance` of the face at the time.
bool within(const MovingNode& node, const MovingFace& face, double time, double distance);

/// Whether the point of the face given by its weights is within `distance` of the node at the time.
bool point_within(const MovingNode& node, const MovingFace& face, const std::array<double, 4>& weights,
                  double time, double distance);

/// Sign of the volume of node and sub-triangle at the time: the side the node is on.
int side_at(const MovingNode& node, const MovingFace& face, int sub_triangle, double time);

}  // namespace brio::exact
