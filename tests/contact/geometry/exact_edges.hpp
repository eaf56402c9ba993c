#pragma once
/// Decides without rounding whether and when two moving edges meet. Shares no arithmetic with the code it
/// judges.

#include <optional>

#include "contact/geometry/edge_check.hpp"
#include "tests/contact/geometry/exact_polynomial.hpp"

namespace brio::exact {

/// The earliest time in [0, 1] at which the distance of the edges is the sum of the radii or less.
std::optional<Number> first_contact(const MovingEdge& a, const MovingEdge& b);

/// Whether the edges are within the sum of their radii + `distance` (may be negative) at the time.
bool within(const MovingEdge& a, const MovingEdge& b, double time, double distance);

/// The same for the two points given by their parameters.
bool points_within(const MovingEdge& a, const MovingEdge& b, const std::array<double, 2>& parameters,
                   double time, double distance);

/// Sign of (a - b) . (along a x along b) at the time.
int side_at(const MovingEdge& a, const MovingEdge& b, double time);

}  // namespace brio::exact
