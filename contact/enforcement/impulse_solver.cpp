#include "contact/enforcement/impulse_solver.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

using Vector = Vector3<double>;

namespace {

/// Rows and blocks of a task: whatever the number of threads.
constexpr std::size_t rows_a_task = 512;
constexpr std::size_t blocks_a_task = 512;

std::size_t index(int i) { return static_cast<std::size_t>(i); }
Vector vector_of(const double* a) { return {a[0], a[1], a[2]}; }
bool is_diagonal(const SymmetricTensor<double>& a) { return a.xy == 0 && a.yz == 0 && a.xz == 0; }

void store_given_of(const RowUnknowns<double, true>& unknown, const ConstraintRow& row, RowImpulse& given) {
  const double* impulse = unknown.impulse;
  const Vector force = impulse[0] * row.normal + impulse[1] * row.tangent[0] + impulse[2] * row.tangent[1];
  given.force[0] = force.x;
  given.force[1] = force.y;
  given.force[2] = force.z;
  given.slope_0 = impulse[1];
  given.slope_1 = impulse[2];
}

template <class Packs, class Visit>
void each_pack(Packs& packs, std::size_t first_slot, std::size_t begin, std::size_t end, Visit&& visit) {
  constexpr std::size_t lanes = lane_count<double>;
  for (std::size_t slot = begin; slot < end; slot += lanes) visit(packs[(slot - first_slot) / lanes], slot);
}

RowSums<double> reduced(const RowSums<Lanes<double>>& sums) {
  RowSums<double> total;
  for (int lane = 0; lane < lane_count<double>; ++lane) {
    total.turned += sums.turned[lane];
    total.residual = std::max(total.residual, sums.residual[lane]);
    total.largest = std::max(total.largest, sums.largest[lane]);
  }
  return total;
}

template <class Packs>
RowSums<double> change_packs(Packs& packs, std::size_t first_slot, std::size_t begin, std::size_t end,
                             const double* velocity, double momentum, RowImpulse* given) {
  RowSums<Lanes<double>> sums;
  each_pack(packs, first_slot, begin, end, [&](auto& pack, std::size_t slot) {
    change_impulses(pack, velocity, momentum, sums, given + slot);
  });
  return reduced(sums);
}

}  // namespace

void ImpulseSolver::store_given(const ConstraintRows& rows, Kind kind, std::size_t begin, std::size_t end) {
  const auto store_packs = [&](const auto& packs) {
    each_pack(packs, first_slot_[kind], begin, end,
              [&](const auto& pack, std::size_t slot) { store_impulses(pack, &given_[slot]); });
  };
  switch (kind) {
    case normal_only:
      return store_packs(normal_packs_);
    case with_friction:
      return store_packs(friction_packs_);
    case with_tilt:
      return store_packs(tilt_packs_);
    default:
      break;
  }
  for (std::size_t slot = begin; slot < end; ++slot)
    if (row_of_slot_[slot] != no_row)
      store_given_of(general_[slot - first_slot_[general]], rows.row[row_of_slot_[slot]], given_[slot]);
}

ImpulseSolver::Sums ImpulseSolver::change_general(const ConstraintRows& rows, double momentum,
                                                  std::size_t begin, std::size_t end) {
  Sums sums;
  for (std::size_t slot = begin; slot < end; ++slot) {
    if (row_of_slot_[slot] == no_row) continue;
    const ConstraintRow& row = rows.row[row_of_slot_[slot]];
    const Vector u =
        RowMap(rows, row).velocity([&](int b) { return vector_of(extrapolated_[index(b)].component); });
    const double velocity[3] = {dot(row.normal, u), dot(row.tangent[0], u), dot(row.tangent[1], u)};
    RowUnknowns<double, true>& unknown = general_[slot - first_slot_[general]];
    change_impulse(unknown, velocity, momentum, sums);
    store_given_of(unknown, row, given_[slot]);
  }
  return sums;
}

