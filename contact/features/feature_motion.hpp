#pragma once
/// Positions of the nodes of the surface at the start and at the end of a time step, and the motion bound of
/// features: by how much their distance may have decreased since they were last examined.
///
/// The distance of two features decreases by no more than the sum of their paths and that of their groups'
/// relation (motion_groups.hpp): a path is the sum over the steps of the longest displacement of a corner in
/// the frame of the group, since a point of a feature is a fixed mean of its corners. Positions move linearly
/// over a step (those of bodies that turn, along the chord), so a height above a direction that is positive
/// at both ends is positive in between.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/features/features.hpp"
#include "contact/features/motion_groups.hpp"
#include "contact/features/rigid_motion.hpp"
#include "contact/surface/slave_set.hpp"
#include "src/base/index.hpp"
#include "src/base/nodes.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// One slave node over one step.
struct alignas(64) NodeMotion64 {
  double start[4];  ///< x y z, unused
  double end[4];
};

class FeatureMotion {
 public:
  std::vector<NodeMotion64> node;          ///< of each slave node; dead ones stay at the origin
  PathAndAhead of_node, of_face, of_edge;  ///< of edges, those that are watched
  MotionGroups groups;

  /// Positions at the start of a step and, by the velocities of the nodes, at its end. The displacements to
  /// the start are added to the paths, and predicted paths of all features are formed.
  void predict(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes, double dt,
               std::span<const RigidMotion> bodies, ThreadTeam& team);
  /// Positions at the end of the step of nodes moved by contact: nodes by their corrected velocities, those
  /// of rigid bodies by their bodies'. Predicted paths stay, except for nodes that exceed their limits and
  /// the features at them, whose predicted paths are extended. \param in_contact is kept until the next
  /// prediction
  void end_by_solution(const SurfaceFeatures& features, const Surface& surface, const SlaveSet& in_contact,
                       std::span<const Vector3d> corrected, double dt, std::span<const RigidMotion> bodies,
                       ThreadTeam& team);
  /// The same where contact may have moved any node, by the velocities of all.
  void end_by_velocities(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes,
                         double dt, std::span<const RigidMotion> bodies, ThreadTeam& team);
  /// Limit of the motion of nodes in this step: a factor times their predicted displacement, and a surplus.
  void set_limits(double factor, double surplus);
  /// Whether the last positions at the end of the step were beyond the limits of any node.
  bool exceeds_limits() const { return exceeds_; }

  /// Whether the ends of nodes are those of a solution, for those that it has moved.
  bool is_solution() const { return is_solution_; }
  /// Whether the end of a node is that of a solution, and not the predicted one.
  bool is_corrected(int slave) const {
    return is_solution_ && (corrected_ == nullptr || corrected_->contains(slave));
  }

