#pragma once
/// How far nodes may move before the search has to be repeated.
///
/// At a search every node is given a closed box of its own, its range: the path it would take at its present
/// velocity over a time ahead, grown by half a buffer. The range of a face is the hull of its corners'
/// ranges, grown by the distance within which the face matters to a node: Heinstein et al. (1993) bound the
/// face at t and t + dt and grow the box by the largest motion of any node; here each node brings its own
/// motion, so that one fast fragment does not enlarge all boxes. While all nodes are in their ranges, up to
/// one translation common to all of them, no node and face can be within that distance of each other unless
/// their ranges overlap: pairs found from the ranges are complete. A scene that travels as a whole triggers
/// no search.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "contact/search.hpp"

namespace brio {

class MotionRanges {
 public:
  /// Give every node its range.
  /// \param positions, velocities  of each node
  /// \param ahead  time over which nodes are expected to keep their velocity, less the mean of all; 0: ranges
  /// are
  ///               cubes about the positions
  /// \param buffer  twice the length by which a node may leave its expected path, per axis; with `ahead` = 0
  /// a search
  ///                is due as soon as two nodes have moved by more than this relative to each other
  void predict(std::span<const Vector3<double>> positions, std::span<const Vector3<double>> velocities,
               double ahead, double buffer, ThreadTeam& team);

  /// Whether the last ranges hold all nodes, now and all the way of the coming step, during which they move
  /// straight by `dt` times their velocity; false before the first call of `predict` and for another number
  /// of nodes.
  bool hold(std::span<const Vector3<double>> positions, std::span<const Vector3<double>> velocities,
            double dt, ThreadTeam& team);

  /// Forget the ranges, so that they hold nothing: when nodes or faces have come or gone.
  void forget() { range_.clear(); }

  std::span<const CaptureBox> ranges() const { return range_; }

  /// Hull of the ranges of a face's corners, grown by `distance`: a node comes within `distance` of the face,
  /// per axis, only while its range overlaps this.
  template <std::size_t corners>
  CaptureBox of_face(const std::array<int, corners>& nodes, double distance) const {
    CaptureBox hull = range_[static_cast<std::size_t>(nodes[0])];
    for (int node : nodes) {
      const CaptureBox& range = range_[static_cast<std::size_t>(node)];
      for (int axis = 0; axis < 3; ++axis) {
        hull.lower[axis] = range.lower[axis] < hull.lower[axis] ? range.lower[axis] : hull.lower[axis];
        hull.upper[axis] = range.upper[axis] > hull.upper[axis] ? range.upper[axis] : hull.upper[axis];
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      hull.lower[axis] -= distance;
      hull.upper[axis] += distance;
    }
    return hull;
  }

 private:
  /// Translations that put all nodes of a slice into their ranges, at the beginning and the end of a step.
  struct Translations {
    double least[2][3], most[2][3];
  };

  std::vector<CaptureBox> range_;
  std::vector<Vector3<double>> velocity_sum_;  ///< of each slice of the nodes
  std::vector<Translations> translations_;     ///< of each slice
};

}  // namespace brio
