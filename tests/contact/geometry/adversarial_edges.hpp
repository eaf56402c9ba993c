#pragma once
/// Moving edges chosen to be difficult for the edge check.

#include "contact/geometry/edge_check.hpp"
#include "tests/contact/geometry/adversarial_queries.hpp"

namespace brio {

struct EdgeQuery {
  MovingEdge a;
  MovingEdge b;
};

enum class EdgeFamily {
  random,             // all of a size, nothing aimed
  crossing,           // aimed at insides
  end_on_inside,      // aimed so that an end meets an inside
  end_on_end,         // aimed so that two ends meet
  near_miss,          // aimed past an end by 1e-17 to 1e-2 of the length, or within it by as much
  lattice,            // small integers: exact hits
  grazing,            // the cubic has a double root, exactly or but for an ulp
  parallel,           // parallel all the while, or but for an ulp, side by side or in one line
  becoming_parallel,  // parallel at one time
  coplanar,           // the ends stay in one plane
  shared_end,         // the edges have an end in common
  sliver,             // directions differ by 1e-15 to 1e-1, or lengths do, down to none
  far_from_origin,    // 1e6 sizes away
  moving_frame,       // everything moves by 1e3 sizes besides
  fast,               // relative displacement 1e1 to 1e4 sizes
  still,              // nothing moves, or everything alike
  radius,             // any of these, at the reach instead of at no distance
  radius_near_miss,   // passes at the reach but for 1e-17 to 1e-2
};
inline constexpr int edge_family_count = 18;

std::string_view name_of(EdgeFamily family);

EdgeQuery adversarial_edges(EdgeFamily family, Random& random);

}  // namespace brio
