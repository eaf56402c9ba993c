#include "contact/enforcement/impulse_solver.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "src/base/index.hpp"

namespace brio {

namespace {

template <class Task>
void each_of(ThreadTeam* team, std::size_t count, Task&& task) {
  if (team != nullptr) return team->for_each(count, task);
  for (std::size_t i = 0; i < count; ++i) task(i);
}

bool is_diagonal(const SymmetricTensor<double>& a) { return a.xy == 0 && a.yz == 0 && a.xz == 0; }

void store_given_of(const RowUnknowns<double, true>& unknown, const ConstraintRow& row, RowImpulse& given) {
  const double* impulse = unknown.impulse;
  const Vector3d force = impulse[0] * row.normal + impulse[1] * row.tangent[0] + impulse[2] * row.tangent[1];
  given.force[0] = force.x;
  given.force[1] = force.y;
  given.force[2] = force.z;
  given.slope_0 = impulse[1];
  given.slope_1 = impulse[2];
}

RowSums<double> joined(const RowSums<double>& a, const RowSums<double>& b) {
  return {a.turned + b.turned, a.counted + b.counted, std::max(a.residual, b.residual),
          std::max(a.largest, b.largest)};
}

RowSums<double> reduced(const RowSums<Lanes<double>>& sums) {
  RowSums<double> total;
  for (int lane = 0; lane < lane_count<double>; ++lane)
    total = joined(total, {sums.turned[lane], sums.counted[lane], sums.residual[lane], sums.largest[lane]});
  return total;
}

}  // namespace

void ImpulseSolver::store_given(const ConstraintRows& rows, std::uint32_t p) {
  const Pack& pack = pack_[p];
  const std::uint32_t first = p * lanes;
  if (pack.kind == normal_only) return store_impulses(normal_packs_[pack.place], &given_[first]);
  if (pack.kind == with_friction) return store_impulses(friction_packs_[pack.place], &given_[first]);
  for (std::uint32_t lane = 0; lane < lanes; ++lane)
    if (const std::uint32_t row = row_of_slot_[first + lane]; row != no_row)
      store_given_of(general_[pack.place * lanes + lane], rows.row[row], given_[first + lane]);
}

void ImpulseSolver::velocity_of(const ConstraintRows& rows, const ConstraintRow& row,
                                const std::vector<BlockVelocity>& blocks, double (&velocity)[3]) {
  const Vector3d u = RowMap(rows, row).velocity([&](int b) { return vector_at(blocks[index(b)].component); });
  velocity[0] = dot(row.normal, u);
  velocity[1] = dot(row.tangent[0], u);
  velocity[2] = dot(row.tangent[1], u);
}

void ImpulseSolver::change_general(const ConstraintRows& rows, const Step& step, std::uint32_t p,
                                   Sums& sums) {
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    const std::uint32_t slot = p * lanes + lane;
    if (row_of_slot_[slot] == no_row) continue;
    const ConstraintRow& row = rows.row[row_of_slot_[slot]];
    double velocity[3];
    velocity_of(rows, row, extrapolated_, velocity);
    RowUnknowns<double, true>& unknown = general_[pack_[p].place * lanes + lane];
    change_impulse(unknown, velocity, step.momentum, step.counted, sums);
    store_given_of(unknown, row, given_[slot]);
  }
}

ImpulseSolver::Sums ImpulseSolver::change_packs(const ConstraintRows& rows, const Step& step,
                                                std::uint32_t begin, std::uint32_t end) {
  const double* velocity = extrapolated_.data()->component;
  RowSums<Lanes<double>> sums;
  Sums of_general;
  const auto change = [&](auto& pack, std::uint32_t p) {
    brio::change_impulses(pack, entries_, velocity, step.momentum, step.counted, sums, &given_[p * lanes]);
  };
  for (std::uint32_t p = begin; p < end; ++p) {
    const Pack& pack = pack_[p];
    if (pack.kind == with_friction) change(friction_packs_[pack.place], p);
    if (pack.kind == normal_only) change(normal_packs_[pack.place], p);
    if (pack.kind == general) change_general(rows, step, p, of_general);
  }
  return joined(reduced(sums), of_general);
}

