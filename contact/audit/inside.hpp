#pragma once
/// Pieces inside of closed solids whose surfaces they do not cross.

#include <cstdint>

#include "contact/audit/crossings.hpp"

namespace brio {

/// Number of pairs: a piece of which a point lies in the closed solid of another, deeper than rounding, while
/// their surfaces do not cross: swallowed whole, or aligned with it so exactly that edges run in faces.
std::int64_t count_swallowed(const AuditedSurface& surface, const Crossings& crossings, ThreadTeam& team);

}  // namespace brio
