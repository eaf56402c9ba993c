#include "contact/enforcement/constraint_row.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "src/base/index.hpp"

namespace brio {

namespace {

double sign_of(Side side) { return side == Side::first ? 1 : -1; }

Vector3d unit(const Vector3d& a) { return (1 / std::sqrt(dot(a, a))) * a; }

void span_plane(const Vector3d& normal, Vector3d (&tangent)[2]) {
  const double size[3] = {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  int smallest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (size[axis] < size[smallest]) smallest = axis;
  const Vector3d along{smallest == 0 ? 1.0 : 0.0, smallest == 1 ? 1.0 : 0.0, smallest == 2 ? 1.0 : 0.0};
  tangent[0] = unit(cross(along, normal));
  tangent[1] = cross(normal, tangent[0]);
}

// weight one + a b^T
Tensor<double> weighted_map(double weight, const Vector3d& a, const Vector3d& b) {
  return weight * identity<double>() + outer_product(a, b);
}

template <class Entry>
Entry* find(std::vector<Entry>& entries, const EntryRange& range, int block) {
  for (std::uint32_t i = range.begin; i < range.end; ++i)
    if (entries[i].block == block) return &entries[i];
  return nullptr;
}

/// Of the impulse: what the difference of two normals may do to the share of a corner.
constexpr double rounding_share = 1e-15;

void shift(EntryRange& range, std::size_t by) {
  range.begin += static_cast<std::uint32_t>(by);
  range.end += static_cast<std::uint32_t>(by);
}

}  // namespace

// g^1 = g_2 x m / |g_1 x g_2|, g^2 = m x g_1 / |g_1 x g_2|.
void set_gradients(FaceFoot& foot, std::span<const Vector3d> corner, std::span<const double> along,
                   std::span<const double> across) {
  Vector3d g{0, 0, 0};
  Vector3d h{0, 0, 0};
  for (std::size_t k = 1; k < index(foot.corners); ++k) {
    g = g + along[k] * (corner[k] - corner[0]);
    h = h + across[k] * (corner[k] - corner[0]);
  }
  const Vector3d area = cross(g, h);
  const double size = std::sqrt(dot(area, area));
  assert(size > 0);
  foot.normal = (1 / size) * area;
  const Vector3d dual_g = (1 / size) * cross(h, foot.normal);
  const Vector3d dual_h = (1 / size) * cross(foot.normal, g);
  for (std::size_t k = 0; k < index(foot.corners); ++k)
    foot.gradient[k] = along[k] * dual_g + across[k] * dual_h;
}

void ConstraintRows::resize(const RowCounts& counts) {
  row.resize(counts.row);
  translation.resize(counts.translation);
  rotation.resize(counts.rotation);
  matrix.resize(counts.matrix);
}

ConstraintRow& ConstraintRows::add_row(const Vector3d& normal, double gap, double friction_coefficient) {
  ConstraintRow& added = row.emplace_back();
  added.normal = normal;
  span_plane(normal, added.tangent);
  added.gap = gap;
  added.friction_coefficient = friction_coefficient;
  added.translation.begin = added.translation.end = static_cast<std::uint32_t>(translation.size());
  added.rotation.begin = added.rotation.end = static_cast<std::uint32_t>(rotation.size());
  added.matrix.begin = added.matrix.end = static_cast<std::uint32_t>(matrix.size());
  return added;
}

void ConstraintRows::add_translation(int block, double weight, const Vector3d& tilt) {
  ConstraintRow& own = row.back();
  if (MatrixEntry* entry = find(matrix, own.matrix, block)) {
    entry->matrix += weighted_map(weight, tilt, own.normal);
    return;
  }
  const double components[2] = {dot(tilt, own.tangent[0]), dot(tilt, own.tangent[1])};
  if (TranslationEntry* entry = find(translation, own.translation, block)) {
    entry->weight += weight;
    for (int t = 0; t < 2; ++t) entry->tilt[t] += components[t];
    return;
  }
  translation.push_back({block, weight, {components[0], components[1]}});
  ++own.translation.end;
}

void ConstraintRows::add_rotation(int block, const Vector3d& signed_arm) {
  ConstraintRow& own = row.back();
  if (RotationEntry* entry = find(rotation, own.rotation, block)) {
    entry->arm = entry->arm + signed_arm;
    return;
  }
  rotation.push_back({block, signed_arm});
  ++own.rotation.end;
}

void ConstraintRows::add_matrix(int block, const Tensor<double>& signed_matrix) {
  ConstraintRow& own = row.back();
  if (MatrixEntry* entry = find(matrix, own.matrix, block)) {
    entry->matrix += signed_matrix;
    return;
  }
  matrix.push_back({block, signed_matrix});
  ++own.matrix.end;
  if (TranslationEntry* entry = find(translation, own.translation, block)) {
    matrix.back().matrix += weighted_map(entry->weight, tilt_of(own, *entry), own.normal);
    *entry = translation.back();
    translation.pop_back();
    --own.translation.end;
  }
}

void ConstraintRows::add_point(int block, Side side, double weight) {
  add_translation(block, sign_of(side) * weight, {0, 0, 0});
}

void ConstraintRows::add_nodes(std::span<const int> blocks, std::span<const double> weights, Side side) {
  for (std::size_t k = 0; k < blocks.size(); ++k) add_point(blocks[k], side, weights[k]);
}

void ConstraintRows::add_turning_point(int block, int rotation_block, double height, Side side,
                                       double weight) {
  add_point(block, side, weight);
  if (height != 0) add_rotation(rotation_block, (sign_of(side) * weight * height) * row.back().normal);
}

// With c = normal of the face x gradient, the spin of a face of solids is
//     omega = sum over corners of (-c (m . v) + m (c . v) / 2),
// and the point foot + height n moves with the foot and with omega x height n. Where n is m or -m, that is a
// tilt: weight v - height gradient (n . v).
void ConstraintRows::add_solid_face(const FaceFoot& foot, double height, double sign) {
  const Vector3d n = row.back().normal;
  const Vector3d& m = foot.normal;
  const Vector3d twist = cross(n, m);
  double steepest = 0;
  for (int k = 0; k < foot.corners; ++k)
    steepest = std::max(steepest, dot(foot.gradient[k], foot.gradient[k]));
  const bool along_normal = height * height * dot(twist, twist) * steepest <= rounding_share * rounding_share;
  for (int k = 0; k < foot.corners; ++k) {
    const double weight = sign * foot.weight[k];
    if (along_normal) {
      add_translation(foot.block[k], weight, (-sign * height) * foot.gradient[k]);
      continue;
    }
    const Vector3d c = cross(m, foot.gradient[k]);
    add_matrix(foot.block[k], weighted_map(weight, (sign * height) * cross(n, c), m) +
                                  outer_product((-0.5 * sign * height) * twist, c));
  }
}

void ConstraintRows::add_face(const FaceFoot& foot, double height, Side side) {
  const double sign = sign_of(side);
  if (height != 0 && foot.rotation[0] < 0) return add_solid_face(foot, height, sign);
  for (int k = 0; k < foot.corners; ++k) {
    if (foot.rotation[k] >= 0) {
      add_turning_point(foot.block[k], foot.rotation[k], height, side, foot.weight[k]);
    } else {
      add_point(foot.block[k], side, foot.weight[k]);
    }
  }
}

void ConstraintRows::add_rigid_body(int translation_block, int rotation_block, const Vector3d& arm,
                                    Side side) {
  add_point(translation_block, side);
  add_rotation(rotation_block, sign_of(side) * arm);
}

void ConstraintRows::append(const ConstraintRows& other) {
  const RowCounts own = counts();
  RowCounts both = own;
  resize(both += other.counts());
  overwrite(own, other);
}

void ConstraintRows::overwrite(const RowCounts& at, const ConstraintRows& other) {
  const auto copy = [](const auto& from, auto& to, std::size_t first) {
    std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(first));
  };
  copy(other.row, row, at.row);
  for (std::size_t i = at.row; i < at.row + other.size(); ++i) {
    shift(row[i].translation, at.translation);
    shift(row[i].rotation, at.rotation);
    shift(row[i].matrix, at.matrix);
  }
  copy(other.translation, translation, at.translation);
  copy(other.rotation, rotation, at.rotation);
  copy(other.matrix, matrix, at.matrix);
}

double RowMap::inverse_mass(const Vector3d& direction, std::span<const VelocityBlock> blocks) const {
  double sum = 0;
  spread(direction, [&](int block, const Vector3d& impulse) {
    sum += dot(impulse, blocks[index(block)].inverse_mass * impulse);
  });
  return sum;
}

}  // namespace brio
