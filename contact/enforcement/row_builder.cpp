#include "contact/enforcement/row_builder.hpp"

#include <algorithm>
#include <cmath>

#include "contact/geometry/eigen_conversions.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

namespace {

/// The couple of a side is distributed to its faces by the squares of the cosines of their normals; below
/// this fraction of the largest they get none.
constexpr double least_share = 1e-9;
/// Faces whose squared cosines are all below this are parallel to the normal: their tilt is negligible.
constexpr double standing = 0.01;
/// What turns with the nodes sees at least this share of the relative velocity, squared, or is not asked.
constexpr double least_share_left = 0.1;
/// Of that, what is not prescribed: less is a lever (`held_share` of the solver).
constexpr double least_share_free = 1e-6;

/// Degrees of freedom that resist the couple of a side.
enum class Couple { none, faces, rotations, rigid };

/// One side of a contact: its closest point as a mean of nodes.
struct SidePoint {
  std::array<int, 4> node{};  ///< global
  std::array<double, 4> weight{};
  std::size_t count = 0;
  int body = -1;  ///< rigid, of all its nodes
  Couple couple = Couple::none;
  Vector3d point{};
  double radius = 0;
  std::size_t number = 0;  ///< 0 or 1
  double upright = -1;     ///< largest squared cosine of a normal of its faces; negative: not known
};

class Builder {
 public:
  Builder(RowPiece& piece, const RowSources& sources)
      : piece_(piece), rows_(piece.rows), sources_(sources), unknowns_(unknowns_of(sources)) {}

  void add(const Contact& contact) {
    const auto own = index(contact.own);
    SidePoint first = side_of(contact, 0, own), second = side_of(contact, own, 5);
    second.number = 1;
    normal_ = contact.normal;
    if (contact.along_meeting && add_without_spin(contact, first, second)) return;
    const bool rubs = contact.friction_coefficient > 0 && divide(contact, first, second);
    ConstraintRow& row = rows_.add_row(normal_, contact.gap, rubs ? contact.friction_coefficient : 0);
    row.impulse = contact.impulse;
    if (rubs) row.friction = contact.friction;
    if (!rubs) height_[0] = height_[1] = 0;
    add_side(first, 1, height_[0], first.point - height_[0] * normal_);
    add_side(second, -1, height_[1], second.point + height_[1] * normal_);
  }

  void add(const NodeAtWall& touch, const ContactWall& wall) {
    const int node = sources_.surface.node[index(touch.slave)];
    const Vector3d x = position(sources_.nodes, node);
    normal_ = wall.normal;
    ConstraintRow& row = rows_.add_row(normal_, dot(wall.normal, x - wall.point), wall.friction);
    row.impulse = touch.impulse;
    row.friction = touch.friction;
    row.wall = touch.wall;
    row.wall_velocity = wall.velocity;
    row.point = x;
    if (const int body = sources_.surface.rigid_body(node); body >= 0) {
      const int unknown = unknowns_.body(body);
      rows_.add_rigid_body(unknown, unknown + 1, x - centre(body), Side::first);
    } else {
      add_node(node, 1);
    }
  }

 private:
  SidePoint side_of(const Contact& contact, std::size_t begin, std::size_t end) const {
    SidePoint side;
    bool turns = true;
    for (std::size_t k = begin; k < end; ++k) {
      const double weight = static_cast<int>(k) < contact.own ? contact.weight[k] : -contact.weight[k];
      if (weight == 0) continue;
      const int node = sources_.surface.node[index(contact.node[k])];
      const int body = sources_.surface.rigid_body(node);
      side.body = side.count == 0 || side.body == body ? body : -1;
      turns = turns && this->turns(node);
      side.node[side.count] = node;
      side.weight[side.count++] = weight;
      side.point += weight * position(sources_.nodes, node);
      side.radius += weight * sources_.features.node_radius[index(contact.node[k])];
    }
    side.couple = side.body >= 0 ? Couple::rigid
                  : turns        ? Couple::rotations
                  : sources_.surface.faces_of.of(sources_.surface.slave(heaviest_of(side))).empty()
                      ? Couple::none
                      : Couple::faces;
    return side;
  }

