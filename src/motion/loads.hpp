#pragma once
/// External loads: gravity, nodal forces and moments, follower pressure.

#include <array>
#include <variant>
#include <vector>

#include "src/deck/deck.hpp"
#include "src/motion/energy_balance.hpp"

namespace brio {

/// Or a moment, where the load is one of moments.
struct NodeForce {
  int node;
  Vector3d force;
};

/// m g on every node.
struct GravityLoad {
  Vector3d acceleration{};
  Curve factor;
};
/// The same force, or moment, on each node of a list, or one of its own on each.
struct NodalLoad {
  std::vector<int> nodes;
  Vector3d force{};
  Curve factor;
  bool is_moment = false;
  std::vector<std::size_t> bodies{};  ///< rigid bodies on which the moment acts once
  std::vector<Vector3d> own_force{};  ///< of each node, where they differ; else empty

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(nodes, own_force);
  }
};
/// Pressure against the outward normal of quadrilateral sides; distributed to the corners by the bilinear
/// shape functions.
struct PressureLoad {
  std::vector<std::array<int, 4>> sides;
  SpaceTimeCurve pressure;
  int part = 0;
  std::vector<int> element;  ///< of the part's mesh, that each side belongs to

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(sides, element);
  }
};

struct ActiveLoad {
  std::variant<GravityLoad, NodalLoad, PressureLoad> load;
  std::vector<NodeForce> applied;  ///< of the present step

  bool is_moment() const {
    const auto* nodal = std::get_if<NodalLoad>(&load);
    return nodal != nullptr && nodal->is_moment;
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    if (auto* nodal = std::get_if<NodalLoad>(&load)) archive(*nodal);
    if (auto* pressure = std::get_if<PressureLoad>(&load)) archive(*pressure);
  }
};

/// Adds the forces at this time to nodes.force, moments to nodes.moment; those on rigid bodies are theirs
/// (rigid.hpp).
void apply(ActiveLoad& load, double time, Nodes& nodes);

/// Sum of force . velocity, of forces on nodes, with the present velocities.
double power(const ActiveLoad& load, const Nodes& nodes);

/// Force and moment about the origin.
Impulse resultant(const ActiveLoad& load, const Nodes& nodes);

}  // namespace brio
