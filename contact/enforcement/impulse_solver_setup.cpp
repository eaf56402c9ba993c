#include <algorithm>
#include <iterator>

#include "contact/enforcement/impulse_solver.hpp"

namespace brio {

using Vector = Vector3<double>;

namespace {

constexpr std::size_t blocks_a_task = 1024;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

// Island after island and kind after kind, each from a full pack on, in the order of rows. Rows that move
// nothing are an island at the end.
void ImpulseSolver::assign_slots(const ConstraintRows& rows) {
  constexpr std::size_t lanes = lane_count<double>;
  slot_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    mover_[i] = mover_[i] == no_row ? no_row : finder_.number(mover_[i]);
  const std::size_t islands = finder_.size() + 1;
  count_.assign(islands * kinds, 0);
  const auto key = [&](std::size_t i) {
    return (mover_[i] == no_row ? islands - 1 : mover_[i]) * kinds + kind_[i];
  };
  for (std::size_t i = 0; i < rows.size(); ++i) ++count_[key(i)];
  island_.clear();
  piece_.clear();
  place_.clear();
  std::uint32_t next = 0;
  std::uint32_t next_place[kinds] = {};
  for (std::size_t n = 0; n < islands; ++n) {
    Island& island = island_.emplace_back();
    island.piece_begin = static_cast<std::uint32_t>(piece_.size());
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      std::uint32_t& count = count_[n * kinds + kind];
      island.rows += count;
      const auto end = static_cast<std::uint32_t>(next + (count + lanes - 1) / lanes * lanes);
      count = next;
      for (; next < end; next += slots_a_piece) {
        const std::uint32_t last = std::min(next + slots_a_piece, end);
        piece_.push_back({static_cast<Kind>(kind), next, last});
      }
      next = end;
      while (place_.size() < end) place_.push_back(next_place[kind]++);
    }
    island.piece_end = static_cast<std::uint32_t>(piece_.size());
  }
  row_of_slot_.assign(next, no_row);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    slot_[i] = count_[key(i)]++;
    row_of_slot_[slot_[i]] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t kind = 0; kind < kinds; ++kind) slots_of_kind_[kind] = next_place[kind];
}

void ImpulseSolver::order_blocks(std::size_t blocks) {
  count_.assign(island_.size() + 1, 0);
  const auto each_moved = [&](auto&& visit) {
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto block = static_cast<std::uint32_t>(b);
      const std::uint32_t island = block_bound_[b] == 0 ? IslandFinder::none : finder_.number_if_any(block);
      if (island != IslandFinder::none) visit(block, island);
    }
  };
  each_moved([&](std::uint32_t, std::uint32_t island) { ++count_[island]; });
  std::uint32_t next = 0;
  for (std::size_t n = 0; n < island_.size(); ++n) {
    island_[n].block_begin = next;
    next += count_[n];
    count_[n] = island_[n].block_begin;
    island_[n].block_end = next;
  }
  block_order_.resize(next);
  each_moved([&](std::uint32_t block, std::uint32_t island) { block_order_[count_[island]++] = block; });
}

