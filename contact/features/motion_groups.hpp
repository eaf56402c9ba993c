#pragma once
/// Groups of nodes, in whose moving frames paths are measured.
///
/// Nodes of one body that lie near each other are a group, and its frame moves with their mean displacement:
/// free bodies, or parts moved by a fold, move little in their own frame. A feature belongs to the group
/// of its first node. The distance of two features shrinks by no more than both their paths and the path of
/// one frame relative to the other, which their relation holds.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/features/features.hpp"
#include "contact/search/spatial_order.hpp"
#include "contact/surface/surface.hpp"
#include "src/base/index.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// Of all features of one kind, or of all relations.
struct PathAndAhead {
  std::vector<double> path;   ///< since the restart, until the start of this step
  std::vector<double> ahead;  ///< the path with approach_factor times the displacement of this step

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(path, ahead);
  }
};

class MotionGroups {
 public:
  struct Group {
    Vector3d step{}, last{};      ///< displacement of the frame in this step and in the last one
    double moved = 0, ahead = 0;  ///< longest displacement of its nodes in the last step and in this one
    double longest_path = 0, longest_ahead = 0;  ///< no feature of it has more
  };
  std::vector<Group> group;
  PathAndAhead relation;  ///< of the frames of each relation
  /// By how much the frames of each relation moved apart, in the last step and in this one.
  std::vector<std::array<double, 2>> apart;
  PathAndAhead total;                                ///< no pair of features of a relation has more
  std::vector<std::uint8_t> holds_face, holds_edge;  ///< of each, whether one group has all of its corners

  /// Group the nodes by where they are; nothing is related. \param position of each slave node, of dead ones
  /// not a number
  void form(const Surface& surface, const SurfaceFeatures& features, std::span<const Vector3d> position,
            ThreadTeam& team);
  /// Follow a deletion: new nodes belong to groups of nodes that share a face with them. \param edges new and
  /// changed ones
  void join(const Surface& surface, const SurfaceFeatures& features, const SurfaceChange& change,
            std::span<const int> edges);

  /// By how much the frames of two groups that share a feature moved apart.
  const std::array<double, 2>& frames_apart(int a, int b) const {
    return apart[index(relation_of_[cell(a, b)])];
  }
  int of_node(int slave) const { return of_node_[index(slave)]; }
  /// Living nodes of a group, ascending.
  std::span<const int> members(std::size_t g) const { return member_.of(static_cast<int>(g)); }
  /// The relation of the groups of two nodes.
  int relate(int slave_a, int slave_b);

  /// Follow one step, of which the groups have the frames and the longest displacements.
  void advance(bool with_paths);

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(group, relation, apart, total, holds_face, holds_edge, of_node_, member_, border_, related_,
            relation_of_, longest_);
  }

 private:
  std::size_t cell(int a, int b) const {
    return index(std::min(a, b)) * group.size() + index(std::max(a, b));
  }
  void list_members(const Surface& surface);
  /// \returns whether there is none
  template <class Corners>
  bool add_borders(const Corners& corners);

  std::vector<int> of_node_;
  Lists member_;
  std::vector<std::array<int, 3>> border_;      ///< a feature of the first has a node in the second; relation
  std::vector<std::array<int, 2>> related_;     ///< groups of each relation
  std::vector<int> relation_of_;                ///< of two groups; -1: none
  std::vector<std::array<double, 2>> longest_;  ///< of features of each group: moved, ahead
  SpatialOrder order_;
};

/// Constraints are formed before contact, over this multiple of the approach of the step: other impulses of
/// the step may increase it.
inline constexpr double approach_factor = 2;
/// Paths are rounded up by more than their sums are rounded down.
inline constexpr double paths_rounded_up = 1 + 1e-9;

}  // namespace brio
