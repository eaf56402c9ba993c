// Deletion of elements from a surface: faces that they lay open, slave nodes, and bodies that part.

#include <algorithm>

#include "contact/surface/body_pieces.hpp"
#include "contact/surface/surface_topology.hpp"
#include "src/base/disjoint_sets.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// One deletion.
class Deletion {
 public:
  Deletion(Surface& surface, SurfaceTopology& topology, SurfaceChange& change)
      : surface_(surface), topology_(topology), change_(change) {}

  void run(std::span<const SurfaceElement> deleted) {
    surface_.faces_of.loosen();
    for (const SurfaceElement& d : deleted) {
      const int element = topology_.part[index(d.part)].first_element + d.element;
      if (topology_.body[index(element)] < 0) continue;
      removed_.push_back(element);
      for (int node : nodes_of(topology_, element)) corner_.push_back(node);
    }
    sort_out(removed_);
    sort_out(corner_);
    // Those that hang together go at once, cluster after cluster: only so are splits found one by one.
    DisjointSets clusters(corner_.size());
    for (int element : removed_)
      for (int node : nodes_of(topology_, element))
        clusters.join(place_of(first_node(element)), place_of(node));
    std::vector<std::pair<int, int>> order;
    for (int element : removed_) order.emplace_back(clusters.root(place_of(first_node(element))), element);
    std::sort(order.begin(), order.end());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      removed_.clear();
      for (end = begin; end < order.size() && order[end].first == order[begin].first; ++end)
        removed_.push_back(order[end].second);
      remove_cluster();
    }
    std::sort(change_.changed_slave.begin(), change_.changed_slave.end());
  }

 private:
  int& state(int side) { return topology_.side[index(side)]; }
  Face& face(int f) { return surface_.face[index(f)]; }

  int first_node(int element) const { return nodes_of(topology_, element)[0]; }
  // Place of a node among those of the deleted elements, or -1.
  int place_of(int node) const {
    const auto at = std::lower_bound(corner_.begin(), corner_.end(), node);
    return at != corner_.end() && *at == node ? static_cast<int>(at - corner_.begin()) : -1;
  }

  void remove_cluster() {
    corner_.clear();
    exposed_.clear();
    touched_.clear();
    for (int element : removed_) remove(element);
    for (int side : exposed_)
      if (state(side) == side_state::alone) add_face(side);
    settle();
    sort_out(corner_);
    if (!topology_.debris.empty()) bring_up_debris();
    look_for_split();
  }

  void remove(int element) {
    topology_.body[index(element)] = -1;
    for (int node : nodes_of(topology_, element)) {
      corner_.push_back(node);
      if (!topology_.debris.empty()) --topology_.debris[index(node)].elements;
    }
    const TopologyPart& part = part_of_element(topology_, element);
    const int first = part.first_side + part.sides() * (element - part.first_element);
    for (int side = first; side < first + part.sides(); ++side) {
      ++topology_.visits;
      const int was = state(side);
      if (side_state::is_face(was))
        remove_face(side_state::face_of(was));
      else if (was >= 0)
        leave_ring(side);
      state(side) = side_state::none;
    }
    if (part.round()) remove_round(part.first_round + element - part.first_element);
  }

  void remove_round(int number) {
    change_.dead_round.push_back(number);
    RoundElement& element = surface_.round[index(number)];
    for (int k = 0; k < (element.is_point() ? 1 : 2); ++k) {
      const int slave = surface_.slave(element.node[index(k)]);
      int& left = surface_.rounds[index(slave)];
      if (--left == 0) lose_radius(slave);
      touched_.push_back(slave);
    }
    element.part = -1;
  }

  void lose_radius(int slave) {
    const auto s = index(slave);
    surface_.radius[s] = surface_.round_radius[s];  // that debris begins with
    surface_.round_radius[s] = 0;
  }

  void leave_ring(int side) {
    int before = side;
    while (state(before) != side) {
      before = state(before);
      ++topology_.visits;
    }
    const int next = state(side);
    state(before) = next;
    if (before != next) return;
    state(before) = side_state::alone;
    exposed_.push_back(before);
  }

  void remove_face(int f) {
    change_.dead_face.push_back(f);
    if (!face(f).shell) topology_.faces.retired.push_back(f);
    for (int k = 0; k < face(f).corners(); ++k) {
      const int slave = surface_.slave(face(f).node[index(k)]);
      surface_.faces_of.erase(slave, f);
      touched_.push_back(slave);
    }
    face(f).part = -1;
    face(f).shell = false;
    topology_.visits += 4;
  }

  void add_face(int side) {
    const TopologyPart& part = part_of_side(topology_, side);
    const int local = side - part.first_side;
    Face added{.node = {},
               .part = static_cast<int>(&part - topology_.part.data()),
               .element = local / sides_of_hexahedron,
               .side = static_cast<std::uint8_t>(local % sides_of_hexahedron)};
    nodes_of_side(part, side, added.node);
    added.body = topology_.body[index(part.first_element + added.element)];
    const int f = face_number();
    face(f) = added;
    surface_.thickness[index(f)] = 0;
    state(side) = side_state::of_face(f);
    change_.new_face.push_back(f);
    for (int k = 0; k < added.corners(); ++k) {
      const int slave = slave_at(added.node[index(k)], added);
      surface_.faces_of.insert(slave, f);
      touched_.push_back(slave);
    }
    topology_.visits += 4;
  }

  int face_number() {
    if (!topology_.faces.free.empty()) {
      const int f = topology_.faces.free.back();
      topology_.faces.free.pop_back();
      return f;
    }
    surface_.face.emplace_back();
    surface_.thickness.push_back(0);
    surface_.neighbor.push_back({-1, -1, -1, -1});
    return static_cast<int>(surface_.face.size()) - 1;
  }

  int slave_at(int node, const Face& of) {
    int& slave = surface_.slave_of[index(node)];
    if (slave >= 0) return slave;
    slave = slave_number();
    const auto s = index(slave);
    surface_.node[s] = node;
    surface_.body[s] = of.body;
    change_.new_slave.push_back(slave);
    return slave;
  }

  int slave_number() {
    if (!topology_.slaves.free.empty()) {
      const int s = topology_.slaves.free.back();
      topology_.slaves.free.pop_back();
      return s;
    }
    surface_.node.push_back(-1);
    surface_.body.push_back(-1);
    surface_.radius.push_back(0);
    surface_.of_solid.push_back(0);
    surface_.pinched.push_back(0);
    if (!surface_.rounds.empty()) {
      surface_.round_radius.push_back(0);
      surface_.rounds.push_back(0);
    }
    surface_.faces_of.add_list();
    return static_cast<int>(surface_.slaves()) - 1;
  }

  // Slave nodes whose faces changed, and the neighbours of the faces around them.
  void settle() {
    sort_out(touched_);
    for (int slave : touched_)
      for (int f : surface_.faces_of.of(slave)) {
        connect(surface_, f);
        ++topology_.visits;
      }
    for (int slave : touched_) {
      const bool round = !surface_.rounds.empty() && surface_.rounds[index(slave)] > 0;
      if (surface_.faces_of.of(slave).empty() && !round) {
        leave(slave);
        continue;
      }
      update_slave(surface_, slave);
      change_.changed_slave.push_back(slave);
    }
  }

  // Radius of a node that has become debris; 0 of others.
  double debris_radius(int node) const {
    if (topology_.debris.empty()) return 0;
    const DebrisNode& debris = topology_.debris[index(node)];
    return debris.elements == 0 ? debris.radius : 0;
  }

  void become_debris(int slave, double radius) {
    const auto s = index(slave);
    surface_.of_solid[s] = 0;
    surface_.pinched[s] = 0;
    surface_.radius[s] = std::min(surface_.radius[s], radius);
    surface_.body[s] = -1;
    change_.changed_slave.push_back(slave);
    change_.debris.push_back(slave);
  }

  // Nodes of a cluster that never were on the surface.
  void bring_up_debris() {
    for (int node : corner_) {
      const double radius = debris_radius(node);
      if (radius == 0 || surface_.slave(node) >= 0) continue;
      const int slave = slave_number();
      surface_.slave_of[index(node)] = slave;
      surface_.node[index(slave)] = node;
      surface_.radius[index(slave)] = 0;
      change_.new_slave.push_back(slave);
      become_debris(slave, radius);
    }
  }

  // A node left without faces.
  void leave(int slave) {
    const auto s = index(slave);
    if (const double radius = debris_radius(surface_.node[s]); radius > 0) {
      become_debris(slave, radius);
      return;
    }
    surface_.of_solid[s] = 0;
    surface_.pinched[s] = 0;
    surface_.radius[s] = 0;
    surface_.body[s] = -1;
    surface_.slave_of[index(surface_.node[s])] = -1;
    surface_.node[s] = -1;
    change_.dead_slave.push_back(slave);
    topology_.slaves.retired.push_back(slave);
  }

  // A living element at a node, or -1.
  int element_at(int node) const {
    int found = -1;
    for_hexahedra_under_shells(topology_, node, [&](int element) { found = element; });
    const int slave = surface_.slave(node);
    if (slave < 0 || surface_.faces_of.of(slave).empty()) return found;
    return element_of(topology_, surface_.face[index(surface_.faces_of.of(slave)[0])]);
  }

  // Nothing has split if all nodes left of a cluster are still connected among themselves through faces
  // around; else something may have.
  void look_for_split() {
    const int count = static_cast<int>(corner_.size());
    DisjointSets connected(corner_.size());
    for (int i = 0; i < count; ++i) {
      const int slave = surface_.slave(corner_[index(i)]);
      if (slave < 0) continue;
      for (int f : surface_.faces_of.of(slave))
        for (int node : face(f).node) {
          ++topology_.visits;
          if (const int other = place_of(node); other >= 0) connected.join(i, other);
        }
    }
    std::vector<int> pieces;  // by one element each
    for (int i = 0; i < count; ++i)
      if (const int element = element_at(corner_[index(i)]); element >= 0 && connected.root(i) == i)
        pieces.push_back(element);
    if (pieces.size() > 1) change_.split |= separate_pieces(surface_, topology_, pieces);
  }

  Surface& surface_;
  SurfaceTopology& topology_;
  SurfaceChange& change_;
  std::vector<int> removed_;  // elements of a cluster
  std::vector<int> corner_;   // their nodes
  std::vector<int> exposed_;  // sides that stand alone now
  std::vector<int> touched_;  // slave nodes that lost or gained a face
};

}  // namespace

void delete_elements(Surface& surface, SurfaceTopology& topology, std::span<const SurfaceElement> deleted,
                     SurfaceChange& change) {
  change.clear();
  if (!deleted.empty()) Deletion(surface, topology, change).run(deleted);
}

}  // namespace brio
