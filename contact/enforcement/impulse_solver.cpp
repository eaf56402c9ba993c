#include "contact/enforcement/impulse_solver.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

using Vector = Vector3<double>;

namespace {

/// Rows and blocks of a task: whatever the number of threads.
constexpr std::size_t rows_a_task = 512;
constexpr std::size_t blocks_a_task = 512;
/// Nothing can move where only rounding of a weight moves the row: below this share of what its lightest
/// block alone would move.
constexpr double held_share = 1e-20;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// Bound of the spectral norm: exact where the matrix is diagonal.
double norm_bound(const SymmetricTensor<double>& a) {
  const double xy = std::abs(a.xy);
  const double yz = std::abs(a.yz);
  const double xz = std::abs(a.xz);
  return std::max({std::abs(a.xx) + xy + xz, std::abs(a.yy) + xy + yz, std::abs(a.zz) + xz + yz});
}
double frobenius_squared(const Tensor<double>& a) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += a.m[i][j] * a.m[i][j];
  return sum;
}
double energy(const SymmetricTensor<double>& inverse_mass, const Vector& impulse) {
  return dot(impulse, inverse_mass * impulse);
}

// c of each kind of entry: |W^(1/2) B^T|, of the normal alone where there is no friction.
double entry_norm(const ConstraintRow& row, const TranslationEntry& entry,
                  const SymmetricTensor<double>& inverse_mass) {
  if (row.friction_coefficient == 0)
    return std::abs(entry.weight) * std::sqrt(energy(inverse_mass, row.normal));
  const double tilt = entry.tilt[0] * entry.tilt[0] + entry.tilt[1] * entry.tilt[1];
  const double map = 0.5 * (std::sqrt(tilt) + std::sqrt(tilt + 4 * entry.weight * entry.weight));
  return map * std::sqrt(norm_bound(inverse_mass));
}
double entry_norm(const ConstraintRow& row, const RotationEntry& entry,
                  const SymmetricTensor<double>& inverse_mass) {
  if (row.friction_coefficient == 0) return std::sqrt(energy(inverse_mass, cross(entry.arm, row.normal)));
  return std::sqrt(dot(entry.arm, entry.arm) * norm_bound(inverse_mass));
}
double entry_norm(const ConstraintRow& row, const MatrixEntry& entry,
                  const SymmetricTensor<double>& inverse_mass) {
  if (row.friction_coefficient == 0)
    return std::sqrt(energy(inverse_mass, transposed_times(entry.matrix, row.normal)));
  return std::sqrt(frobenius_squared(entry.matrix) * norm_bound(inverse_mass));
}

bool is_held(const ConstraintRows& rows, const ConstraintRow& row, std::span<const VelocityBlock> blocks) {
  const RowMap map(rows, row);
  double lightest = 0;
  for (const TranslationEntry& entry : map.translations())
    lightest = std::max(lightest, energy(blocks[index(entry.block)].inverse_mass, row.normal));
  return !(map.inverse_mass(row.normal, blocks) > held_share * lightest);
}

template <class List, class Entry>
void list_by_block(List& list, const ConstraintRows& rows, const std::vector<Entry>& entries,
                   EntryRange ConstraintRow::*range, std::size_t blocks) {
  list.first.assign(blocks + 1, 0);
  list.item.resize(entries.size());
  if (entries.empty()) return;
  for (const Entry& entry : entries) ++list.first[index(entry.block) + 1];
  for (std::size_t b = 0; b < blocks; ++b) list.first[b + 1] += list.first[b];
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::uint32_t e = (rows.row[i].*range).begin; e < (rows.row[i].*range).end; ++e)
      list.item[list.first[index(entries[e].block)]++] = {static_cast<std::uint32_t>(i), e};
  for (std::size_t b = blocks; b > 0; --b) list.first[b] = list.first[b - 1];
  list.first[0] = 0;
}

}  // namespace

