// c of all entries, s of rows and S of blocks (impulse_solver.hpp), and which rows move together.

#include <algorithm>
#include <cmath>

#include "contact/enforcement/impulse_solver.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// A row is held where none of its blocks gives it more than this share, squared, of the motion that the
/// block itself has: a thousandth. Such a block would be thrown a thousand times as far as the row asks for.
constexpr double held_share = 1e-6;

// Bound of the spectral norm: exact where it is known or the matrix is diagonal.
double norm_bound(const VelocityBlock& block) {
  if (block.norm > 0) return block.norm;
  const SymmetricTensor<double>& a = block.inverse_mass;
  const double xy = std::abs(a.xy);
  const double yz = std::abs(a.yz);
  const double xz = std::abs(a.xz);
  return std::max({std::abs(a.xx) + xy + xz, std::abs(a.yy) + xy + yz, std::abs(a.zz) + xz + yz});
}
bool is_isotropic(const SymmetricTensor<double>& a) {
  return a.xx == a.yy && a.yy == a.zz && a.xy == 0 && a.yz == 0 && a.xz == 0;
}
double energy(const SymmetricTensor<double>& inverse_mass, const Vector3d& impulse) {
  return dot(impulse, inverse_mass * impulse);
}
/// c^2 of each kind of entry, times the squared scale of the row: |W^(1/2) B^T|^2, of the normal alone where
/// there is no friction. `bound` is as in block_bound_. Squares scale with the unit of mass by powers of two
/// as it does; roots would not.
double entry_square(const ConstraintRow& row, const TranslationEntry& entry, const VelocityBlock& block,
                    double bound) {
  if (row.friction_coefficient == 0)
    return square(entry.weight) * (bound >= 0 ? bound : energy(block.inverse_mass, row.normal));
  const double tilt = entry.tilt[0] * entry.tilt[0] + entry.tilt[1] * entry.tilt[1];
  const double weight = std::abs(entry.weight);
  const double map = tilt == 0 ? weight : 0.5 * (std::sqrt(tilt) + std::sqrt(tilt + 4 * weight * weight));
  return square(map) * std::abs(bound);
}
double entry_square(const ConstraintRow& row, const RotationEntry& entry, const VelocityBlock& block,
                    double bound) {
  if (row.friction_coefficient == 0) return energy(block.inverse_mass, cross(entry.arm, row.normal));
  return dot(entry.arm, entry.arm) * std::abs(bound);
}
double entry_square(const ConstraintRow& row, const MatrixEntry& entry, const VelocityBlock& block,
                    double bound) {
  if (row.friction_coefficient == 0)
    return energy(block.inverse_mass, transposed_times(entry.matrix, row.normal));
  return squared_norm(entry.matrix) * std::abs(bound);
}

bool is_held(const ConstraintRows& rows, const ConstraintRow& row, std::span<const VelocityBlock> blocks) {
  const RowMap map(rows, row);
  // \param given impulse by one along the normal of the row. \param squared its most for any direction
  const auto moves = [&](int block, const Vector3d& given, double squared) {
    const SymmetricTensor<double>& inverse_mass = blocks[index(block)].inverse_mass;
    return energy(inverse_mass, given) > held_share * squared * norm_bound(blocks[index(block)]);
  };
  bool held = true;
  for (const TranslationEntry& entry : map.translations())
    held = held && !moves(entry.block, entry.weight * row.normal, 1);
  for (const RotationEntry& entry : map.rotations())
    held = held && !moves(entry.block, cross(entry.arm, row.normal), dot(entry.arm, entry.arm));
  for (const MatrixEntry& entry : map.matrices())
    held =
        held && !moves(entry.block, transposed_times(entry.matrix, row.normal), squared_norm(entry.matrix));
  return held;
}

}  // namespace

