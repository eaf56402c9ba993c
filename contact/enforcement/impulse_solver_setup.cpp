#include <algorithm>
#include <cmath>

#include "contact/enforcement/impulse_solver.hpp"

namespace brio {

using Vector = Vector3<double>;

namespace {

/// Rows and blocks of a task: whatever the number of threads.
constexpr std::size_t rows_a_task = 512;
constexpr std::size_t blocks_a_task = 1024;
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
bool is_isotropic(const SymmetricTensor<double>& a) {
  return a.xx == a.yy && a.yy == a.zz && a.xy == 0 && a.yz == 0 && a.xz == 0;
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

/// c of each kind of entry, times the scale of the row: |W^(1/2) B^T|, of the normal alone where there is no
/// friction. `root` is as in block_root_.
double entry_norm(const ConstraintRow& row, const TranslationEntry& entry, const VelocityBlock& block,
                  double root) {
  const double weight = std::abs(entry.weight);
  if (row.friction_coefficient == 0)
    return weight * (root >= 0 ? root : std::sqrt(energy(block.inverse_mass, row.normal)));
  const double tilt = entry.tilt[0] * entry.tilt[0] + entry.tilt[1] * entry.tilt[1];
  const double map = tilt == 0 ? weight : 0.5 * (std::sqrt(tilt) + std::sqrt(tilt + 4 * weight * weight));
  return map * std::abs(root);
}
double entry_norm(const ConstraintRow& row, const RotationEntry& entry, const VelocityBlock& block,
                  double root) {
  if (row.friction_coefficient == 0)
    return std::sqrt(energy(block.inverse_mass, cross(entry.arm, row.normal)));
  return std::sqrt(dot(entry.arm, entry.arm)) * std::abs(root);
}
double entry_norm(const ConstraintRow& row, const MatrixEntry& entry, const VelocityBlock& block,
                  double root) {
  if (row.friction_coefficient == 0)
    return std::sqrt(energy(block.inverse_mass, transposed_times(entry.matrix, row.normal)));
  return std::sqrt(frobenius_squared(entry.matrix)) * std::abs(root);
}

bool is_held(const ConstraintRows& rows, const ConstraintRow& row, std::span<const VelocityBlock> blocks) {
  const RowMap map(rows, row);
  double lightest = 0;
  for (const TranslationEntry& entry : map.translations())
    lightest = std::max(lightest, energy(blocks[index(entry.block)].inverse_mass, row.normal));
  return !(map.inverse_mass(row.normal, blocks) > held_share * lightest);
}

}  // namespace

void ImpulseSolver::measure_blocks(std::span<const VelocityBlock> blocks, ThreadTeam& team) {
  block_root_.resize(blocks.size());
  block_norm_.resize(blocks.size());
  team.for_ranges(blocks.size(), blocks_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const double root = std::sqrt(norm_bound(blocks[b].inverse_mass));
      block_root_[b] = is_isotropic(blocks[b].inverse_mass) ? root : -root;
    }
  });
}

// c of all entries and the scale of rows; which kind a row is of.
void ImpulseSolver::measure_rows(const ConstraintRows& rows, std::span<const VelocityBlock> blocks,
                                 ThreadTeam& team) {
  const std::size_t rotations = rows.translation.size();
  const std::size_t matrices = rotations + rows.rotation.size();
  norm_.resize(matrices + rows.matrix.size());
  kind_.resize(rows.size());
  scale_.resize(rows.size());
  const auto measure = [&](std::size_t i) {
    const ConstraintRow& row = rows.row[i];
    double sum = 0;
    double along_normal = 0;
    double lightest = 0;
    bool tilted = false;
    bool plain = row.rotation.size() + row.matrix.size() == 0;
    const auto add = [&](const auto& entry, double& norm) {
      norm = entry_norm(row, entry, blocks[index(entry.block)], block_root_[index(entry.block)]);
      sum += norm * norm;
    };
    for (std::uint32_t e = row.translation.begin; e < row.translation.end; ++e) {
      const TranslationEntry& entry = rows.translation[e];
      const double root = block_root_[index(entry.block)];
      add(entry, norm_[e]);
      along_normal += square(entry.weight * root);
      lightest = std::max(lightest, square(root));
      plain = plain && root >= 0;
      tilted = tilted || entry.tilt[0] != 0 || entry.tilt[1] != 0;
    }
    for (std::uint32_t e = row.rotation.begin; e < row.rotation.end; ++e)
      add(rows.rotation[e], norm_[rotations + e]);
    for (std::uint32_t e = row.matrix.begin; e < row.matrix.end; ++e)
      add(rows.matrix[e], norm_[matrices + e]);
    const bool held = plain ? !(along_normal > held_share * lightest) : is_held(rows, row, blocks);
    scale_[i] = held ? 0 : std::sqrt(sum);
    const double inverse = held ? 0 : 1 / scale_[i];
    for (std::uint32_t e = row.translation.begin; e < row.translation.end; ++e) norm_[e] *= inverse;
    for (std::uint32_t e = row.rotation.begin; e < row.rotation.end; ++e) norm_[rotations + e] *= inverse;
    for (std::uint32_t e = row.matrix.begin; e < row.matrix.end; ++e) norm_[matrices + e] *= inverse;
    const bool packed = row.rotation.size() + row.matrix.size() == 0 &&
                        row.translation.size() <= RowPack<false, false>::entries;
    kind_[i] = !packed                         ? general
               : row.friction_coefficient == 0 ? normal_only
               : tilted                        ? with_tilt
                                               : with_friction;
  };
  const auto join_blocks = [&](const ConstraintRow& row) {
    std::uint32_t first = no_row;
    const auto join = [&](int block) {
      if (block_root_[index(block)] == 0) return;
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
  row_of_slot_.clear();
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
      const std::uint32_t island = block_root_[b] == 0 ? IslandFinder::none : finder_.number_if_any(block);
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
    pack.block[k][lane] = row.translation.size() > 0 ? pack.block[0][lane] : 0;
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
  start(pack.unknown, row, scale_[i] * scale_[i] * majorant,
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
  start(general_[place_[slot_[i]]], row, scale_[i] * scale_[i] * majorant,
        [](double& to, double value) { to = value; });
}

void ImpulseSolver::fill_rows(const ConstraintRows& rows, ThreadTeam& team) {
  constexpr std::size_t lanes = lane_count<double>;
  normal_packs_.resize(slots_of_kind_[normal_only] / lanes);
  friction_packs_.resize(slots_of_kind_[with_friction] / lanes);
  tilt_packs_.resize(slots_of_kind_[with_tilt] / lanes);
  general_.resize(slots_of_kind_[general]);
  given_.resize(row_of_slot_.size());
  // Packs with lanes that stay empty are those at the end of a kind and island.
  const auto clear = [&](Kind kind, std::size_t place) {
    if (kind == normal_only) normal_packs_[place / lanes] = {};
    if (kind == with_friction) friction_packs_[place / lanes] = {};
    if (kind == with_tilt) tilt_packs_[place / lanes] = {};
  };
  team.for_each(piece_.size(), [&](std::size_t p) {
    const Piece& piece = piece_[p];
    if (row_of_slot_[piece.end - 1] == no_row) clear(piece.kind, place_[piece.end - 1]);
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