ImpulseSolver::Sums ImpulseSolver::change_impulses(const ConstraintRows& rows, const Island& island,
                                                   const Step& step, ThreadTeam* team) {
  constexpr std::uint32_t of_task = packs_a_task;
  const std::uint32_t tasks = (island.pack_end - island.pack_begin + of_task - 1) / of_task;
  const auto run = [&](std::size_t task) {
    const std::uint32_t begin = island.pack_begin + static_cast<std::uint32_t>(task) * of_task;
    return change_packs(rows, step, begin, std::min(begin + of_task, island.pack_end));
  };
  Sums total;
  if (team == nullptr) {
    for (std::uint32_t task = 0; task < tasks; ++task) total = joined(total, run(task));
  } else {
    sums_.resize(tasks);
    team->for_each(tasks, [&](std::size_t task) { sums_[task] = run(task); });
    for (const Sums& one : sums_) total = joined(total, one);
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
    const Vector3d add = cross(rows.rotation[item->entry].arm, vector_at(given_[item->slot].force));
    sum += Row4{add.x, add.y, add.z, 0};
  }
  for (const OtherItem* item = matrix_.begin(b); item != matrix_.end(b); ++item) {
    const Vector3d add =
        transposed_times(rows.matrix[item->entry].matrix, vector_at(given_[item->slot].force));
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
        const Vector3d full = w * Vector3d{sum[0], sum[1], sum[2]};
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
  const auto copy = [](const auto& from, int lane, double(&impulse)[3]) {
    for (int axis = 0; axis < std::decay_t<decltype(from)>::axes; ++axis)
      impulse[axis] = from.impulse[axis][lane];
  };
  team.for_ranges(rows.size(), rows_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Pack& pack = pack_[slot_[i] / lanes];
      const auto lane = static_cast<int>(slot_[i] % lanes);
      double impulse[3] = {0, 0, 0};
      if (pack.kind == normal_only) copy(normal_packs_[pack.place].unknown, lane, impulse);
      if (pack.kind == with_friction) copy(friction_packs_[pack.place].unknown, lane, impulse);
      if (pack.kind == general)
        std::copy_n(general_[pack.place * lanes + slot_[i] % lanes].impulse, 3, impulse);
      ConstraintRow& row = rows.row[i];
      row.impulse = impulse[0];
      row.friction = impulse[1] * row.tangent[0] + impulse[2] * row.tangent[1];
    }
  });
  team.for_ranges(blocks.size(), blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) blocks[b].velocity = vector_at(now_[b].component);
  });
}

// Calls `visit_pack(pack)` and `visit_row(unknown, row)`, for rows that are in no pack.
template <class VisitPack, class VisitRow>
void ImpulseSolver::each_row(const ConstraintRows& rows, const Island& island, const VisitPack& visit_pack,
                             const VisitRow& visit_row) {
  for (std::uint32_t p = island.pack_begin; p < island.pack_end; ++p) {
    const Pack& pack = pack_[p];
    if (pack.kind == normal_only) visit_pack(normal_packs_[pack.place]);
    if (pack.kind == with_friction) visit_pack(friction_packs_[pack.place]);
    if (pack.kind != general) continue;
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      if (const std::uint32_t row = row_of_slot_[p * lanes + lane]; row != no_row)
        visit_row(general_[pack.place * lanes + lane], rows.row[row]);
  }
}

// Of impulses J as iterated: J . (u - offset) > 0 is work that the exact ones do not do. It ends at a share
// of J, since u is linear in it; smaller impulses are admissible.
void ImpulseSolver::take_excess(const ConstraintRows& rows, const Island& island) {
  double work = 0;
  each_row(
      rows, island, [&](const auto& pack) { work += work_of(pack, entries_, now_.data()->component); },
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

}  // namespace brio
