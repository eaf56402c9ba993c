#pragma once
/// The contact surface of a mesh, found without any side set: every hexahedron side that no other hexahedron
/// shares, every shell (one face stands for both of its sides, by its thickness), every beam (a segment with
/// a radius), every particle (a point with a radius), and the nodes of all as slave nodes.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "contact/surface/pair_table.hpp"
#include "contact/surface/tied_pairs.hpp"
#include "src/base/index.hpp"
#include "src/base/lists.hpp"

namespace brio {

/// Input of the surface: the elements of one part.
struct SurfacePart {
  std::string name;
  /// 8: hexahedra in VTK's order; 4: shells; repeated nodes degenerate them. 2: beams. 1: particles
  int nodes_per_element = 8;
  std::span<const int> connectivity;  ///< global node numbers, nodes_per_element of each element
  std::vector<double> thickness;      ///< of each shell, diameter of each beam or particle; else empty
  int rigid = -1;                     ///< the rigid body that all of its nodes belong to
  double debris_radius = 0;           ///< contact radius of its free nodes; 0: no contact

  bool solid() const { return nodes_per_element == 8; }
  bool shell() const { return nodes_per_element == 4; }
  bool round() const { return nodes_per_element <= 2; }
};

/// A beam as a capsule (segment with a radius), or a particle as a sphere.
struct RoundElement {
  std::array<int, 2> node{};  ///< global; the same twice: a particle
  int part = 0;               ///< -1: it is no more
  int body = 0;
  double radius = 0;

  bool alive() const { return part >= 0; }
  bool is_point() const { return node[0] == node[1]; }
};

struct Face {
  std::array<int, 4> node;  ///< global, counterclockwise from outside; a triangle repeats its third node
  int part = 0;             ///< -1: the face is no more; its nodes stay known to the contacts it had
  int element = 0;          ///< within its part
  int body = 0;             ///< elements connected through nodes are one body
  bool shell = false;
  std::uint8_t side = 0;  ///< of its element

  bool alive() const { return part >= 0; }
  bool has(int global_node) const {
    return node[0] == global_node || node[1] == global_node || node[2] == global_node ||
           node[3] == global_node;
  }
  int corners() const { return node[3] == node[2] ? 3 : 4; }
};

struct Surface {
  std::vector<std::string> part_name;
  /// As built ordered by part (those of hexahedra first), element, side; after deletions in no order, with
  /// dead ones among them.
  std::vector<Face> face;
  std::vector<double> thickness;  ///< of each face; 0 for sides of hexahedra
  std::vector<std::array<int, 4>>
      neighbor;                        ///< face across the edge from corner k to the next; -1: free edge
  std::vector<int> node;               ///< global numbers of the slave nodes, as built ascending; -1: no more
  std::vector<int> slave_of;           ///< of each global node: its index in `node`; -1: not on the surface
  std::vector<double> radius;          ///< of each slave node: half the mean thickness of its shells
  std::vector<std::uint8_t> of_solid;  ///< of each slave node: 1 where it belongs to a side of a hexahedron
  std::vector<std::uint8_t> pinched;   ///< of each slave node: 1 where separate fans of sides meet in it
  std::vector<int> body;               ///< of each slave node
  std::vector<RoundElement> round;     ///< by part, element
  /// Of each slave node: the largest radius of its beams and particles, and how many of them live; empty
  /// where there are none.
  std::vector<double> round_radius;
  std::vector<int> rounds;
  Lists faces_of;  ///< of each slave node: the faces it belongs to, ascending
  int body_count = 0;
  std::vector<int> rigid_of_node;  ///< of each global node: its rigid body, or -1; empty where there is none
  PairTable pairs;                 ///< rules for pairs of parts
  TiedPairs tied;                  ///< pairs excluded because they are tied

  /// -1: none.
  int rigid_body(int global_node) const {
    return rigid_of_node.empty() || global_node < 0 ? -1 : rigid_of_node[index(global_node)];
  }
  /// The body that all of the nodes belong to; -1: none.
  template <std::size_t Count>
  int rigid_body_of_all(const std::array<int, Count>& global_nodes) const {
    const int one = rigid_body(global_nodes[0]);
    for (std::size_t k = 1; one >= 0 && k < Count; ++k)
      if (rigid_body(global_nodes[k]) != one) return -1;
    return one;
  }
  /// Excluded are contact of a rigid body with itself, pairs of parts by rules, and tied pairs.
  bool never_touch(int slave, const Face& other) const {
    const int global_node = node[index(slave)];
    const int own = rigid_body(global_node);
    return (own >= 0 && own == rigid_body_of_all(other.node)) || pairs.apart(global_node, other.part) ||
           (!tied.empty() && is_tied(slave, other));
  }
  /// Whether a node and a face belong to a tie: the node to its face's part, or a corner to the node's part.
  bool is_tied(int slave, const Face& other) const {
    if (tied.apart(node[index(slave)], other.part)) return true;
    for (int corner : other.node)
      if (const int main_part = tied.main_part[index(corner)]; main_part >= 0)
        for (int f : faces_of.of(slave))
          if (face[index(f)].part == main_part) return true;
    return false;
  }

  /// Largest radius of the beams and particles of a slave node; 0: it has none.
  double radius_of_rounds(int slave) const { return round_radius.empty() ? 0 : round_radius[index(slave)]; }

  std::size_t slaves() const { return node.size(); }
  int slave(int global_node) const { return slave_of[index(global_node)]; }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(face, thickness, neighbor, node, slave_of, radius, of_solid, pinched, body, round, round_radius,
            rounds, faces_of, body_count, tied);
  }
};

/// \throws std::invalid_argument when a shell has no thickness or a node number is out of range.
Surface make_surface(std::span<const SurfacePart> parts, std::size_t node_count);

/// Find the neighbours of a face, from `faces_of`.
void connect(Surface& surface, int face);

/// Update the data of a slave node from its faces and their neighbours.
void update_slave(Surface& surface, int slave);

/// The sides of hexahedra around a node that follow a face over the edges that end there: those of one wedge
/// of solid. Where solids touch in nothing but the node there are several such fans.
template <class Visit>
void for_fan(const Surface& surface, int slave, int face, const Visit& visit) {
  const int node = surface.node[index(slave)];
  int f = face;
  for (std::size_t left = surface.faces_of.of(slave).size(); left > 0 && f >= 0; --left) {
    visit(f);
    const Face& own = surface.face[index(f)];
    std::size_t corner = 0;
    while (corner < 3 && own.node[corner] != node) ++corner;
    f = surface.neighbor[index(f)][corner];
    if (f == face) break;
  }
}

}  // namespace brio
