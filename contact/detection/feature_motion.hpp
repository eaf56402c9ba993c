#pragma once
/// Where the nodes of the surface are at the start and at the end of a step, and how much nearer to each
/// other features may have come since they were last looked at.
///
/// In a frame that moves with the mean displacement of the nodes, the distance of two features shrinks by no
/// more than the sum of their paths: a path is the sum over the steps of the longest displacement of a
/// corner, since a point of a feature is a fixed mean of its corners. Positions move linearly over a step
/// (bodies that turn: along the chord), so a height above a direction that is positive at both ends is
/// positive in between.

#include <span>
#include <vector>

#include "contact/detection/features.hpp"
#include "contact/rigid_motion.hpp"
#include "contact/slave_set.hpp"
#include "contact/solve.hpp"
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
  std::vector<NodeMotion64> node;  ///< of each slave node; dead ones stay at the origin

  /// Positions at the start of a step; the displacements to them enter the paths.
  void begin(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes, ThreadTeam& team);
  /// Positions at the end of the step by the velocities of the nodes, and the displacements of this step.
  void end_by_velocity(const SurfaceFeatures& features, const Surface& surface, const Nodes& nodes, double dt,
                       std::span<const RigidMotion> bodies, ThreadTeam& team);

  /// Positions at the end of the step of what contact has moved: nodes by their corrected velocities, those
  /// of rigid bodies by their bodies'.
  void end_by_solution(const SurfaceFeatures& features, const Surface& surface, const SlaveSet& in_contact,
                       std::span<const ContactMotion> corrected, double dt,
                       std::span<const RigidMotion> bodies, ThreadTeam& team);
  /// Keep by how much nodes may move in this step: a factor times the present displacement and a surplus.
  void set_limits(double factor, double surplus);
  /// Whether any node moves by more.
  bool exceeds_limits() const;

  /// The surface has changed: nothing is known of the last step.
  void forget() { known_ = false; }
  /// Paths start at zero: pairs are found anew.
  void restart(const SurfaceFeatures& features, const Surface& surface);

  double node_path(int slave) const { return node_path_[index(slave)]; }
  double face_path(int face) const { return face_path_[index(face)]; }
  double edge_path(int edge) const { return edge_path_[index(edge)]; }
  /// Displacement in this step, in the frame: of a node, the longest of the corners of a face or an edge.
  double node_step(int slave) const { return node_step_[index(slave)]; }
  double face_step(int face) const { return face_step_[index(face)]; }
  double edge_step(int edge) const { return edge_step_[index(edge)]; }
  /// Displacement of the frame in this step, and since the restart until its start.
  const double* frame() const { return frame_; }
  const double* frame_since_restart() const { return frame_sum_; }
  /// Largest coordinate: rounding is in proportion to it.
  double magnitude() const { return magnitude_; }

  Eigen::Vector3d start(int slave) const { return Eigen::Vector3d(node[index(slave)].start); }
  Eigen::Vector3d end(int slave) const { return Eigen::Vector3d(node[index(slave)].end); }
  Eigen::Vector3d displacement(int slave) const { return end(slave) - start(slave); }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void end_of_body_node(std::size_t slave, const RigidMotion& body, double dt);
  void measure_steps(const SurfaceFeatures& features, const Surface& surface, ThreadTeam& team);

  struct Sum {
    double displacement[3] = {0, 0, 0};
    double magnitude = 0;
    double count = 0;
  };
  std::vector<double> node_path_, face_path_, edge_path_, node_step_, face_step_, edge_step_, limit_;
  std::vector<Sum> sum_;  ///< one a range of nodes
  double frame_[3] = {0, 0, 0};
  double frame_sum_[3] = {0, 0, 0};
  double magnitude_ = 0;
  bool known_ = false;  ///< whether the nodes' last positions are those of the step before
};

}  // namespace brio