  // Square of what of a vector is not prescribed.
  double free_square(int node, const Vector3d& seen) const {
    if (sources_.surface.rigid_body(node) >= 0 || sources_.ties.is_tied(node)) return squared_norm(seen);
    if (sources_.nodes.record[index(node)].inverse_mass == 0) return 0;
    return dot(seen, sources_.nodes.free_translations(index(node)) * seen);
  }
  bool turns(int node) const {
    if (!sources_.nodes.has_rotations()) return false;
    if (const Tie* tie = tie_of(node); tie != nullptr && tie->turning) return true;
    return sources_.nodes.rotational_inertia[index(node)] > 0;
  }
  const Tie* tie_of(int node) const {
    return sources_.ties.is_tied(node) ? &sources_.ties.node[index(sources_.ties.of_node[index(node)])].tie
                                       : nullptr;
  }

  // How far the contact point stands off both sides. \returns whether there is a place for it.
  bool divide(const Contact& contact, SidePoint& first, SidePoint& second) {
    const double distance = dot(normal_, first.point - second.point);
    const double share = first_share(contact, first, second);
    if (share < 0) return false;
    height_[0] = share * distance;
    height_[1] = distance - height_[0];
    if (can_take(first, height_[0]) && can_take(second, height_[1])) return true;
    // Faces that stand along the normal.
    for (const bool all_to_first : {true, false}) {
      height_[0] = all_to_first ? distance : 0;
      height_[1] = distance - height_[0];
      if (can_take(first, height_[0]) && can_take(second, height_[1])) return true;
    }
    return false;
  }

  // Of the distance; negative: neither side takes any.
  double first_share(const Contact& contact, const SidePoint& first, const SidePoint& second) const {
    if (first.couple == Couple::none && second.couple == Couple::none) return -1;
    if (first.couple == Couple::none) return 0;
    if (second.couple == Couple::none) return 1;
    if (first.couple == Couple::faces && (second.couple != Couple::faces || contact.own == 1)) return 0;
    if (second.couple == Couple::faces && first.couple != Couple::faces) return 1;
    return first.radius / (first.radius + second.radius);
  }

  bool can_take(SidePoint& side, double height) {
    if (height == 0 || side.couple == Couple::rigid || side.couple == Couple::rotations) return true;
    if (side.couple != Couple::faces) return false;
    if (side.upright < 0) weigh_faces(side);
    return side.upright > standing;
  }

  // The points do not lie one behind the other along the normal: equal and opposite impulses at them would
  // turn the bodies. Their couple is distributed to the nodes of both sides as to one rigid body: the row
  // then constrains the relative velocity in the frame rotating with them. \returns whether much of it
  // remains, and some of that not prescribed
  bool add_without_spin(const Contact& contact, const SidePoint& first, const SidePoint& second) {
    Vector3d middle{};
    const auto count = static_cast<double>(first.count + second.count);
    for_nodes(first, second, [&](int node, double) { middle += position(sources_.nodes, node) / count; });
    Tensor<double> inertia{};
    double size = 0;
    for_nodes(first, second, [&](int node, double weight) {
      const Vector3d arm = position(sources_.nodes, node) - middle;
      inertia += inertia_of_point(arm);
      size += weight * weight;
    });
    const Vector3d spin = solve_semidefinite(inertia, cross(first.point - second.point, normal_));
    const double left = size - dot(spin, inertia * spin);
    double free = 0;
    for_nodes(first, second, [&](int node, double weight) {
      free += free_square(node, weight * normal_ - cross(spin, position(sources_.nodes, node) - middle));
    });
    if (!(left > least_share_left * size) || !(free > least_share_free * size)) return false;
    rows_.add_row(normal_, contact.gap, 0).impulse = contact.impulse;
    for_nodes(first, second, [&](int node, double weight) {
      const Vector3d turned = cross(spin, position(sources_.nodes, node) - middle);
      add_mapped(node, weight * identity<double>() - outer_product(normal_, turned));
    });
    return true;
  }
  template <class Visit>
  static void for_nodes(const SidePoint& first, const SidePoint& second, const Visit& visit) {
    for (std::size_t k = 0; k < first.count; ++k) visit(first.node[k], first.weight[k]);
    for (std::size_t k = 0; k < second.count; ++k) visit(second.node[k], -second.weight[k]);
  }
  // Of nodes in a line one eigenvalue is none, and the couple has no part along it.
  static Vector3d solve_semidefinite(const Tensor<double>& matrix, const Vector3d& right) {
    const PrincipalAxes principal = principal_axes(matrix);
    const double least = no_weight * principal.value[2];
    Vector3d solution{};
    for (int i = 0; i < 3; ++i) {
      const Vector3d axis = principal.axis.column(i);
      if (principal.value[i] > least) solution += dot(axis, right) / principal.value[i] * axis;
    }
    return solution;
  }