  /// Whether the ends of all nodes are as predicted but for those that `for_each_corrected` visits.
  bool knows_corrected() const { return is_solution_ && corrected_ != nullptr; }
  /// By threads, `visit(range, slave)`: slave nodes that the solution has moved, in the first of two kinds of
  /// ranges, then those of rigid bodies.
  template <class Visit>
  void for_each_corrected(ThreadTeam& team, Visit&& visit) const {
    corrected_->for_each(team, visit);
    const std::size_t first = corrected_->ranges();
    team.for_ranges(driven_.size(), driven_a_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(first + begin / driven_a_range, index(driven_[i]));
    });
  }

  /// Displacement in this step of a node in the frame of its group to its last end; 0 of those whose end is
  /// as predicted.
  double step_of_solution(int slave) const { return is_corrected(slave) ? solution_step_[index(slave)] : 0; }
  /// Whether that is more than paths look ahead.
  bool exceeds_prediction(int slave) const {
    return step_of_solution(slave) > approach_factor * way_[index(slave)].step;
  }

  /// Follow the path of an edge from this step on, until `watch_only`.
  void watch_edge(const SurfaceFeatures& features, int edge);
  /// Of the watched edges, those that are flagged.
  void watch_only(std::span<const std::uint8_t> flagged);

  /// Forget the last step.
  void forget() { known_ = false; }
  /// The surface has changed: features may have been added. \param edges new and changed ones
  void join(const SurfaceFeatures& features, const Surface& surface, const SurfaceChange& change,
            std::span<const int> edges);
  /// Paths start at zero, in new groups: all pairs are searched again.
  void restart(const SurfaceFeatures& features, const Surface& surface, ThreadTeam& team);
  std::uint64_t restarts() const { return restarts_; }

  /// Displacement in this step of the frame in which boxes are laid, and since the restart until its start.
  const double* frame() const { return frame_; }
  const double* frame_since_restart() const { return frame_sum_; }
  /// Largest coordinate: rounding is in proportion to it.
  double magnitude() const { return magnitude_; }

  Vector3d start(int slave) const { return vector_at(node[index(slave)].start); }
  Vector3d end(int slave) const { return vector_at(node[index(slave)].end); }
  Vector3d displacement(int slave) const { return end(slave) - start(slave); }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(node, of_node, of_face, of_edge, groups, way_, watched_, watched_edge_, driven_, joined_,
            limit_factor_, limit_surplus_, frame_, frame_sum_, magnitude_, restarts_, known_, exceeds_);
  }

 private:
  static constexpr std::size_t driven_a_range = 1024;
  /// Of a node, in the frame of its group.
  struct alignas(16) Way {
    double moved;  ///< from the start of the last step to that of this one; 0: nothing is known of the last
    double step;   ///< in this step
  };
  struct Sum {
    double magnitude = 0;
    bool exceeds = false;
  };

  /// Of a rigid body over the step: with it its nodes end where it takes them.
  struct BodyStep {
    Vector3d centre, displacement;
    Tensor<double> turn;  ///< less the identity
  };

  void follow_bodies(std::span<const RigidMotion> bodies, double dt, ThreadTeam& team);
  void end_of_body_node(std::size_t slave, std::size_t body);
  void set_end(std::size_t slave, const Vector3d& velocity, double dt);
  const Vector3d& frame_of(std::size_t slave) const {
    return groups.group[index(groups.of_node(static_cast<int>(slave)))].step;
  }
  bool follows(const SurfaceFeatures& features, const Surface& surface) const;
  void start_anew(const SurfaceFeatures& features, const Surface& surface);
  void move_joined(const Surface& surface, const Nodes& nodes);
  template <class Before, class After>
  void take_positions(const Surface& surface, const Nodes& nodes, double dt,
                      std::span<const RigidMotion> bodies, ThreadTeam& team, const Before& before,
                      const After& after);
  void measure_group(std::size_t group);
  void set_frame();
  void form_groups(const SurfaceFeatures& features, const Surface& surface, ThreadTeam& team);
  void find_longest(std::size_t group);
  template <class OfGroup>
  void for_groups(ThreadTeam& team, OfGroup&& of_group);
  bool raise(std::size_t slave);
  void finish_raising(const SurfaceFeatures& features, ThreadTeam& team);
  void spread(const SurfaceFeatures& features, bool with_paths, ThreadTeam& team);
  void make_room_for_watched(const SurfaceFeatures& features);

  std::vector<Way> way_;               ///< of each slave node
  std::vector<std::uint8_t> watched_;  ///< of each edge: whether it is
  std::vector<int> watched_edge_;      ///< those that are
  std::vector<double> solution_step_;  ///< likewise, of those that contact has moved in this step
  std::vector<Sum> sum_;               ///< one a range of nodes
  std::vector<BodyStep> body_;         ///< of each rigid body
  std::vector<Vector3d> position_;
  std::vector<std::pair<double, double>> of_groups_;  ///< displacement along an axis, nodes
  std::vector<int> driven_;                           ///< slave nodes of rigid bodies
  std::vector<int> joined_;                           ///< slave nodes since the last step
  double limit_factor_ = 1, limit_surplus_ = 0;
  double frame_[3] = {0, 0, 0};
  double frame_sum_[3] = {0, 0, 0};
  double magnitude_ = 0;
  std::uint64_t restarts_ = 0;
  bool known_ = false;  ///< whether the nodes' last positions are those of the step before
  bool exceeds_ = false;
  bool is_solution_ = false;             ///< whether the ends are those of a solution
  const SlaveSet* corrected_ = nullptr;  ///< nodes that it has moved; null: any
};

}  // namespace brio
