#include "contact/enforcement/contact_rows.hpp"

#include <algorithm>
#include <cmath>

#include "contact/surface/face_geometry.hpp"

namespace brio {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector = Vector3<double>;

namespace {

/// The couple of a side is distributed to its faces by the squares of the cosines of their normals; below
/// this fraction of the largest they get none.
constexpr double least_share = 1e-9;
/// Faces whose squared cosines are all below this are parallel to the normal: their tilt is negligible.
constexpr double standing = 0.01;
/// A weight below this is rounding: the closest point does not lie on that corner's side.
constexpr double no_weight = 1e-9;
/// What turns with the nodes sees at least this share of the relative velocity, squared, or is not asked.
constexpr double least_share_left = 0.1;
/// Of that, what is not prescribed: less is a lever (`held_share` of the solver).
constexpr double least_share_free = 1e-6;

std::size_t index(int i) { return static_cast<std::size_t>(i); }
Vector to_vector(const Vector3d& a) { return {a[0], a[1], a[2]}; }
Vector vector_of(const double* a) { return {a[0], a[1], a[2]}; }
SymmetricTensor<double> symmetric(const Matrix3d& a) {
  return {a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(1, 2), a(0, 2)};
}
Tensor<double> to_tensor(const Matrix3d& a) {
  Tensor<double> t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.m[i][j] = a(i, j);
  return t;
}
Matrix3d cross_matrix(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

/// Degrees of freedom that resist the couple of a side.
enum class Couple { none, faces, rotations, rigid };

/// One side of a contact: its closest point as a mean of nodes.
struct SidePoint {
  std::array<int, 4> node{};  ///< global
  std::array<double, 4> weight{};
  std::size_t count = 0;
  int body = -1;  ///< rigid, of all its nodes
  Couple couple = Couple::none;
  Vector3d point = Vector3d::Zero();
  double radius = 0;
  std::size_t number = 0;  ///< 0 or 1
  double upright = -1;     ///< largest squared cosine of a normal of its faces; negative: not known
};

class Builder {
 public:
  Builder(ContactRows& all, const RowSources& sources)
      : all_(all),
        rows_(all.rows),
        surface_(sources.surface),
        features_(sources.features),
        nodes_(sources.nodes),
        ties_(sources.ties),
        bodies_(sources.bodies) {}

  void add(const Contact& contact) {
    const auto own = index(contact.own);
    SidePoint first = side_of(contact, 0, own), second = side_of(contact, own, 5);
    second.number = 1;
    normal_ = contact.normal;
    if (contact.along_meeting && add_without_spin(contact, first, second)) return;
    const bool rubs = contact.friction_coefficient > 0 && divide(contact, first, second);
    ConstraintRow& row =
        rows_.add_row(to_vector(normal_), contact.gap, rubs ? contact.friction_coefficient : 0);
    row.impulse = contact.impulse;
    if (rubs) row.friction = to_vector(contact.friction);
    if (!rubs) height_[0] = height_[1] = 0;
    add_side(first, 1, height_[0], first.point - height_[0] * normal_);
    add_side(second, -1, height_[1], second.point + height_[1] * normal_);
  }

  void add(const NodeAtWall& touch, const ContactWall& wall) {
    const int node = surface_.node[index(touch.slave)];
    const Vector3d x = position(nodes_, node);
    normal_ = wall.normal;
    ConstraintRow& row = rows_.add_row(to_vector(normal_), wall.normal.dot(x - wall.point), wall.friction);
    row.impulse = touch.impulse;
    row.friction = touch.friction;
    row.wall = touch.wall;
    row.wall_velocity = to_vector(wall.velocity);
    row.point = to_vector(x);
    if (const int body = surface_.rigid_body(node); body >= 0) {
      const int block = block_of_body(body);
      rows_.add_rigid_body(block, block + 1, to_vector(x - centre(body)), Side::first);
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
      const int node = surface_.node[index(contact.node[k])];
      const int body = surface_.rigid_body(node);
      side.body = side.count == 0 || side.body == body ? body : -1;
      turns = turns && this->turns(node);
      side.node[side.count] = node;
      side.weight[side.count++] = weight;
      side.point += weight * position(nodes_, node);
      side.radius += weight * features_.node_radius[index(contact.node[k])];
    }
    side.couple = side.body >= 0                                                    ? Couple::rigid
                  : turns                                                           ? Couple::rotations
                  : surface_.faces_of.of(surface_.slave(heaviest_of(side))).empty() ? Couple::none
                                                                                    : Couple::faces;
    return side;
  }

  // Square of what of a vector is not prescribed.
  double free_square(int node, const Vector3d& seen) const {
    if (surface_.rigid_body(node) >= 0 || ties_.is_tied(node)) return seen.squaredNorm();
    if (nodes_.record[index(node)].inverse_mass == 0) return 0;
    const Vector all = to_vector(seen);
    return dot(all, nodes_.free_translations(index(node)) * all);
  }
  bool turns(int node) const {
    if (!nodes_.has_rotations()) return false;
    if (const Tie* tie = tie_of(node); tie != nullptr && tie->turning) return true;
    return nodes_.rotational_inertia[index(node)] > 0;
  }
  const Tie* tie_of(int node) const {
    return ties_.is_tied(node) ? &ties_.node[index(ties_.of_node[index(node)])].tie : nullptr;
  }

  // How far the contact point stands off both sides. \returns whether there is a place for it.
  bool divide(const Contact& contact, SidePoint& first, SidePoint& second) {
    const double distance = normal_.dot(first.point - second.point);
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
    Vector3d middle = Vector3d::Zero();
    const auto count = static_cast<double>(first.count + second.count);
    for_nodes(first, second, [&](int node, double) { middle += position(nodes_, node) / count; });
    Matrix3d inertia = Matrix3d::Zero();
    double size = 0;
    for_nodes(first, second, [&](int node, double weight) {
      const Vector3d arm = position(nodes_, node) - middle;
      inertia += arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose();
      size += weight * weight;
    });
    const Vector3d spin = solve_semidefinite(inertia, (first.point - second.point).cross(normal_));
    const double left = size - spin.dot(inertia * spin);
    double free = 0;
    for_nodes(first, second, [&](int node, double weight) {
      free += free_square(node, weight * normal_ - spin.cross(position(nodes_, node) - middle));
    });
    if (!(left > least_share_left * size) || !(free > least_share_free * size)) return false;
    rows_.add_row(to_vector(normal_), contact.gap, 0).impulse = contact.impulse;
    for_nodes(first, second, [&](int node, double weight) {
      const Vector3d turned = spin.cross(position(nodes_, node) - middle);
      add_mapped(node, weight * Matrix3d::Identity() - normal_ * turned.transpose());
    });
    return true;
  }
  template <class Visit>
  static void for_nodes(const SidePoint& first, const SidePoint& second, const Visit& visit) {
    for (std::size_t k = 0; k < first.count; ++k) visit(first.node[k], first.weight[k]);
    for (std::size_t k = 0; k < second.count; ++k) visit(second.node[k], -second.weight[k]);
  }
  // Of nodes in a line one eigenvalue is none, and the couple has no part along it.
  static Vector3d solve_semidefinite(const Matrix3d& matrix, const Vector3d& right) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(matrix);
    const double least = no_weight * eigen.eigenvalues()[2];
    Vector3d solution = Vector3d::Zero();
    for (int i = 0; i < 3; ++i)
      if (const double value = eigen.eigenvalues()[i]; value > least)
        solution += eigen.eigenvectors().col(i).dot(right) / value * eigen.eigenvectors().col(i);
    return solution;
  }

  void add_side(const SidePoint& side, double sign, double height, const Vector3d& contact_point) {
    if (side.body >= 0) {
      const int block = block_of_body(side.body);
      rows_.add_rigid_body(block, block + 1, to_vector(contact_point - bodies_[index(side.body)].centre),
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
    std::vector<ContactRows::TiltedFace>& faces = all_.faces[side.number];
    faces.clear();
    side.upright = 0;
    for (int f : surface_.faces_of.of(surface_.slave(heaviest_of(side)))) {
      const Face& face = surface_.face[index(f)];
      bool has_all = face.alive();
      for (std::size_t k = 0; k < side.count; ++k)
        has_all = has_all && (side.weight[k] <= no_weight || face.has(side.node[k]));
      if (!has_all) continue;
      const auto [g, h] = tangents(face);
      const Vector3d area = g.cross(h);
      const double size = area.squaredNorm();
      const double along = normal_.dot(area);
      const double share = size > 0 ? along * along / size : 0;
      faces.push_back({&face, share, g, h});
      side.upright = std::max(side.upright, share);
    }
  }

  static int heaviest_of(const SidePoint& side) {
    const auto heaviest = std::max_element(side.weight.begin(), side.weight.end()) - side.weight.begin();
    return side.node[static_cast<std::size_t>(heaviest)];
  }

  std::pair<Vector3d, Vector3d> tangents(const Face& face) const {
    const FaceVertices x = vertices(nodes_, face);
    return {-x[0] + x[1] + x[2] - x[3], -x[0] - x[1] + x[2] + x[3]};
  }

  // The tilt of a face as seen along the normal n, by the dual basis of its mean tangents g and h in the
  // plane at right angles to n: gradients g_k of the shape functions with sum of x_k g_k^T = 1 - n n^T in
  // that plane. The point x + height n moves with sum of w_k v_k - height g_k (n . v_k).
  // The faces of the side have been weighed, where the distance was divided.
  void add_tilted(const SidePoint& side, double sign, double height) {
    auto& tilted = all_.tilted;
    tilted.clear();
    for (std::size_t k = 0; k < side.count; ++k)
      tilted.push_back({side.node[k], sign * side.weight[k], {0, 0, 0}});
    const double least = least_share * side.upright;
    double sum = 0;
    for (ContactRows::TiltedFace& one : all_.faces[side.number])
      sum += one.share = one.share > least ? one.share : 0;
    for (const ContactRows::TiltedFace& one : all_.faces[side.number])
      if (one.share > 0) tilt_with(one, height * one.share / sum);
    for (const ContactRows::TiltedNode& one : tilted) add_node(one.node, one.weight, one.tilt);
  }

  void tilt_with(const ContactRows::TiltedFace& face, double height) {
    constexpr double along[4] = {-1, 1, 1, -1}, across[4] = {-1, -1, 1, 1};
    const Vector3d &g = face.along, &h = face.across;
    const double area = normal_.dot(g.cross(h));
    const Vector3d dual_g = h.cross(normal_) / area, dual_h = normal_.cross(g) / area;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector tilt = to_vector(height * (along[k] * dual_g + across[k] * dual_h));
      const auto known = std::find_if(all_.tilted.begin(), all_.tilted.end(),
                                      [&](const auto& one) { return one.node == face.face->node[k]; });
      if (known == all_.tilted.end())
        all_.tilted.push_back({face.face->node[k], 0, tilt});
      else
        known->tilt = known->tilt + tilt;
    }
  }

  // weight v + tilt (normal . v) of a node. All that follow carry the sign of their side.
  void add_node(int node, double weight, const Vector& tilt = {0, 0, 0}) {
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
    const int body = surface_.rigid_body(node);
    if (tie != nullptr || (body >= 0 && !plain)) {
      const Matrix3d map =
          weight * Matrix3d::Identity() + Vector3d(tilt.x, tilt.y, tilt.z) * normal_.transpose();
      return add_mapped(node, map);
    }
    if (body >= 0) {
      const int block = block_of_body(body);
      rows_.add_point(block, Side::first, weight);
      rows_.add_rotation(block + 1, to_vector(weight * (position(nodes_, node) - centre(body))));
      return;
    }
    rows_.add_translation(block_of_node(node), weight, tilt);
  }

  // map v of a node.
  void add_mapped(int node, const Matrix3d& map) {
    if (const Tie* tie = tie_of(node)) return add_mapped(*tie, map);
    if (const int body = surface_.rigid_body(node); body >= 0) {
      const int block = block_of_body(body);
      rows_.add_matrix(block, to_tensor(map));
      rows_.add_matrix(block + 1, to_tensor(-map * cross_matrix(position(nodes_, node) - centre(body))));
      return;
    }
    rows_.add_matrix(block_of_node(node), to_tensor(map));
  }

  // Of a tied node with a gap, by the derivative of the map from its corners.
  void add_mapped(const Tie& tie, const Matrix3d& map) {
    std::array<Matrix3d, 4> share;
    for (std::size_t k = 0; k < 4; ++k) share[k] = tie.weight[k] * Matrix3d::Identity();
    if (tie.gap != 0) {
      const FaceVertices corners = corners_of(tie, nodes_);
      for (int axis = 0; axis < 3; ++axis) {
        const std::array<Vector3d, 4> row = spread(tie, corners, Vector3d::Unit(axis));
        for (std::size_t k = 0; k < 4; ++k) share[k].row(axis) = row[k].transpose();
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      if (share[k].isZero(0)) continue;
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
    rows_.add_rotation(rotation_of(node), to_vector(arm));
  }
  void add_mapped_turn(int node, const Matrix3d& map) {
    if (const Tie* tie = tie_of(node); tie != nullptr && tie->turning) {
      for (std::size_t k = 0; k < 4; ++k)
        if (tie->weight[k] != 0) add_mapped_turn(tie->corner[k], tie->weight[k] * map);
      return;
    }
    rows_.add_matrix(rotation_of(node), to_tensor(map));
  }

  const Vector3d& centre(int body) const { return bodies_[index(body)].centre; }

  int add_block(BlockOwner::Kind kind, int of, const VelocityBlock& block, const Vector& before,
                const BlockPlace& place) {
    all_.block.push_back(block);
    all_.owner.push_back({kind, of});
    all_.before.push_back(before);
    all_.place.push_back(place);
    return static_cast<int>(all_.block.size()) - 1;
  }

  int block_of_node(int node) {
    int& block = all_.block_of_node[index(node)];
    if (block >= 0) return block;
    const auto n = index(node);
    const bool skew = nodes_.own_axes(n) != nullptr && nodes_.prescribed_translations(n) != 0;
    const double norm = skew && nodes_.prescribed_translations(n) != 7 ? nodes_.record[n].inverse_mass : 0;
    block = add_block(
        BlockOwner::Kind::node, node,
        {vector_of(nodes_.record[n].velocity), nodes_.free_inverse_mass(n), norm},
        vector_of(nodes_.velocity_before[n].component),
        {.position = vector_of(nodes_.record[n].position), .skew = skew, .mass = skew ? nodes_.mass[n] : 0});
    return block;
  }

  int rotation_of(int node) {
    if (const int body = surface_.rigid_body(node); body >= 0) return block_of_body(body) + 1;
    int& block = all_.block_of_rotation[index(node)];
    if (block >= 0) return block;
    const auto n = index(node);
    const double* rate = nodes_.angular_velocity[n].component;
    const bool skew = nodes_.own_axes(n) != nullptr && nodes_.prescribed_rotations(n) != 0;
    const double norm = skew && nodes_.prescribed_rotations(n) != 7 ? rate[3] : 0;
    block = add_block(BlockOwner::Kind::rotation_of_node, node,
                      {vector_of(rate), nodes_.free_inverse_inertia(n), norm},
                      vector_of(nodes_.angular_velocity_before[n].component),
                      {.turns = true, .skew = skew, .mass = skew ? nodes_.rotational_inertia[n] : 0});
    return block;
  }

  int block_of_body(int body) {
    int& block = all_.block_of_body[index(body)];
    if (block >= 0) return block;
    const RigidMotion& motion = bodies_[index(body)];
    const bool skew = motion.has_own_axes();
    all_.body_inertia[index(body)] = symmetric(motion.inertia);
    block = add_block(
        BlockOwner::Kind::body, body,
        {to_vector(motion.velocity), symmetric(motion.free_inverse_mass()), motion.inverse_mass.maxCoeff()},
        to_vector(motion.velocity_before),
        {.position = to_vector(motion.centre), .skew = skew, .mass = skew ? motion.mass : 0});
    add_block(BlockOwner::Kind::rotation_of_body, body,
              {to_vector(motion.angular_velocity), symmetric(motion.inverse_inertia)},
              to_vector(motion.angular_velocity_before),
              {.turns = true, .inertia = &all_.body_inertia[index(body)], .skew = skew});
    return block;
  }

  ContactRows& all_;
  ConstraintRows& rows_;
  const Surface& surface_;
  const SurfaceFeatures& features_;
  const Nodes& nodes_;
  const Ties& ties_;
  std::span<const RigidMotion> bodies_;
  Vector3d normal_;
  double height_[2] = {0, 0};
};

}  // namespace

void ContactRows::clear() {
  for (const BlockOwner& one : owner) {
    if (one.kind == BlockOwner::Kind::node) block_of_node[index(one.index)] = -1;
    if (one.kind == BlockOwner::Kind::rotation_of_node) block_of_rotation[index(one.index)] = -1;
    if (one.kind == BlockOwner::Kind::body) block_of_body[index(one.index)] = -1;
  }
  rows.clear();
  block.clear();
  owner.clear();
  before.clear();
  place.clear();
}

namespace {

Builder builder_of(ContactRows& rows, const RowSources& sources) {
  rows.block_of_node.resize(sources.nodes.size(), -1);
  if (sources.nodes.has_rotations()) rows.block_of_rotation.resize(sources.nodes.size(), -1);
  rows.block_of_body.resize(sources.bodies.size(), -1);
  rows.body_inertia.resize(sources.bodies.size());
  return {rows, sources};
}

}  // namespace

void add_rows(ContactRows& rows, const RowSources& sources, std::span<const Contact> contacts) {
  Builder builder = builder_of(rows, sources);
  for (const Contact& contact : contacts) builder.add(contact);
}

void add_rows(ContactRows& rows, const RowSources& sources, std::span<const ContactWall> walls,
              std::span<const NodeAtWall> touches) {
  Builder builder = builder_of(rows, sources);
  for (const NodeAtWall& touch : touches) builder.add(touch, walls[index(touch.wall)]);
}

}  // namespace brio
