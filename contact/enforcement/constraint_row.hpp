#pragma once
/// Constraint row of a contact, a wall or a support: the velocity of its first side relative to its second as
/// a linear map of velocity blocks,
///     u = sum (weight v + n_tilt (normal . v)) + sum (omega x arm) + sum (matrix v) - wall velocity,
/// whose transpose gives the impulses on the blocks. Nodes, faces with thickness, shells with rotations,
/// rigid bodies and walls differ only in their entries.
///
/// A contact point at a height above its face (across thickness or gap) moves with the spin of the face, so
/// that friction has a moment: the impulses of a row then have no moment about any point, to rounding.

#include <cstdint>
#include <span>
#include <vector>

#include "src/base/index.hpp"
#include "src/base/parallel.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// Three unknown velocities with their inverse mass: the translation of a node (a multiple of the projection
/// on the directions in which its motion is not prescribed), its rotation (likewise), the translation or the
/// rotation of a rigid body.
struct VelocityBlock {
  Vector3d velocity;
  SymmetricTensor<double> inverse_mass;  ///< or inverse inertia
  double norm = 0;                       ///< its spectral norm, where that is known; 0: bounded
};

/// A translation: weight v + n_tilt (normal . v), where the tilt is a vector in the tangential plane, given
/// by its components. The weight carries the sign of the side.
struct TranslationEntry {
  int block;
  double weight;
  double tilt[2];
};
/// A rotation: omega x arm. The arm carries the sign of the side.
struct RotationEntry {
  int block;
  Vector3d arm;
};
/// Any other: matrix v.
struct MatrixEntry {
  int block;
  Tensor<double> matrix;
};

/// Entries [begin, end) of one of the arrays.
struct EntryRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t size() const { return end - begin; }
};

struct ConstraintRow {
  Vector3d normal;                  ///< unit vector from the second side to the first
  Vector3d tangent[2];              ///< complete the normal
  double gap = 0;                   ///< at the beginning of the step; negative: overlap
  double friction_coefficient = 0;  ///< Coulomb's
  double target_velocity = 0;       ///< least normal relative velocity
  double impulse = 0;               ///< along the normal, on the first side; never negative
  double normal_work = 0;           ///< work of the normal impulse in the step
  Vector3d friction{0, 0, 0};       ///< tangential impulse on the first side
  Vector3d wall_velocity{0, 0, 0};  ///< of an immovable second side
  Vector3d point{0, 0, 0};          ///< contact point at a wall, for its moment
  int wall = -1;                    ///< number of the wall; -1: none
  EntryRange translation, rotation, matrix;
};

enum class Side { first = 1, second = -1 };

/// Lengths of the arrays of rows, or places in them.
struct RowCounts {
  std::size_t row = 0, translation = 0, rotation = 0, matrix = 0;
  RowCounts& operator+=(const RowCounts& other) {
    row += other.row;
    translation += other.translation;
    rotation += other.rotation;
    matrix += other.matrix;
    return *this;
  }
};

/// Foot of a contact point on a face, or on a triangle (3 corners).
struct FaceFoot {
  int corners = 4;
  int block[4];                     ///< translation of each corner
  int rotation[4]{-1, -1, -1, -1};  ///< of corners with rotations (shells, beams)
  double weight[4];                 ///< shape functions
  Vector3d gradient[4];             ///< of the shape functions along the face (solids with a height)
  Vector3d normal;                  ///< unit normal of the face (likewise)
};
/// Gradients and normal by the dual basis of a face at the foot: sum over a of g^a N_k,a.
/// \param along, across derivatives N_k,1 and N_k,2 of the shape functions.
/// \pre the face has an area at the foot.
void set_gradients(FaceFoot& foot, std::span<const Vector3d> corner, std::span<const double> along,
                   std::span<const double> across);

/// Rows and their entries. Arrays are reused: nothing is allocated for fewer rows than before.
struct ConstraintRows {
  std::vector<ConstraintRow> row;
  std::vector<TranslationEntry> translation;
  std::vector<RotationEntry> rotation;
  std::vector<MatrixEntry> matrix;

  std::size_t size() const { return row.size(); }
  RowCounts counts() const { return {row.size(), translation.size(), rotation.size(), matrix.size()}; }
  void resize(const RowCounts& counts);
  void clear() { resize({}); }

