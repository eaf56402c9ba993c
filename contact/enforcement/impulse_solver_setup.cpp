#include <algorithm>
#include <iterator>
#include <utility>

#include "contact/enforcement/impulse_solver.hpp"
#include "src/base/index.hpp"

namespace brio {

// Island after island and class after class, each kind from a full pack on, in the order of rows. Rows that
// move nothing are an island at the end.
void ImpulseSolver::assign_slots(const ConstraintRows& rows) {
  slot_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    mover_[i] = mover_[i] == no_row ? no_row : finder_.number(mover_[i]);
  const std::size_t islands = finder_.size() + 1;
  count_.assign(islands * classes, 0);
  const auto key = [&](std::size_t i) {
    return (mover_[i] == no_row ? islands - 1 : mover_[i]) * classes + class_[i];
  };
  for (std::size_t i = 0; i < rows.size(); ++i) ++count_[key(i)];
  island_.clear();
  pack_.clear();
  std::fill(std::begin(packs_of_kind_), std::end(packs_of_kind_), 0);
  std::uint32_t next = 0;
  for (std::size_t n = 0; n < islands; ++n) {
    Island& island = island_.emplace_back();
    island.pack_begin = next / lanes;
    for (std::uint8_t c = 0; c < classes; ++c) {
      if (c > 0 && kind_of(c) != kind_of(static_cast<std::uint8_t>(c - 1)))
        next = (next + lanes - 1) / lanes * lanes;
      std::uint32_t& count = count_[n * classes + c];
      island.rows += count;
      next += std::exchange(count, next);
      while (pack_.size() * lanes < next) pack_.push_back({kind_of(c), packs_of_kind_[kind_of(c)]++});
    }
    next = (next + lanes - 1) / lanes * lanes;
    island.pack_end = next / lanes;
  }
  row_of_slot_.assign(next, no_row);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    slot_[i] = count_[key(i)]++;
    row_of_slot_[slot_[i]] = static_cast<std::uint32_t>(i);
  }
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
  bool any_plain = false, any_tilted = false;
  for (const std::uint8_t c : class_) (tilts(c) ? any_tilted : any_plain) = true;
  translation_.build(any_plain ? rows.size() : 0, blocks, team, [&](std::size_t i, auto&& visit) {
    if (tilts(class_[i])) return;
    const EntryRange range = rows.row[i].translation;
    for (std::uint32_t e = range.begin; e < range.end; ++e)
      visit(rows.translation[e].block, [&] {
        return TranslationItem{slot_[i], e, rows.translation[e].weight};
      });
  });
  tilted_.build(any_tilted ? rows.size() : 0, blocks, team, [&](std::size_t i, auto&& visit) {
    if (!tilts(class_[i])) return;
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
  const Vector3d frame[3] = {row.normal, row.tangent[0], row.tangent[1]};
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

// How many entries the packs have, and where.
void ImpulseSolver::reserve_entries(const ConstraintRows& rows, ThreadTeam& team) {
  normal_packs_.resize(packs_of_kind_[normal_only]);
  friction_packs_.resize(packs_of_kind_[with_friction]);
  general_.resize(std::size_t{packs_of_kind_[general]} * lanes);
  given_.resize(row_of_slot_.size());
  const auto each_pack = [&](std::size_t begin, std::size_t end, auto&& visit) {
    for (std::size_t p = begin; p < end; ++p) {
      if (pack_[p].kind == normal_only) visit(p, normal_packs_[pack_[p].place]);
      if (pack_[p].kind == with_friction) visit(p, friction_packs_[pack_[p].place]);
    }
  };
  team.for_ranges(pack_.size(), packs_a_task, [&](std::size_t begin, std::size_t end) {
    each_pack(begin, end, [&](std::size_t p, auto& pack) {
      pack.translation = pack.tilt = pack.rotation = {};
      for (std::size_t slot = p * lanes; slot < (p + 1) * lanes; ++slot) {
        const std::uint32_t i = row_of_slot_[slot];
        if (i == no_row) continue;
        const ConstraintRow& row = rows.row[i];
        pack.translation.end = std::max(pack.translation.end, row.translation.size());
        if (tilts(class_[i])) pack.tilt.end = std::max(pack.tilt.end, row.translation.size());
        pack.rotation.end = std::max(pack.rotation.end, row.rotation.size());
      }
    });
  });
  std::uint32_t translations = 0, tilts = 0, rotations = 0;
  const auto place = [](EntryRange& range, std::uint32_t& next) {
    range = {next, next + range.end};
    next = range.end;
  };
  each_pack(0, pack_.size(), [&](std::size_t, auto& pack) {
    place(pack.translation, translations);
    place(pack.tilt, tilts);
    place(pack.rotation, rotations);
  });
  entries_.translation.resize(translations);
  entries_.tilt.resize(tilts);
  entries_.rotation.resize(rotations);
}

// Lanes without an entry read a block of their island.
void ImpulseSolver::clear_entries(const ConstraintRows& rows, std::size_t pack, EntryRange translation,
                                  EntryRange tilt, EntryRange rotation) {
  int block = 0;
  for (std::size_t slot = pack * lanes; slot < (pack + 1) * lanes; ++slot) {
    if (row_of_slot_[slot] == no_row) continue;
    const ConstraintRow& row = rows.row[row_of_slot_[slot]];
    if (row.translation.size() > 0) block = rows.translation[row.translation.begin].block;
    if (row.rotation.size() > 0) block = rows.rotation[row.rotation.begin].block;
  }
  for (std::uint32_t k = translation.begin; k < translation.end; ++k) {
    entries_.translation[k].weight = 0.0;
    std::fill_n(entries_.translation[k].block, lanes, block);
  }
  for (std::uint32_t k = tilt.begin; k < tilt.end; ++k) entries_.tilt[k] = {{0.0, 0.0}};
  for (std::uint32_t k = rotation.begin; k < rotation.end; ++k) {
    for (auto& arm : entries_.rotation[k].arm) arm = 0.0;
    std::fill_n(entries_.rotation[k].block, lanes, block);
  }
}

template <bool friction>
void ImpulseSolver::fill_lane(std::vector<RowPack<friction>>& packs, const ConstraintRows& rows,
                              std::uint32_t slot) {
  const std::uint32_t i = row_of_slot_[slot];
  const ConstraintRow& row = rows.row[i];
  RowPack<friction>& pack = packs[pack_[slot / lanes].place];
  const auto lane = static_cast<int>(slot % lanes);
  double majorant = 0;
  for (std::uint32_t k = 0; k < row.translation.size(); ++k) {
    const std::uint32_t e = row.translation.begin + k;
    const TranslationEntry& entry = rows.translation[e];
    majorant += norm_[e] * block_norm_[index(entry.block)];
    TranslationLanes& to = entries_.translation[pack.translation.begin + k];
    to.block[lane] = entry.block;
    to.weight.set(lane, entry.weight);
    if (k >= pack.tilt.size()) continue;
    for (int t = 0; t < 2; ++t) entries_.tilt[pack.tilt.begin + k].along[t].set(lane, entry.tilt[t]);
  }
  for (std::uint32_t k = 0; k < row.rotation.size(); ++k) {
    const std::uint32_t e = row.rotation.begin + k;
    const RotationEntry& entry = rows.rotation[e];
    majorant += norm_[rows.translation.size() + e] * block_norm_[index(entry.block)];
    RotationLanes& to = entries_.rotation[pack.rotation.begin + k];
    to.block[lane] = entry.block;
    to.arm[0].set(lane, entry.arm.x);
    to.arm[1].set(lane, entry.arm.y);
    to.arm[2].set(lane, entry.arm.z);
  }
  const Vector3d frame[3] = {row.normal, row.tangent[0], row.tangent[1]};
  for (int axis = 0; axis < (friction ? 3 : 1); ++axis) {
    pack.frame[3 * axis].set(lane, frame[axis].x);
    pack.frame[3 * axis + 1].set(lane, frame[axis].y);
    pack.frame[3 * axis + 2].set(lane, frame[axis].z);
  }
  start(pack.unknown, row, squared_scale_[i] * majorant,
        [&](Lanes<double>& to, double value) { to.set(lane, value); });
}

template <bool friction>
void ImpulseSolver::fill_pack(std::vector<RowPack<friction>>& packs, const ConstraintRows& rows,
                              std::uint32_t p) {
  RowPack<friction>& pack = packs[pack_[p].place];
  clear_entries(rows, p, pack.translation, pack.tilt, pack.rotation);
  if (row_of_slot_[(p + 1) * lanes - 1] == no_row) {
    pack.unknown = {};
    for (auto& axis : pack.frame) axis = 0.0;
  }
  for (std::uint32_t slot = p * lanes; slot < (p + 1) * lanes; ++slot)
    if (row_of_slot_[slot] != no_row) fill_lane(packs, rows, slot);
}

void ImpulseSolver::fill_general(const ConstraintRows& rows, std::uint32_t slot) {
  const std::uint32_t i = row_of_slot_[slot];
  if (i == no_row) return;
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
  start(general_[pack_[slot / lanes].place * lanes + slot % lanes], row, squared_scale_[i] * majorant,
        [](double& to, double value) { to = value; });
}

void ImpulseSolver::fill_rows(const ConstraintRows& rows, ThreadTeam& team) {
  reserve_entries(rows, team);
  team.for_ranges(pack_.size(), packs_a_task, [&](std::size_t begin, std::size_t end) {
    for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p) {
      for (std::uint32_t slot = p * lanes; slot < (p + 1) * lanes; ++slot) {
        if (row_of_slot_[slot] == no_row) continue;
        const Vector3d& normal = rows.row[row_of_slot_[slot]].normal;
        given_[slot] = {{0, 0, 0}, 0, {normal.x, normal.y, normal.z}, 0};
        if (pack_[p].kind == general) fill_general(rows, slot);
      }
      if (pack_[p].kind == normal_only) fill_pack(normal_packs_, rows, p);
      if (pack_[p].kind == with_friction) fill_pack(friction_packs_, rows, p);
      store_given(rows, p);
    }
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
