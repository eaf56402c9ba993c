#pragma once
/// Pairs that are excluded from contact because they are one piece.

#include <vector>

#include "contact/surface/surface.hpp"
#include "contact/surface/surface_topology.hpp"
#include "src/base/nodes.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// The excluded faces of each slave node, ascending:
/// - faces it belongs to, and the other sides of their elements;
/// - for shells also the faces that can be reached along the shell within pi/2 of the contact thickness
///   in the reference configuration. A shell of thickness t cannot be folded to a middle radius below t/2; on
///   that tightest fold points an arc s < pi/2 t apart have a chord t sin(s/t) < t without touching. The rule
///   follows from the thickness alone, so that the result does not depend on the mesh.
Lists excluded_faces(const Surface& surface, const Nodes& reference);

/// Whether the face is among the excluded ones of the slave.
bool is_excluded(const Lists& excluded, int slave, int face);

/// Walks over shells from slave nodes.
class ShellWalk {
 public:
  /// Add the faces that a slave reaches within its tightest fold.
  /// \param reference position of each global node
  template <class Reference>
  void add_fold(const Surface& surface, const Reference& reference, int slave, std::vector<int>& found);
  /// Replace `slaves` by those that are reached over faces within a distance of a slave, itself among them.
  template <class Reference>
  void reach(const Surface& surface, const Reference& reference, int from, double distance,
             std::vector<int>& slaves);

 private:
  template <class Reference, class Within>
  void spread(const Surface& surface, const Reference& reference, int slave, const Within& within);

  std::vector<int> visited_;  ///< of each face, in which walk
  int walk_ = 0;
  std::vector<int> front_;
};

/// Updates the exclusions of an eroding surface. After a shell is torn along excluded faces, both sides of
/// the tear may be nearer than their thickness: such pairs wait until their distance has once reached it
/// (feature_pairs.hpp).
class ErodingExclusion {
 public:
  ErodingExclusion(const Surface& surface, const Nodes& reference);

  /// \returns the slave nodes whose lists may have changed, ascending
  const std::vector<int>& mend(Lists& excluded, const Surface& surface, const SurfaceTopology& topology,
                               const SurfaceChange& change);

 private:
  void mend_slave(Lists& excluded, const Surface& surface, const SurfaceTopology& topology, int slave);
  void add_around_tear(const Lists& excluded, const Surface& surface, const SurfaceChange& change);

  std::vector<Vector3d> reference_;  ///< of each global node; empty where there are no shells
  double longest_fold_ = 0;
  ShellWalk walk_;
  std::vector<int> affected_, found_, reached_, kept_;
};

}  // namespace brio
