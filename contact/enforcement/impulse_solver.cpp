#include "contact/enforcement/impulse_solver.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

using Vector = Vector3<double>;

namespace {

/// Rows and blocks of a task: whatever the number of threads.
constexpr std::size_t rows_a_task = 512;
constexpr std::size_t blocks_a_task = 512;

/// Islands of more rows are worked on by the whole team.
constexpr std::size_t most_rows_of_small = 4096;

template <class Task>
void each_of(ThreadTeam* team, std::size_t count, Task&& task) {
  if (team != nullptr) return team->for_each(count, task);
  for (std::size_t i = 0; i < count; ++i) task(i);
}

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

/// \param place of the first slot among the packs.
template <class Packs, class Visit>
void each_pack(Packs& packs, std::size_t place, std::size_t begin, std::size_t end, Visit&& visit) {
  constexpr std::size_t lanes = lane_count<double>;
  for (std::size_t slot = begin; slot < end; slot += lanes, place += lanes) visit(packs[place / lanes], slot);
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
RowSums<double> change_packs(Packs& packs, std::size_t place, std::size_t begin, std::size_t end,
                             const double* velocity, double momentum, RowImpulse* given) {
  RowSums<Lanes<double>> sums;
  each_pack(packs, place, begin, end, [&](auto& pack, std::size_t slot) {
    change_impulses(pack, velocity, momentum, sums, given + slot);
  });
  return reduced(sums);
}

}  // namespace

void ImpulseSolver::store_given(const ConstraintRows& rows, Kind kind, std::size_t begin, std::size_t end) {
  const auto store_packs = [&](const auto& packs) {
    each_pack(packs, place_[begin], begin, end,
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
      store_given_of(general_[place_[slot]], rows.row[row_of_slot_[slot]], given_[slot]);
}

void ImpulseSolver::velocity_of(const ConstraintRows& rows, const ConstraintRow& row,
                                const std::vector<BlockVelocity>& blocks, double (&velocity)[3]) {
  const Vector u = RowMap(rows, row).velocity([&](int b) { return vector_of(blocks[index(b)].component); });
  velocity[0] = dot(row.normal, u);
  velocity[1] = dot(row.tangent[0], u);
  velocity[2] = dot(row.tangent[1], u);
}

ImpulseSolver::Sums ImpulseSolver::change_general(const ConstraintRows& rows, double momentum,
                                                  std::size_t begin, std::size_t end) {
  Sums sums;
  for (std::size_t slot = begin; slot < end; ++slot) {
    if (row_of_slot_[slot] == no_row) continue;
    const ConstraintRow& row = rows.row[row_of_slot_[slot]];
    double velocity[3];
    velocity_of(rows, row, extrapolated_, velocity);
    RowUnknowns<double, true>& unknown = general_[place_[slot]];
    change_impulse(unknown, velocity, momentum, sums);
    store_given_of(unknown, row, given_[slot]);
  }
  return sums;
}

ImpulseSolver::Sums ImpulseSolver::change_impulses(const ConstraintRows& rows, const Island& island,
                                                   double momentum, ThreadTeam* team) {
  const double* velocity = extrapolated_.data()->component;
  each_of(team, island.piece_end - island.piece_begin, [&](std::size_t p) {
    const auto& [kind, begin, end] = piece_[island.piece_begin + p];
    const std::size_t place = place_[begin];
    RowImpulse* given = given_.data();
    Sums& sums = sums_[island.piece_begin + p];
    switch (kind) {
      case normal_only:
        sums = change_packs(normal_packs_, place, begin, end, velocity, momentum, given);
        break;
      case with_friction:
        sums = change_packs(friction_packs_, place, begin, end, velocity, momentum, given);
        break;
      case with_tilt:
        sums = change_packs(tilt_packs_, place, begin, end, velocity, momentum, given);
        break;
      default:
        sums = change_general(rows, momentum, begin, end);
    }
  });
  Sums total;
  for (std::size_t p = island.piece_begin; p < island.piece_end; ++p) {
    total.turned += sums_[p].turned;
    total.residual = std::max(total.residual, sums_[p].residual);
    total.largest = std::max(total.largest, sums_[p].largest);
  }
  total.residual = std::sqrt(total.residual);
  return total;
}

// Impulse that the rows give to a block.
Row4 ImpulseSolver::given_to(const ConstraintRows& rows, std::size_t b) const {
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
    const Vector add = transposed_times(rows.matrix[item->entry].matrix, vector_of(given_[item->slot].force));
    sum += Row4{add.x, add.y, add.z, 0};
  }
  return sum;
}

void ImpulseSolver::gather(const ConstraintRows& rows, std::span<const VelocityBlock> blocks,
                           const Island& island, double momentum, ThreadTeam* team) {
  const std::uint32_t* order = block_order_.data() + island.block_begin;
  const std::size_t count = island.block_end - island.block_begin;
  each_of(team, (count + blocks_a_task - 1) / blocks_a_task, [&](std::size_t task) {
    for (std::size_t k = task * blocks_a_task; k < std::min((task + 1) * blocks_a_task, count); ++k) {
      const std::size_t b = order[k];
      const SymmetricTensor<double>& w = blocks[b].inverse_mass;
      const Row4 sum = given_to(rows, b);
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
      const std::size_t place = place_[slot_[i]];
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
  const std::size_t known = free_.size();
  free_.resize(blocks.size());
  for (std::size_t b = known; b < blocks.size(); ++b)
    free_[b] = {{blocks[b].velocity.x, blocks[b].velocity.y, blocks[b].velocity.z, 0}};
  SolveReport total;
  if (rows.size() == 0) return total;
  now_ = extrapolated_ = free_;
  prepare(rows, blocks, team);
  sums_.resize(piece_.size());
  report_.resize(island_.size());
  // Small islands in groups of about as many rows: where each begins.
  small_.clear();
  std::size_t gathered = rows_a_task;
  for (std::size_t n = 0; n < island_.size(); ++n) {
    if (island_[n].rows > most_rows_of_small) continue;
    if (gathered >= rows_a_task) {
      small_.push_back(static_cast<std::uint32_t>(n));
      gathered = 0;
    }
    gathered += island_[n].rows;
  }
  team.for_each(small_.size(), [&](std::size_t group) {
    const std::size_t end = group + 1 < small_.size() ? small_[group + 1] : island_.size();
    for (std::size_t n = small_[group]; n < end; ++n)
      if (island_[n].rows <= most_rows_of_small)
        report_[n] = solve_island(options, rows, blocks, island_[n], nullptr);
  });
  for (std::size_t n = 0; n < island_.size(); ++n) {
    if (island_[n].rows > most_rows_of_small)
      report_[n] = solve_island(options, rows, blocks, island_[n], &team);
    const SolveReport& own = report_[n];
    total.iterations = std::max(total.iterations, own.iterations);
    total.restarts += own.restarts;
    total.residual = std::max(total.residual, own.residual);
    total.largest_velocity = std::max(total.largest_velocity, own.largest_velocity);
    total.converged = total.converged && own.converged;
    total.islands += own.islands;
    total.row_iterations += own.row_iterations;
  }
  store(rows, blocks, team);
  return total;
}

// Calls `visit_pack(pack)` and `visit_row(unknown, row)`, for rows that are in no pack.
template <class VisitPack, class VisitRow>
void ImpulseSolver::each_row(const ConstraintRows& rows, const Island& island, const VisitPack& visit_pack,
                             const VisitRow& visit_row) {
  for (std::size_t p = island.piece_begin; p < island.piece_end; ++p) {
    const auto& [kind, begin, end] = piece_[p];
    const auto visit_packs = [&](auto& packs) {
      each_pack(packs, place_[begin], begin, end, [&](auto& pack, std::size_t) { visit_pack(pack); });
    };
    if (kind == normal_only) visit_packs(normal_packs_);
    if (kind == with_friction) visit_packs(friction_packs_);
    if (kind == with_tilt) visit_packs(tilt_packs_);
    if (kind != general) continue;
    for (std::size_t slot = begin; slot < end; ++slot)
      if (const std::uint32_t row = row_of_slot_[slot]; row != no_row)
        visit_row(general_[place_[slot]], rows.row[row]);
  }
}

// Of impulses J as iterated: J . (u - offset) > 0 is work that the exact ones do not do. It ends at a share
// of J, since u is linear in it; smaller impulses are admissible.
void ImpulseSolver::take_excess(const ConstraintRows& rows, const Island& island) {
  double work = 0;
  each_row(
      rows, island, [&](const auto& pack) { work += work_of(pack, now_.data()->component); },
      [&](const auto& unknown, const ConstraintRow& row) {
        double velocity[3];
        velocity_of(rows, row, now_, velocity);
        work += work_of(unknown, velocity);
      });
  if (!(work > 0)) return;
  double quadratic = 0;
  for (std::uint32_t k = island.block_begin; k < island.block_end; ++k) {
    const std::uint32_t b = block_order_[k];
    const Row4 change = given_to(rows, b) * (load_row(now_[b].component) - load_row(free_[b].component));
    quadratic += change[0] + change[1] + change[2];
  }
  if (!(quadratic > 0)) return;
  const double share = std::max(1 - work / quadratic, 0.0);
  const auto scale = [&](auto& unknown) {
    for (auto& impulse : unknown.impulse) impulse *= share;
  };
  each_row(
      rows, island, [&](auto& pack) { scale(pack.unknown); },
      [&](auto& unknown, const ConstraintRow&) { scale(unknown); });
  for (std::uint32_t k = island.block_begin; k < island.block_end; ++k) {
    const std::uint32_t b = block_order_[k];
    const Row4 free = load_row(free_[b].component);
    store_row(now_[b].component, free + share * (load_row(now_[b].component) - free));
  }
}

// \param team of a large island; null: one thread alone.
SolveReport ImpulseSolver::solve_island(const SolveOptions& options, const ConstraintRows& rows,
                                        std::span<const VelocityBlock> blocks, const Island& island,
                                        ThreadTeam* team) {
  SolveReport report;
  if (island.rows == 0) return report;
  gather(rows, blocks, island, 0, team);
  double momentum = 0;
  double theta = 1;
  report.islands = 1;
  report.converged = false;
  while (report.iterations < options.max_iterations && !report.converged) {
    ++report.iterations;
    const Sums sums = change_impulses(rows, island, momentum, team);
    report.residual = sums.residual;
    report.largest_velocity = sums.largest;
    report.converged = sums.residual <= options.tolerance * sums.largest;
    const bool restart = sums.turned > 0;
    report.restarts += restart;
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta * theta));
    momentum = restart ? 0 : (theta - 1) / next;
    theta = restart ? 1 : next;
    gather(rows, blocks, island, momentum, team);
  }
  take_excess(rows, island);
  report.row_iterations = island.rows * static_cast<std::size_t>(report.iterations);
  return report;
}

}  // namespace brio