  /// A new row; the entries added next belong to it. The reference is valid until the next row.
  ConstraintRow& add_row(const Vector3d& normal, double gap, double friction_coefficient);

  /// These add entries to the last row. An entry of a block that it has already is summed to it.
  void add_point(int block, Side side, double weight = 1);
  void add_nodes(std::span<const int> blocks, std::span<const double> weights, Side side);
  /// A point at `height` along the row's normal above a node with rotations.
  void add_turning_point(int block, int rotation, double height, Side side, double weight = 1);
  /// The point foot + height normal of a face: of a shell where it has rotations, else of a solid. A height
  /// of 0 needs neither gradients nor normal.
  void add_face(const FaceFoot& foot, double height, Side side);
  /// A point of a rigid body, `arm` from its centre.
  void add_rigid_body(int translation_block, int rotation_block, const Vector3d& arm, Side side);
  /// weight v + tilt (normal . v) with the sign of the side; the tilt is at right angles to the normal.
  void add_translation(int block, double signed_weight, const Vector3d& signed_tilt);
  void add_rotation(int block, const Vector3d& signed_arm);
  void add_matrix(int block, const Tensor<double>& signed_matrix);

  /// Rows of another, after the own.
  void append(const ConstraintRows& other);
  /// Rows of another, over the own from there on.
  void overwrite(const RowCounts& at, const ConstraintRows& other);

 private:
  void add_solid_face(const FaceFoot& foot, double height, double sign);
};

/// The entries of one row as a map.
class RowMap {
 public:
  RowMap(const ConstraintRows& rows, const ConstraintRow& row) : rows_(rows), row_(row) {}

  std::span<const TranslationEntry> translations() const {
    return {rows_.translation.data() + row_.translation.begin, row_.translation.size()};
  }
  std::span<const RotationEntry> rotations() const {
    return {rows_.rotation.data() + row_.rotation.begin, row_.rotation.size()};
  }
  std::span<const MatrixEntry> matrices() const {
    return {rows_.matrix.data() + row_.matrix.begin, row_.matrix.size()};
  }

  /// Velocity of the first side relative to the second, for a wall at rest.
  /// \param velocity_of velocity of a block by its number.
  template <class VelocityOf>
  Vector3d velocity(VelocityOf&& velocity_of) const;
  /// Relative velocity including the motion of the wall.
  Vector3d relative_velocity(std::span<const VelocityBlock> blocks) const {
    return velocity([&](int b) { return blocks[index(b)].velocity; }) - row_.wall_velocity;
  }
  /// `give(block, impulse)` for each entry: the transpose.
  template <class Give>
  void spread(const Vector3d& impulse, Give&& give) const;
  /// Change of the relative velocity along a direction by a unit impulse along it.
  double inverse_mass(const Vector3d& direction, std::span<const VelocityBlock> blocks) const;

 private:
  const ConstraintRows& rows_;
  const ConstraintRow& row_;
};

inline Vector3d tilt_of(const ConstraintRow& row, const TranslationEntry& entry) {
  return entry.tilt[0] * row.tangent[0] + entry.tilt[1] * row.tangent[1];
}
inline Vector3d impulse_of(const ConstraintRow& row) { return row.impulse * row.normal + row.friction; }

template <class VelocityOf>
Vector3d RowMap::velocity(VelocityOf&& velocity_of) const {
  Vector3d sum{0, 0, 0};
  for (const TranslationEntry& entry : translations()) {
    const Vector3d v = velocity_of(entry.block);
    sum = sum + (entry.weight * v + dot(row_.normal, v) * tilt_of(row_, entry));
  }
  for (const RotationEntry& entry : rotations()) sum = sum + cross(velocity_of(entry.block), entry.arm);
  for (const MatrixEntry& entry : matrices()) sum = sum + entry.matrix * velocity_of(entry.block);
  return sum;
}

template <class Give>
void RowMap::spread(const Vector3d& impulse, Give&& give) const {
  for (const TranslationEntry& entry : translations())
    give(entry.block, entry.weight * impulse + dot(tilt_of(row_, entry), impulse) * row_.normal);
  for (const RotationEntry& entry : rotations()) give(entry.block, cross(entry.arm, impulse));
  for (const MatrixEntry& entry : matrices()) give(entry.block, transposed_times(entry.matrix, impulse));
}

}  // namespace brio