ImpulseSolver::Sums ImpulseSolver::change_impulses(const ConstraintRows& rows, double momentum,
                                                   ThreadTeam& team) {
  sums_.resize(slot_ranges());
  const double* velocity = extrapolated_.data()->component;
  each_slot_range(team, [&](Kind kind, std::size_t begin, std::size_t end, std::size_t range) {
    const auto change = [&](auto& packs) {
      return change_packs(packs, first_slot_[kind], begin, end, velocity, momentum, given_.data());
    };
    sums_[range] = kind == normal_only     ? change(normal_packs_)
                   : kind == with_friction ? change(friction_packs_)
                   : kind == with_tilt     ? change(tilt_packs_)
                                           : change_general(rows, momentum, begin, end);
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
  const auto given_to = [&](std::size_t b) {
    Row4 sum = {};
    for (const TranslationItem* item = translation_.begin(b); item != translation_.end(b); ++item)
      sum += item->weight * load_row(given_[item->slot].force);
    for (const TiltedItem* item = tilted_.begin(b); item != tilted_.end(b); ++item) {
      const RowImpulse& given = given_[item->slot];
      sum += item->weight * load_row(given.force);
      sum += (item->tilt[0] * given.slope_0 + item->tilt[1] * given.slope_1) * load_row(given.normal);
    }
    for (const OtherItem* item = rotation_.begin(b); item != rotation_.end(b); ++item) {
      const Vector add = cross(rows.rotation[item->entry].arm, vector_of(given_[item->slot].force));
      sum += Row4{add.x, add.y, add.z, 0};
    }
    for (const OtherItem* item = matrix_.begin(b); item != matrix_.end(b); ++item) {
      const Vector add =
          transposed_times(rows.matrix[item->entry].matrix, vector_of(given_[item->slot].force));
      sum += Row4{add.x, add.y, add.z, 0};
    }
    return sum;
  };
  team.for_ranges(blocks.size(), blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const SymmetricTensor<double>& w = blocks[b].inverse_mass;
      const Row4 sum = given_to(b);
      Row4 change = Row4{w.xx, w.yy, w.zz, 0} * sum;
      if (!is_diagonal(w)) {
        const Vector full = w * Vector{sum[0], sum[1], sum[2]};
        change = Row4{full.x, full.y, full.z, 0};
      }
      const Row4 last = load_row(now_[b].component);
      const Row4 now = load_row(free_[b].component) + change;
      store_row(now_[b].component, now);
      store_row(extrapolated_[b].component, now + momentum * (now - last));
    }
  });
}

void ImpulseSolver::store(ConstraintRows& rows, std::span<VelocityBlock> blocks, ThreadTeam& team) const {
  const auto impulse_in_pack = [&](const auto& packs, std::size_t place, int axis) -> double {
    constexpr std::size_t lanes = lane_count<double>;
    return packs[place / lanes].unknown.impulse[axis][static_cast<int>(place % lanes)];
  };
  team.for_ranges(rows.size(), rows_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t place = slot_[i] - first_slot_[kind_[i]];
      double impulse[3] = {0, 0, 0};
      for (int axis = 0; axis < (kind_[i] == normal_only ? 1 : 3); ++axis)
        impulse[axis] = kind_[i] == normal_only     ? impulse_in_pack(normal_packs_, place, axis)
                        : kind_[i] == with_friction ? impulse_in_pack(friction_packs_, place, axis)
                        : kind_[i] == with_tilt     ? impulse_in_pack(tilt_packs_, place, axis)
                                                    : general_[place].impulse[axis];
      ConstraintRow& row = rows.row[i];
      row.impulse = impulse[0];
      row.friction = impulse[1] * row.tangent[0] + impulse[2] * row.tangent[1];
    }
  });
  team.for_ranges(blocks.size(), blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) blocks[b].velocity = vector_of(now_[b].component);
  });
}

SolveReport ImpulseSolver::solve(const SolveOptions& options, ConstraintRows& rows,
                                 std::span<VelocityBlock> blocks, ThreadTeam& team) {
  free_.clear();
  return solve_further(options, rows, blocks, team);
}

SolveReport ImpulseSolver::solve_further(const SolveOptions& options, ConstraintRows& rows,
                                         std::span<VelocityBlock> blocks, ThreadTeam& team) {
  SolveReport report;
  const std::size_t known = free_.size();
  free_.resize(blocks.size());
  for (std::size_t b = known; b < blocks.size(); ++b)
    free_[b] = {{blocks[b].velocity.x, blocks[b].velocity.y, blocks[b].velocity.z, 0}};
  if (rows.size() == 0) return report;
  now_ = free_;
  extrapolated_.resize(blocks.size());
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
    const bool restart = sums.turned > 0;
    report.restarts += restart;
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta * theta));
    momentum = restart ? 0 : (theta - 1) / next;
    theta = restart ? 1 : next;
    gather(rows, blocks, momentum, team);
  }
  store(rows, blocks, team);
  return report;
}

}  // namespace brio