void ImpulseSolver::find_majorants(ConstraintRows& rows, std::span<const VelocityBlock> blocks,
                                   ThreadTeam& team) {
  const std::size_t rotations = rows.translation.size();
  const std::size_t matrices = rotations + rows.rotation.size();
  norm_.resize(matrices + rows.matrix.size());
  const auto inverse_mass = [&](int b) -> const SymmetricTensor<double>& {
    return blocks[index(b)].inverse_mass;
  };
  // Of each entry of a row with its place in norm_.
  const auto each_entry = [&](const ConstraintRow& row, auto&& visit) {
    for (std::uint32_t e = row.translation.begin; e < row.translation.end; ++e)
      visit(rows.translation[e], norm_[e]);
    for (std::uint32_t e = row.rotation.begin; e < row.rotation.end; ++e)
      visit(rows.rotation[e], norm_[rotations + e]);
    for (std::uint32_t e = row.matrix.begin; e < row.matrix.end; ++e)
      visit(rows.matrix[e], norm_[matrices + e]);
  };
  team.for_ranges(rows.size(), rows_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const bool held = is_held(rows, rows.row[i], blocks);
      double sum = 0;
      each_entry(rows.row[i], [&](const auto& entry, double& norm) {
        norm = held ? 0 : entry_norm(rows.row[i], entry, inverse_mass(entry.block));
        sum += norm * norm;
      });
      state_[i].majorant = std::sqrt(sum);
      each_entry(rows.row[i], [&](const auto&, double& norm) {
        if (norm > 0) norm /= state_[i].majorant;
      });
    }
  });
  block_norm_.resize(blocks.size());
  team.for_ranges(blocks.size(), blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      double sum = 0;
      const auto add = [&](const IncomingLists& list, std::size_t first) {
        for (std::uint32_t i = list.first[b]; i < list.first[b + 1]; ++i)
          sum += norm_[first + list.item[i].entry];
      };
      add(translation_, 0);
      add(rotation_, rotations);
      add(matrix_, matrices);
      block_norm_[b] = sum;
    }
  });
  team.for_ranges(rows.size(), rows_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double majorant = 0;
      each_entry(rows.row[i],
                 [&](const auto& entry, double norm) { majorant += norm * block_norm_[index(entry.block)]; });
      state_[i].majorant *= state_[i].majorant * majorant;
    }
  });
}

// Impulses that are carried over may no longer be admissible: they are once their row has been visited.
void ImpulseSolver::start_row(const ConstraintRow& row, RowState& state, RowImpulse& given) const {
  const Vector frame[3] = {row.normal, row.tangent[0], row.tangent[1]};
  const bool moves = state.majorant > 0;
  const bool rubs = moves && row.friction_coefficient > 0;
  state.friction_coefficient = row.friction_coefficient;
  for (int axis = 0; axis < 3; ++axis) {
    state.offset[axis] = dot(frame[axis], row.wall_velocity) + (axis == 0 ? row.target_velocity : 0);
    const double carried = axis == 0 ? std::max(row.impulse, 0.0) : dot(frame[axis], row.friction);
    state.last[axis] = state.impulse[axis] = (axis == 0 ? moves : rubs) ? carried : 0;
  }
  given.normal = row.normal;
}

void ImpulseSolver::prepare(ConstraintRows& rows, std::span<const VelocityBlock> blocks, ThreadTeam& team) {
  state_.resize(rows.size());
  given_.resize(rows.size());
  list_by_block(translation_, rows, rows.translation, &ConstraintRow::translation, blocks.size());
  list_by_block(rotation_, rows, rows.rotation, &ConstraintRow::rotation, blocks.size());
  list_by_block(matrix_, rows, rows.matrix, &ConstraintRow::matrix, blocks.size());
  find_majorants(rows, blocks, team);
  team.for_ranges(rows.size(), rows_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      start_row(rows.row[i], state_[i], given_[i]);
      const double* impulse = state_[i].impulse;
      given_[i].force = impulse[0] * rows.row[i].normal + impulse[1] * rows.row[i].tangent[0] +
                        impulse[2] * rows.row[i].tangent[1];
      given_[i].slope[0] = impulse[1];
      given_[i].slope[1] = impulse[2];
    }
  });
}

