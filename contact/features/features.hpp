#pragma once
/// The features of a contact surface between which distances are kept: its nodes, its edges and its faces.
///
/// An edge is a side or a diagonal of a face, a beam, or a single point (a particle; where there are beams,
/// also a node of a face). Both diagonals of a quadrilateral are edges and the face is the convex hull of its
/// corners: what stays outside of the hull crosses none of its triangulations, and mirror images are treated
/// alike.
///
/// Every feature has a radius: half the thickness of a shell, the radius of a beam or a particle, and for
/// solids a skin, a small thickness outside of the mesh (`skin_share`).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/options.hpp"
#include "contact/surface/surface.hpp"
#include "contact/surface/surface_topology.hpp"
#include "src/base/lists.hpp"
#include "src/base/nodes.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// The diagonal of a face is that from its first corner; the other one is its cross diagonal. None: the edge
/// is no more, and its number is free.
enum class EdgeKind : std::uint8_t { side, diagonal, cross_diagonal, beam, particle, node, none };

struct EdgeFeature {
  std::array<int, 2> node{};  ///< slave indices, ascending; the same twice: a point
  std::array<int, 2> face{-1, -1};
  /// Slave indices of the other corners of the faces that meet here, the opposite ones of a diagonal; -1
  std::array<int, 4> wing{-1, -1, -1, -1};
  int part = 0;
  int body = 0;
  int round = -1;  ///< of a beam or particle, in Surface::round
  EdgeKind kind = EdgeKind::side;
  bool shell = false;
  std::uint8_t faces = 0;  ///< number of adjacent faces, at most 255
  double radius = 0;

  bool is_point() const { return node[0] == node[1]; }
  bool of_face() const { return kind <= EdgeKind::cross_diagonal; }
  bool is_diagonal() const { return kind == EdgeKind::diagonal || kind == EdgeKind::cross_diagonal; }
  bool alive() const { return kind != EdgeKind::none; }
  /// A side between two faces.
  bool joins_faces() const { return kind == EdgeKind::side && faces == 2 && face[1] >= 0; }
  /// Opposite sides of a face do, as neither is a diagonal.
  bool shares_face(const EdgeFeature& other) const {
    const auto has = [&](int f) { return f >= 0 && (f == other.face[0] || f == other.face[1]); };
    return has(face[0]) || has(face[1]);
  }
};

/// Of a constraint of two edges: Contact::node.
constexpr std::array<int, 5> nodes_of_edges(const std::array<int, 2>& a, const std::array<int, 2>& b) {
  return {a[0], a[1], b[0], b[1], b[1]};
}

/// Distances below this fraction of the smallest edge have no direction.
inline constexpr double no_distance = 1e-12;

struct SurfaceFeatures {
  double smallest_edge = 0;  ///< of the surface as built: the scale of skins and bands
  double mean_edge = 0;      ///< as built
  double skin = 0;           ///< contact radius of solids
  std::vector<EdgeFeature> edge;
  bool all_of_faces = true;                          ///< no edge is a beam or a point
  std::vector<std::array<int, 4>> edge_of_face;      ///< sides by corner; -1: none
  std::vector<std::array<int, 2>> diagonal_of_face;  ///< both diagonals; -1: none
  std::vector<int> edge_of_round;                    ///< of each beam and particle
  std::vector<std::array<Vector3d, 2>> drawn_beam;   ///< ends of each beam and particle as drawn
  std::vector<int> point_of_node;                    ///< of each slave node, where there are beams; -1: none
  std::vector<std::array<int, 4>> face_node;         ///< slave indices of the corners; of dead faces node 0
  std::vector<std::array<int, 2>> edge_node;         ///< EdgeFeature::node side by side
  std::vector<double> edge_radius;                   ///< EdgeFeature::radius side by side
  std::vector<double> node_radius;                   ///< of each slave node
  std::vector<double> face_radius;                   ///< of each face
  Lists ring;  ///< of each slave node: those at the other ends of its sides and beams, ascending
  std::vector<int> retired, free;  ///< numbers of edges that are no more: of the last update, and of before

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(edge, all_of_faces, edge_of_face, diagonal_of_face, edge_of_round, point_of_node, face_node,
            edge_node, edge_radius, node_radius, face_radius, ring, retired, free);
  }
};

/// Skin of a solid, over the smallest edge of the surface: two solids are in contact at twice that distance.
inline constexpr double skin_share = 0.002;

/// Scales of the surface as built.
void measure(SurfaceFeatures& features, const Surface& surface, const Nodes& nodes);

/// Collect edges, radii and rings again, in an order that depends on the surface alone.
void collect(SurfaceFeatures& features, const Surface& surface, const ContactOptions& options);

/// Update after a deletion; edges keep their numbers. \param changed_edges replaced by the numbers of those
/// that are new, that have changed, or that are no more; those of no more are given away by the next update
/// at the earliest
void update(SurfaceFeatures& features, const Surface& surface, const ContactOptions& options,
            const SurfaceChange& change, std::vector<int>& changed_edges);

}  // namespace brio