ImpulseSolver::Class ImpulseSolver::class_of(const ConstraintRow& row, bool tilted) {
  const std::uint32_t translations = row.translation.size();
  const std::uint32_t rotations = row.rotation.size();
  if (row.matrix.size() > 0) return with_matrix;
  if (row.friction_coefficient == 0) return rotations == 0 ? sliding : sliding_turning;
  if (tilted) return translations <= 5 ? tilting_5 : translations <= 8 ? tilting_8 : tilting;
  if (rotations == 0) return rubbing;
  if (rotations > 1) return rotations <= 3 ? some_turning : turning;
  return translations <= 2 ? one_turning_2 : translations == 3 ? one_turning_3 : one_turning;
}

void ImpulseSolver::measure_blocks(std::span<const VelocityBlock> blocks, ThreadTeam& team) {
  block_bound_.resize(blocks.size());
  block_norm_.resize(blocks.size());
  team.for_ranges(blocks.size(), blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const double bound = norm_bound(blocks[b]);
      block_bound_[b] = is_isotropic(blocks[b].inverse_mass) ? bound : -bound;
    }
  });
}

// c of all entries and the squared scale of rows; of which class a row is.
void ImpulseSolver::measure_rows(const ConstraintRows& rows, std::span<const VelocityBlock> blocks,
                                 ThreadTeam& team) {
  const std::size_t rotations = rows.translation.size();
  const std::size_t matrices = rotations + rows.rotation.size();
  norm_.resize(matrices + rows.matrix.size());
  class_.resize(rows.size());
  squared_scale_.resize(rows.size());
  const auto measure = [&](std::size_t i) {
    const ConstraintRow& row = rows.row[i];
    double sum = 0;
    double largest = 0;
    bool tilted = false;
    bool plain = row.rotation.size() + row.matrix.size() == 0;
    const auto add = [&](const auto& entry, double& norm) {
      norm = entry_square(row, entry, blocks[index(entry.block)], block_bound_[index(entry.block)]);
      sum += norm;
    };
    for (std::uint32_t e = row.translation.begin; e < row.translation.end; ++e) {
      const TranslationEntry& entry = rows.translation[e];
      const double bound = block_bound_[index(entry.block)];
      add(entry, norm_[e]);
      if (bound != 0) largest = std::max(largest, square(entry.weight));
      plain = plain && bound >= 0;
      tilted = tilted || entry.tilt[0] != 0 || entry.tilt[1] != 0;
    }
    for (std::uint32_t e = row.rotation.begin; e < row.rotation.end; ++e)
      add(rows.rotation[e], norm_[rotations + e]);
    for (std::uint32_t e = row.matrix.begin; e < row.matrix.end; ++e)
      add(rows.matrix[e], norm_[matrices + e]);
    const bool held = plain ? !(largest > held_share) : is_held(rows, row, blocks);
    squared_scale_[i] = held ? 0 : sum;
    const auto finish = [&](double& norm) { norm = held ? 0 : std::sqrt(norm / sum); };
    for (std::uint32_t e = row.translation.begin; e < row.translation.end; ++e) finish(norm_[e]);
    for (std::uint32_t e = row.rotation.begin; e < row.rotation.end; ++e) finish(norm_[rotations + e]);
    for (std::uint32_t e = row.matrix.begin; e < row.matrix.end; ++e) finish(norm_[matrices + e]);
    class_[i] = class_of(row, tilted);
  };
  const auto join_blocks = [&](const ConstraintRow& row) {
    std::uint32_t first = no_row;
    const auto join = [&](int block) {
      if (block_bound_[index(block)] == 0) return;
      const auto own = static_cast<std::uint32_t>(block);
      if (first == no_row) {
        first = own;
      } else {
        finder_.join(first, own);
      }
    };
    const RowMap map(rows, row);
    for (const TranslationEntry& entry : map.translations()) join(entry.block);
    for (const RotationEntry& entry : map.rotations()) join(entry.block);
    for (const MatrixEntry& entry : map.matrices()) join(entry.block);
    return first;
  };
  finder_.reset(blocks.size());
  mover_.resize(rows.size());
  team.for_ranges(rows.size(), rows_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      measure(i);
      mover_[i] = join_blocks(rows.row[i]);
    }
  });
}

}  // namespace brio