ImpulseSolver::Sums ImpulseSolver::change_impulses(const ConstraintRows& rows, double momentum,
                                                   ThreadTeam& team) {
  sums_.assign((rows.size() + rows_a_task - 1) / rows_a_task, {});
  team.for_ranges(rows.size(), rows_a_task, [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      RowState& state = state_[i];
      if (state.majorant == 0) continue;
      const ConstraintRow& row = rows.row[i];
      const Vector u = RowMap(rows, row).velocity([&](int b) { return motion_[index(b)].extrapolated; });
      const double step = 1 / state.majorant;
      const double velocity[3] = {dot(row.normal, u), dot(row.tangent[0], u), dot(row.tangent[1], u)};
      double from[3];
      double wanted[3];
      for (int axis = 0; axis < 3; ++axis) {
        from[axis] = state.impulse[axis] + momentum * (state.impulse[axis] - state.last[axis]);
        wanted[axis] = from[axis] - step * (velocity[axis] - state.offset[axis]);
        state.last[axis] = state.impulse[axis];
      }
      state.impulse[0] = std::max(0.0, wanted[0]);
      const double limit = state.friction_coefficient * state.impulse[0];
      const double size = std::sqrt(wanted[1] * wanted[1] + wanted[2] * wanted[2]);
      const double scale = size > limit ? limit / size : 1;
      state.impulse[1] = scale * wanted[1];
      state.impulse[2] = scale * wanted[2];
      double change = 0;
      double turned = 0;
      for (int axis = 0; axis < 3; ++axis) {
        change += square(state.impulse[axis] - from[axis]);
        turned += (from[axis] - state.impulse[axis]) * (state.impulse[axis] - state.last[axis]);
      }
      sums.turned += state.majorant * turned;
      sums.residual = std::max(sums.residual, square(state.majorant) * change);
      sums.largest = std::max(sums.largest, state.majorant * state.impulse[0]);
      given_[i].force = state.impulse[0] * row.normal + state.impulse[1] * row.tangent[0] +
                        state.impulse[2] * row.tangent[1];
      given_[i].slope[0] = state.impulse[1];
      given_[i].slope[1] = state.impulse[2];
    }
    sums_[begin / rows_a_task] = sums;
  });
  Sums total;
  for (const Sums& sums : sums_) {
    total.turned += sums.turned;
    total.residual = std::max(total.residual, sums.residual);
    total.largest = std::max(total.largest, sums.largest);
  }
  total.residual = std::sqrt(total.residual);
  return total;
}

void ImpulseSolver::gather(const ConstraintRows& rows, std::span<const VelocityBlock> blocks, double momentum,
                           ThreadTeam& team) {
  team.for_ranges(blocks.size(), blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      Vector sum{0, 0, 0};
      for (std::uint32_t i = translation_.first[b]; i < translation_.first[b + 1]; ++i) {
        const RowImpulse& given = given_[translation_.item[i].row];
        const TranslationEntry& entry = rows.translation[translation_.item[i].entry];
        sum = sum + (entry.weight * given.force +
                     (entry.tilt[0] * given.slope[0] + entry.tilt[1] * given.slope[1]) * given.normal);
      }
      for (std::uint32_t i = rotation_.first[b]; i < rotation_.first[b + 1]; ++i)
        sum = sum + cross(rows.rotation[rotation_.item[i].entry].arm, given_[rotation_.item[i].row].force);
      for (std::uint32_t i = matrix_.first[b]; i < matrix_.first[b + 1]; ++i)
        sum = sum +
              transposed_times(rows.matrix[matrix_.item[i].entry].matrix, given_[matrix_.item[i].row].force);
      BlockMotion& motion = motion_[b];
      const Vector last = motion.now;
      motion.now = motion.free + blocks[b].inverse_mass * sum;
      motion.extrapolated = motion.now + momentum * (motion.now - last);
    }
  });
}

SolveReport ImpulseSolver::iterate(const SolveOptions& options, ConstraintRows& rows,
                                   std::span<VelocityBlock> blocks, ThreadTeam& team) {
  SolveReport report;
  if (rows.size() == 0) return report;
  prepare(rows, blocks, team);
  gather(rows, blocks, 0, team);
  double momentum = 0;
  double theta = 1;
  report.converged = false;
  while (report.iterations < options.max_iterations && !report.converged) {
    ++report.iterations;
    const Sums sums = change_impulses(rows, momentum, team);
    report.residual = sums.residual;
    report.largest_velocity = sums.largest;
    report.converged = sums.residual <= options.tolerance * sums.largest;
    if (sums.turned > 0) {
      ++report.restarts;
      theta = 1;
      momentum = 0;
    } else {
      const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta * theta));
      momentum = (theta - 1) / next;
      theta = next;
    }
    gather(rows, blocks, momentum, team);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double* impulse = state_[i].impulse;
    rows.row[i].impulse = impulse[0];
    rows.row[i].friction = impulse[1] * rows.row[i].tangent[0] + impulse[2] * rows.row[i].tangent[1];
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) blocks[b].velocity = motion_[b].now;
  return report;
}

SolveReport ImpulseSolver::solve(const SolveOptions& options, ConstraintRows& rows,
                                 std::span<VelocityBlock> blocks, ThreadTeam& team) {
  motion_.clear();
  return solve_further(options, rows, blocks, team);
}

SolveReport ImpulseSolver::solve_further(const SolveOptions& options, ConstraintRows& rows,
                                         std::span<VelocityBlock> blocks, ThreadTeam& team) {
  const std::size_t known = motion_.size();
  motion_.resize(blocks.size());
  for (std::size_t b = known; b < blocks.size(); ++b) motion_[b].free = blocks[b].velocity;
  for (BlockMotion& motion : motion_) motion.now = motion.extrapolated = motion.free;
  return iterate(options, rows, blocks, team);
}

}  // namespace brio
