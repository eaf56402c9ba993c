#pragma once
/// How much nearer to each other slave nodes and faces may have come since they were last compared.
///
/// In any frame common to all nodes, the distance of a node from a face shrinks by no more than the path of
/// the node plus the longest path of the corners of the face, since every point of a face is a mean of its
/// corners. The same holds for how far constraints look ahead, with velocities in place of paths. The frame
/// is that of the mean velocity: a few fast nodes leave it where it is. Paths are summed from the positions
/// that nodes really took. What is said of a node and any face needs no look at the face; what is said of a
/// pair lasts longer where something else is fast.

#include <span>
#include <vector>

#include "contact/surface.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// Constraints are formed ahead of touching, over what the present approach speed would cover: other impulses
/// of the same step may double it.
inline constexpr double approach_share = 2;

/// Per-axis extent of the motion of slave nodes.
struct Spread {
  double lower[3];
  double upper[3];
  double width(int axis) const { return upper[axis] - lower[axis]; }
  double middle(int axis) const { return 0.5 * (lower[axis] + upper[axis]); }
};

class Travel {
 public:
  /// Take over the positions and velocities of the slave nodes; once a step.
  /// \param since  positions that displacements are measured from, of each slave node; may be empty
  void follow(const Surface& surface, const Nodes& nodes, std::span<const Vector3<double>> since, double dt,
              ThreadTeam& team);

  /// Slave nodes that have come to the surface since the last step, or taken the numbers of others.
  void join(const Surface& surface, const Nodes& nodes, std::span<const int> slaves);

  /// Paths start again at zero.
  void restart();

  double dt() const { return dt_; }
  const Spread& velocities() const { return range_.velocity; }
  /// Velocity of the frame of this step.
  double frame(int axis) const { return frame_[axis]; }
  /// Displacements, now and as far ahead as constraints look; meaningless without positions to measure from.
  const Spread& displacements() const { return range_.displacement; }
  const Spread& displacements_ahead() const { return range_.ahead; }

  /// By how much at most a slave node has come nearer to any face since the restart.
  double so_far(int slave) const { return path_[static_cast<std::size_t>(slave)] + path_of_faces_; }
  /// By how much at most it may come nearer as far ahead as constraints look.
  double ahead(int slave) const { return ahead_[static_cast<std::size_t>(slave)] + ahead_of_faces_; }
  /// The part of a corner's path in that of a face, and of what it may move ahead.
  double path(int slave) const { return path_[static_cast<std::size_t>(slave)]; }
  double own_ahead(int slave) const { return ahead_[static_cast<std::size_t>(slave)]; }
  /// The same as so_far and ahead, for a face of which the longest path and ahead of a corner are known.
  double so_far(int slave, double path_of_face) const { return path(slave) + (path_of_face + margin_); }
  double ahead(int slave, double ahead_of_face) const {
    return own_ahead(slave) + (ahead_of_face + ahead_margin_);
  }
  /// The same of two lines, of each of which the longest path and ahead of a node are known.
  double so_far_of(double path, double other_path) const { return path + (other_path + margin_); }
  double ahead_of(double ahead, double other_ahead) const { return ahead + (other_ahead + ahead_margin_); }
  /// Allowance for the rounding of distances and paths.
  double rounding() const { return rounding_; }

 private:
  struct Range {
    Spread velocity, displacement, ahead;
    double sum[3];  ///< of velocities
    double count;
    double longest_move;  ///< in the frame
    double fastest;       ///< in the frame
    double magnitude;     ///< of positions, and of displacements in a step
    void include(const Range& other);
  };
  Range follow_range(const Surface& surface, const Nodes& nodes, std::span<const Vector3<double>> since,
                     std::size_t begin, std::size_t end);

  std::vector<Vector3<double>> position_;  ///< of each slave node in the last step
  std::vector<double> path_;
  std::vector<double> ahead_;
  std::vector<Range> piece_;
  Range range_{};
  double margin_ = 0;                 ///< for the rounding of paths
  double ahead_margin_ = 0;           ///< for the turn of the frame, and rounding
  double frame_[3] = {0, 0, 0};       ///< velocity of the frame of the last step
  double frame_move_[3] = {0, 0, 0};  ///< its displacement until now
  double dt_ = 0;
  double path_of_faces_ = 0;
  double ahead_of_faces_ = 0;
  double rounding_ = 0;
};

}  // namespace brio