void ImpulseSolver::list_entries(const ConstraintRows& rows, std::size_t blocks, ThreadTeam& team) {
  const auto is_plain = [&](std::size_t i) { return kind_[i] == normal_only || kind_[i] == with_friction; };
  translation_.build(slots_of_kind_[normal_only] + slots_of_kind_[with_friction] > 0 ? rows.size() : 0,
                     blocks, team, [&](std::size_t i, auto&& visit) {
                       if (!is_plain(i)) return;
                       const EntryRange range = rows.row[i].translation;
                       for (std::uint32_t e = range.begin; e < range.end; ++e)
                         visit(rows.translation[e].block, [&] {
                           return TranslationItem{slot_[i], e, rows.translation[e].weight};
                         });
                     });
  const bool any_tilted = slots_of_kind_[with_tilt] + slots_of_kind_[general] > 0;
  tilted_.build(any_tilted ? rows.size() : 0, blocks, team, [&](std::size_t i, auto&& visit) {
    if (is_plain(i)) return;
    const EntryRange range = rows.row[i].translation;
    for (std::uint32_t e = range.begin; e < range.end; ++e) {
      const TranslationEntry& entry = rows.translation[e];
      visit(entry.block, [&] {
        return TiltedItem{slot_[i], e, entry.weight, {entry.tilt[0], entry.tilt[1]}};
      });
    }
  });
  const auto list = [&](EntryLists<OtherItem>& lists, const auto& entries, EntryRange ConstraintRow::*range) {
    lists.build(entries.empty() ? 0 : rows.size(), blocks, team, [&](std::size_t i, auto&& visit) {
      const EntryRange own = rows.row[i].*range;
      for (std::uint32_t e = own.begin; e < own.end; ++e)
        visit(entries[e].block, [&] { return OtherItem{slot_[i], e}; });
    });
  };
  list(rotation_, rows.rotation, &ConstraintRow::rotation);
  list(matrix_, rows.matrix, &ConstraintRow::matrix);
}

void ImpulseSolver::sum_block_norms(const ConstraintRows& rows, std::size_t blocks, ThreadTeam& team) {
  const std::size_t rotations = rows.translation.size();
  const std::size_t matrices = rotations + rows.rotation.size();
  team.for_ranges(blocks, blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      double sum = 0;
      const auto add = [&](const auto& lists, std::size_t first) {
        for (const auto* item = lists.begin(b); item != lists.end(b); ++item)
          sum += norm_[first + item->entry];
      };
      add(translation_, 0);
      add(tilted_, 0);
      add(rotation_, rotations);
      add(matrix_, matrices);
      block_norm_[b] = sum;
    }
  });
}

namespace {

// Impulses that are carried over may no longer be admissible: they are once their row has been visited.
template <class T, bool friction, class Set>
void start(RowUnknowns<T, friction>& unknown, const ConstraintRow& row, double majorant, Set&& set) {
  const Vector frame[3] = {row.normal, row.tangent[0], row.tangent[1]};
  const bool moves = majorant > 0;
  set(unknown.majorant, majorant);
  set(unknown.step, moves ? 1 / majorant : 0);
  set(unknown.friction_coefficient, row.friction_coefficient);
  for (int axis = 0; axis < RowUnknowns<T, friction>::axes; ++axis) {
    set(unknown.offset[axis], dot(frame[axis], row.wall_velocity) + (axis == 0 ? row.target_velocity : 0));
    double impulse = 0;
    if (moves && axis == 0) impulse = std::max(row.impulse, 0.0);
    if (moves && axis > 0 && row.friction_coefficient > 0) impulse = dot(frame[axis], row.friction);
    set(unknown.impulse[axis], impulse);
    set(unknown.last[axis], impulse);
  }
}

}  // namespace

template <bool friction, bool tilt>
void ImpulseSolver::fill_lane(std::vector<RowPack<friction, tilt>>& packs, const ConstraintRows& rows,
                              std::size_t i) {
  const ConstraintRow& row = rows.row[i];
  const std::size_t place = place_[slot_[i]];
  RowPack<friction, tilt>& pack = packs[place / lane_count<double>];
  const auto lane = static_cast<int>(place % lane_count<double>);
  double majorant = 0;
  int k = 0;
  for (std::uint32_t e = row.translation.begin; e < row.translation.end; ++e, ++k) {
    const TranslationEntry& entry = rows.translation[e];
    majorant += norm_[e] * block_norm_[index(entry.block)];
    pack.block[k][lane] = entry.block;
    pack.weight[k].set(lane, entry.weight);
    if constexpr (tilt)
      for (int t = 0; t < 2; ++t) pack.tilt[2 * k + t].set(lane, entry.tilt[t]);
  }
  for (; k < RowPack<friction, tilt>::entries; ++k) {
    pack.block[k][lane] = pack.block[0][lane];
    pack.weight[k].set(lane, 0);
    if constexpr (tilt)
      for (int t = 0; t < 2; ++t) pack.tilt[2 * k + t].set(lane, 0);
  }
  const Vector frame[3] = {row.normal, row.tangent[0], row.tangent[1]};
  for (int axis = 0; axis < (friction ? 3 : 1); ++axis) {
    pack.frame[3 * axis].set(lane, frame[axis].x);
    pack.frame[3 * axis + 1].set(lane, frame[axis].y);
    pack.frame[3 * axis + 2].set(lane, frame[axis].z);
  }
  start(pack.unknown, row, squared_scale_[i] * majorant,
        [&](Lanes<double>& to, double value) { to.set(lane, value); });
}