  void add_side(const SidePoint& side, double sign, double height, const Vector3d& contact_point) {
    if (side.body >= 0) {
      const int unknown = unknowns_.body(side.body);
      rows_.add_rigid_body(unknown, unknown + 1, contact_point - sources_.bodies[index(side.body)].centre,
                           sign > 0 ? Side::first : Side::second);
      return;
    }
    if (side.couple == Couple::faces && height != 0) return add_tilted(side, sign, height);
    // The first side stands below the point of its nodes, against the normal.
    const Vector3d arm = -height * normal_;
    for (std::size_t k = 0; k < side.count; ++k) {
      const double weight = sign * side.weight[k];
      add_node(side.node[k], weight);
      if (height != 0) add_turn(side.node[k], side.weight[k] * arm);
    }
  }

  // Faces that have all nodes of the side, with the squared cosines of their normals.
  void weigh_faces(SidePoint& side) {
    std::vector<RowPiece::TiltedFace>& faces = piece_.faces[side.number];
    faces.clear();
    side.upright = 0;
    for (int f : sources_.surface.faces_of.of(sources_.surface.slave(heaviest_of(side)))) {
      const Face& face = sources_.surface.face[index(f)];
      bool has_all = face.alive();
      for (std::size_t k = 0; k < side.count; ++k)
        has_all = has_all && (side.weight[k] <= no_weight || face.has(side.node[k]));
      if (!has_all) continue;
      const auto [g, h] = tangents(face);
      const Vector3d area = cross(g, h);
      const double size = squared_norm(area);
      const double along = dot(normal_, area);
      const double share = size > 0 ? along * along / size : 0;
      faces.push_back({&face, share, g, h});
      side.upright = std::max(side.upright, share);
    }
  }

  static int heaviest_of(const SidePoint& side) {
    const auto heaviest = std::max_element(side.weight.begin(), side.weight.end()) - side.weight.begin();
    return side.node[index(heaviest)];
  }

  std::pair<Vector3d, Vector3d> tangents(const Face& face) const {
    const FaceVertices x = vertices(sources_.nodes, face);
    return {-x[0] + x[1] + x[2] - x[3], -x[0] - x[1] + x[2] + x[3]};
  }

  // The tilt of a face as seen along the normal n, by the dual basis of its mean tangents g and h in the
  // plane at right angles to n: gradients g_k of the shape functions with sum of x_k g_k^T = 1 - n n^T in
  // that plane. The point x + height n moves with sum of w_k v_k - height g_k (n . v_k).
  // The faces of the side have been weighed, where the distance was divided.
  void add_tilted(const SidePoint& side, double sign, double height) {
    auto& tilted = piece_.tilted;
    tilted.clear();
    for (std::size_t k = 0; k < side.count; ++k)
      tilted.push_back({side.node[k], sign * side.weight[k], {0, 0, 0}});
    const double least = least_share * side.upright;
    double sum = 0;
    for (RowPiece::TiltedFace& one : piece_.faces[side.number])
      sum += one.share = one.share > least ? one.share : 0;
    for (const RowPiece::TiltedFace& one : piece_.faces[side.number])
      if (one.share > 0) tilt_with(one, height * one.share / sum);
    for (const RowPiece::TiltedNode& one : tilted) add_node(one.node, one.weight, one.tilt);
  }

  void tilt_with(const RowPiece::TiltedFace& face, double height) {
    constexpr double along[4] = {-1, 1, 1, -1}, across[4] = {-1, -1, 1, 1};
    const Vector3d &g = face.along, &h = face.across;
    const double area = dot(normal_, cross(g, h));
    const Vector3d dual_g = cross(h, normal_) / area, dual_h = cross(normal_, g) / area;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3d tilt = height * (along[k] * dual_g + across[k] * dual_h);
      const auto known = std::find_if(piece_.tilted.begin(), piece_.tilted.end(),
                                      [&](const auto& one) { return one.node == face.face->node[k]; });
      if (known == piece_.tilted.end())
        piece_.tilted.push_back({face.face->node[k], 0, tilt});
      else
        known->tilt = known->tilt + tilt;
    }
  }

