#pragma once
/// Which faces each slave node may meet soon. The capture boxes of the search are grown by a buffer, so that
/// the search can be skipped until nodes have moved that far relative to each other; skipping never loses a
/// pair.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "contact/global_search.hpp"
#include "contact/options.hpp"
#include "contact/surface.hpp"
#include "contact/travel.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// Distance beyond the touching distance at which a face still matters to a node, over the face's shortest
/// edge: constraints reach 0.02 outside; old overlaps are followed down to half an edge inside.
inline constexpr double band_share = 0.02;
inline constexpr double followed_depth_share = 0.5;
struct Candidates {
  GlobalSearch search;
  SearchCounts counts;
  Lists faces_of;            ///< of each slave node, ascending
  std::vector<int> face;     ///< faces that occur
  std::vector<double> edge;  ///< shortest edge of each face, at the last search
  double smallest_edge = 0;  ///< of all
  double depth_share = followed_depth_share;
  double mean_edge = 0;
  double radius_bound = 0;   ///< radii of slave nodes may grow up to this between searches
  double largest_reach = 0;  ///< reach_of_node of all, or with the bound if that is larger

  std::vector<Vector3<double>> point;  ///< slave positions at the last search
  std::vector<CaptureBox> box;
  CandidatePairs pairs;
  /// Slave nodes whose list or radius has changed since pairs were looked at, other than by a search.
  std::vector<int> renewed;
  std::vector<int> fill;
  double growth[3] = {-1, -1, -1};  ///< what may be travelled; negative: no search yet

  explicit Candidates(SearchStrategy strategy = SearchStrategy::automatic) : search(strategy) {}
};

/// How far a slave node reaches: half the thickness of its shells, the radius of its beams and particles.
inline double reach_of_node(const Surface& surface, const ContactOptions& options, int slave) {
  return std::max(options.shell_thickness_scale * surface.radius[static_cast<std::size_t>(slave)],
                  surface.radius_of_rounds(slave));
}

/// Distance at which a face and a slave node touch.
inline double touching_distance(const Surface& surface, const ContactOptions& options, int face, int slave) {
  return options.shell_thickness_scale * 0.5 * surface.thickness[static_cast<std::size_t>(face)] +
         reach_of_node(surface, options, slave);
}

/// How far from a face, beyond its nodes' motion, a node of no radius can matter to it.
double influence(const Surface& surface, const ContactOptions& options, const Candidates& candidates,
                 int face);

/// The same for nodes on its outside.
double influence_outside(const Surface& surface, const ContactOptions& options, const Candidates& candidates,
                         int face);

/// Box around the points of a face's corners within which a node may come within reach of the face before the
/// next search.
CaptureBox capture_box(const Candidates& candidates, const Surface& surface, const ContactOptions& options,
                       int face);

/// Search again if some pair could have come closer than the buffer allows, and let `travel` restart.
/// \param travel  has followed the nodes to where they are, from candidates.point
/// \returns whether it searched.
bool refresh(Candidates& candidates, const Surface& surface, const Lists& excluded,
             const ContactOptions& options, const Nodes& nodes, Travel& travel, ThreadTeam& team);

}  // namespace brio