void ImpulseSolver::fill_general(const ConstraintRows& rows, std::size_t i) {
  const std::size_t rotations = rows.translation.size();
  const std::size_t matrices = rotations + rows.rotation.size();
  const ConstraintRow& row = rows.row[i];
  double majorant = 0;
  const auto add = [&](double norm, int block) { majorant += norm * block_norm_[index(block)]; };
  for (std::uint32_t e = row.translation.begin; e < row.translation.end; ++e)
    add(norm_[e], rows.translation[e].block);
  for (std::uint32_t e = row.rotation.begin; e < row.rotation.end; ++e)
    add(norm_[rotations + e], rows.rotation[e].block);
  for (std::uint32_t e = row.matrix.begin; e < row.matrix.end; ++e)
    add(norm_[matrices + e], rows.matrix[e].block);
  start(general_[place_[slot_[i]]], row, squared_scale_[i] * majorant,
        [](double& to, double value) { to = value; });
}

void ImpulseSolver::fill_rows(const ConstraintRows& rows, ThreadTeam& team) {
  constexpr std::size_t lanes = lane_count<double>;
  normal_packs_.resize(slots_of_kind_[normal_only] / lanes);
  friction_packs_.resize(slots_of_kind_[with_friction] / lanes);
  tilt_packs_.resize(slots_of_kind_[with_tilt] / lanes);
  general_.resize(slots_of_kind_[general]);
  given_.resize(row_of_slot_.size());
  // The last pack of a kind and island: lanes without a row read a block of their island.
  const auto clear = [&](auto& packs, std::size_t end) {
    const ConstraintRow& row = rows.row[row_of_slot_[end - lanes]];
    auto& pack = packs[place_[end - 1] / lanes];
    pack = {};
    for (auto& blocks : pack.block)
      std::fill(std::begin(blocks), std::end(blocks), rows.translation[row.translation.begin].block);
  };
  team.for_each(piece_.size(), [&](std::size_t p) {
    const Piece& piece = piece_[p];
    if (row_of_slot_[piece.end - 1] == no_row) {
      if (piece.kind == normal_only) clear(normal_packs_, piece.end);
      if (piece.kind == with_friction) clear(friction_packs_, piece.end);
      if (piece.kind == with_tilt) clear(tilt_packs_, piece.end);
    }
    for (std::size_t slot = piece.begin; slot < piece.end; ++slot) {
      const std::uint32_t i = row_of_slot_[slot];
      if (i == no_row) continue;
      const Vector& normal = rows.row[i].normal;
      given_[slot] = {{0, 0, 0}, 0, {normal.x, normal.y, normal.z}, 0};
      switch (piece.kind) {
        case normal_only:
          fill_lane(normal_packs_, rows, i);
          break;
        case with_friction:
          fill_lane(friction_packs_, rows, i);
          break;
        case with_tilt:
          fill_lane(tilt_packs_, rows, i);
          break;
        default:
          fill_general(rows, i);
      }
    }
    store_given(rows, piece.kind, piece.begin, piece.end);
  });
}

void ImpulseSolver::prepare(const ConstraintRows& rows, std::span<const VelocityBlock> blocks,
                            ThreadTeam& team) {
  measure_blocks(blocks, team);
  measure_rows(rows, blocks, team);
  assign_slots(rows);
  order_blocks(blocks.size());
  list_entries(rows, blocks.size(), team);
  sum_block_norms(rows, blocks.size(), team);
  fill_rows(rows, team);
}

}  // namespace brio