  // weight v + tilt (normal . v) of a node. All that follow carry the sign of their side.
  void add_node(int node, double weight, const Vector3d& tilt = {0, 0, 0}) {
    const Tie* tie = tie_of(node);
    const bool plain = tilt.x == 0 && tilt.y == 0 && tilt.z == 0;
    if (tie != nullptr && plain && tie->gap == 0) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (tie->weight[k] == 0) continue;
        add_node(tie->corner[k], weight * tie->weight[k]);
        if (tie->has_arm()) add_turn(tie->corner[k], weight * tie->weight[k] * tie->arm);
      }
      return;
    }
    const int body = sources_.surface.rigid_body(node);
    if (tie != nullptr || (body >= 0 && !plain)) {
      const Tensor<double> map = weight * identity<double>() + outer_product(tilt, normal_);
      return add_mapped(node, map);
    }
    if (body >= 0) {
      const int unknown = unknowns_.body(body);
      rows_.add_point(unknown, Side::first, weight);
      rows_.add_rotation(unknown + 1, weight * (position(sources_.nodes, node) - centre(body)));
      return;
    }
    rows_.add_translation(unknowns_.node(node), weight, tilt);
  }

  // map v of a node.
  void add_mapped(int node, const Tensor<double>& map) {
    if (const Tie* tie = tie_of(node)) return add_mapped(*tie, map);
    if (const int body = sources_.surface.rigid_body(node); body >= 0) {
      const int unknown = unknowns_.body(body);
      rows_.add_matrix(unknown, map);
      rows_.add_matrix(unknown + 1, map * cross_matrix(centre(body) - position(sources_.nodes, node)));
      return;
    }
    rows_.add_matrix(unknowns_.node(node), map);
  }

  // Of a tied node with a gap, by the derivative of the map from its corners.
  void add_mapped(const Tie& tie, const Tensor<double>& map) {
    std::array<Tensor<double>, 4> share;
    for (std::size_t k = 0; k < 4; ++k) share[k] = tie.weight[k] * identity<double>();
    if (tie.gap != 0) {
      const FaceVertices corners = corners_of(tie, sources_.nodes);
      for (int axis = 0; axis < 3; ++axis) {
        const std::array<Vector3d, 4> row = spread(tie, corners, identity<double>().row(axis));
        for (std::size_t k = 0; k < 4; ++k) share[k].set_row(axis, row[k]);
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      if (share[k] == Tensor<double>{}) continue;
      add_mapped(tie.corner[k], map * share[k]);
      if (tie.has_arm()) add_mapped_turn(tie.corner[k], -tie.weight[k] * (map * cross_matrix(tie.arm)));
    }
  }

  // omega x arm of a node with rotations.
  void add_turn(int node, const Vector3d& arm) {
    if (const Tie* tie = tie_of(node); tie != nullptr && tie->turning) {
      for (std::size_t k = 0; k < 4; ++k)
        if (tie->weight[k] != 0) add_turn(tie->corner[k], tie->weight[k] * arm);
      return;
    }
    rows_.add_rotation(rotation_of(node), arm);
  }
  void add_mapped_turn(int node, const Tensor<double>& map) {
    if (const Tie* tie = tie_of(node); tie != nullptr && tie->turning) {
      for (std::size_t k = 0; k < 4; ++k)
        if (tie->weight[k] != 0) add_mapped_turn(tie->corner[k], tie->weight[k] * map);
      return;
    }
    rows_.add_matrix(rotation_of(node), map);
  }

  int rotation_of(int node) const {
    const int body = sources_.surface.rigid_body(node);
    return body >= 0 ? unknowns_.body(body) + 1 : unknowns_.rotation(node);
  }
  const Vector3d& centre(int body) const { return sources_.bodies[index(body)].centre; }

  RowPiece& piece_;
  ConstraintRows& rows_;
  const RowSources& sources_;
  const Unknowns unknowns_;
  Vector3d normal_;
  double height_[2] = {0, 0};
};

}  // namespace

void build_rows(RowPiece& piece, const RowSources& sources, std::span<const Contact> contacts) {
  piece.rows.clear();
  Builder builder(piece, sources);
  for (const Contact& contact : contacts) builder.add(contact);
}

void build_rows(RowPiece& piece, const RowSources& sources, std::span<const ContactWall> walls,
                std::span<const NodeAtWall> touches) {
  piece.rows.clear();
  Builder builder(piece, sources);
  for (const NodeAtWall& touch : touches) builder.add(touch, walls[index(touch.wall)]);
}

}  // namespace brio
