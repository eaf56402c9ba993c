// Iterations of islands: of all rows, and of those that still change alone.

#include <algorithm>
#include <cmath>

#include "contact/enforcement/impulse_solver.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Islands of more rows are worked on by the whole team.
constexpr std::size_t most_rows_of_small = 4096;

/// Rows are solved alone once they are at most this share of their island, ...
constexpr double most_unconverged = 0.25;
/// ... which has at least as many rows.
constexpr std::uint32_t least_rows = 64;
/// Rows that change by less than this fraction of the tolerance are fixed.
constexpr double held_below = 0.05;
/// What is tolerated of rows that are solved alone, over what is tolerated of all, ...
constexpr double tolerated_alone = 0.5;
/// ... and their iterations at most.
constexpr int most_iterations_alone = 100;

double element(double value, int) { return value; }
double element(const Lanes<double>& value, int lane) { return value[lane]; }
void set_element(double& to, int, double value) { to = value; }
void set_element(Lanes<double>& to, int lane, double value) { to.set(lane, value); }

}  // namespace

template <class Visit>
void ImpulseSolver::at_slot(std::uint32_t slot, Visit&& visit) {
  const Pack& pack = pack_[slot / lanes];
  const auto lane = static_cast<int>(slot % lanes);
  if (pack.kind == with_friction) visit(friction_packs_[pack.place].unknown, lane);
  if (pack.kind == normal_only) visit(normal_packs_[pack.place].unknown, lane);
  if (pack.kind == general) visit(general_[pack.place * lanes + slot % lanes], lane);
}

// Velocities without impulses, of blocks that are new.
void ImpulseSolver::add_free(std::span<const VelocityBlock> blocks) {
  for (std::size_t b = free_.size(); b < blocks.size(); ++b)
    free_.push_back({{blocks[b].velocity.x, blocks[b].velocity.y, blocks[b].velocity.z, 0}});
}

// Change of a relative velocity.
double ImpulseSolver::tolerated(const SolveOptions& options, std::size_t n) const {
  return island_[n].tolerated >= 0 ? island_[n].tolerated : options.tolerance * report_[n].largest_velocity;
}

bool ImpulseSolver::goes_on(const SolveOptions& options, std::size_t n) const {
  return !report_[n].converged && report_[n].row_iterations < island_[n].rows * index(options.max_iterations);
}

// Until it has converged, or few rows still change.
// \param team of a large island; null: one thread alone.
void ImpulseSolver::iterate(const SolveOptions& options, const ConstraintRows& rows,
                            std::span<const VelocityBlock> blocks, std::size_t n, ThreadTeam* team) {
  Island& island = island_[n];
  SolveReport& report = report_[n];
  if (island.rows == 0 || (!goes_on(options, n) && !island.has_new)) return;
  island.has_new = false;
  gather(rows, blocks, island, 0, team);
  Step step;
  double theta = 1;
  const bool is_alone = island.tolerated >= 0;
  const double few = is_alone || island.rows < least_rows ? -1 : most_unconverged * island.rows;
  double counted = 0;
  do {
    step.counted = square(held_below * tolerated(options, n));
    const Sums sums = change_impulses(rows, island, step, team);
    report.row_iterations += island.rows;
    report.residual = sums.residual;
    report.largest_velocity = sums.largest;
    report.converged = sums.residual <= tolerated(options, n);
    counted = sums.counted;
    const bool restart = sums.turned > 0;
    report.restarts += restart;
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * theta * theta));
    step.momentum = restart ? 0 : (theta - 1) / next;
    theta = restart ? 1 : next;
    gather(rows, blocks, island, step.momentum, team);
  } while (goes_on(options, n) && counted > few);
}

void ImpulseSolver::iterate_islands(const SolveOptions& options, const ConstraintRows& rows,
                                    std::span<const VelocityBlock> blocks, ThreadTeam& team) {
  // Small islands in groups of about as many rows: where each begins.
  small_.clear();
  std::size_t gathered = rows_a_task;
  for (std::size_t n = 0; n < island_.size(); ++n) {
    if (island_[n].rows == 0 || island_[n].rows > most_rows_of_small) continue;
    if (gathered >= rows_a_task) {
      small_.push_back(static_cast<std::uint32_t>(n));
      gathered = 0;
    }
    gathered += island_[n].rows;
  }
  team.for_each(small_.size(), [&](std::size_t group) {
    const std::size_t end = group + 1 < small_.size() ? small_[group + 1] : island_.size();
    for (std::size_t n = small_[group]; n < end; ++n)
      if (island_[n].rows <= most_rows_of_small) iterate(options, rows, blocks, n, nullptr);
  });
  for (std::size_t n = 0; n < island_.size(); ++n)
    if (island_[n].rows > most_rows_of_small) iterate(options, rows, blocks, n, &team);
}

void ImpulseSolver::begin(const ConstraintRows& rows, std::span<const VelocityBlock> blocks,
                          ThreadTeam& team) {
  now_ = extrapolated_ = free_;
  prepare(rows, blocks, team);
  report_.assign(island_.size(), {.converged = false});
}

SolveReport ImpulseSolver::solve(const SolveOptions& options, ConstraintRows& rows,
                                 std::span<VelocityBlock> blocks, ThreadTeam& team) {
  free_.clear();
  return solve_further(options, rows, blocks, team);
}

SolveReport ImpulseSolver::solve_further(const SolveOptions& options, ConstraintRows& rows,
                                         std::span<VelocityBlock> blocks, ThreadTeam& team) {
  add_free(blocks);
  SolveReport total;
  if (rows.size() == 0) return total;
  begin(rows, blocks, team);
  do {
    iterate_islands(options, rows, blocks, team);
  } while (solve_unconverged(options, rows, blocks, team));
  team.for_each(island_.size(), [&](std::size_t n) { take_excess(rows, island_[n]); });
  for (std::size_t n = 0; n < island_.size(); ++n) {
    const Island& island = island_[n];
    if (island.rows == 0) continue;
    const SolveReport& own = report_[n];
    total.iterations =
        std::max(total.iterations, static_cast<int>((own.row_iterations + island.rows - 1) / island.rows));
    total.restarts += own.restarts;
    total.residual = std::max(total.residual, own.residual);
    total.largest_velocity = std::max(total.largest_velocity, own.largest_velocity);
    total.converged = total.converged && own.converged;
    ++total.islands;
    total.row_iterations += own.row_iterations;
  }
  store(rows, blocks, team);
  return total;
}

// As islands of their own; no work is taken off them.
// \param tolerated change of the relative velocity of each row.
void ImpulseSolver::solve_alone(const SolveOptions& options, ConstraintRows& rows,
                                std::span<VelocityBlock> blocks, std::span<const double> tolerated,
                                ThreadTeam& team) {
  free_.clear();
  add_free(blocks);
  begin(rows, blocks, team);
  for (Island& island : island_)
    if (island.rows > 0) island.tolerated = tolerated[row_of_slot_[island.pack_begin * lanes]];
  iterate_islands(options, rows, blocks, team);
  store(rows, blocks, team);
}

// \returns whether there were any.
bool ImpulseSolver::solve_unconverged(const SolveOptions& options, const ConstraintRows& rows,
                                      std::span<const VelocityBlock> blocks, ThreadTeam& team) {
  const auto any = [&] {
    for (std::size_t n = 0; n < island_.size(); ++n)
      if (island_[n].rows > 0 && goes_on(options, n)) return true;
    return false;
  };
  if (!any()) return false;
  if (unconverged_.empty()) unconverged_.resize(1);
  Unconverged& unconverged = unconverged_[0];
  select_unconverged(options, rows, blocks, unconverged);
  unconverged.take_impulses_off();
  unconverged.solver.solve_alone({.max_iterations = most_iterations_alone}, unconverged.rows,
                                 unconverged.blocks, unconverged.tolerated, team);
  take_over(rows, unconverged);
  return true;
}

void ImpulseSolver::select_unconverged(const SolveOptions& options, const ConstraintRows& rows,
                                       std::span<const VelocityBlock> blocks, Unconverged& unconverged) {
  unconverged.clear();
  unconverged.number.resize(std::max(unconverged.number.size(), blocks.size()), no_row);
  for (std::size_t n = 0; n < island_.size(); ++n) {
    const Island& island = island_[n];
    if (island.rows == 0 || !goes_on(options, n)) continue;
    const double least = square(held_below * tolerated(options, n));
    for (std::uint32_t slot = island.pack_begin * lanes; slot < island.pack_end * lanes; ++slot) {
      if (row_of_slot_[slot] == no_row) continue;
      at_slot(slot, [&](auto& unknown, int lane) {
        if (!(element(unknown.change, lane) > least)) return;
        double impulse[3] = {0, 0, 0};
        for (int axis = 0; axis < unknown.axes; ++axis) impulse[axis] = element(unknown.impulse[axis], lane);
        unconverged.add(rows, row_of_slot_[slot], impulse, tolerated_alone * tolerated(options, n), blocks,
                        now_);
      });
    }
  }
}

void ImpulseSolver::take_over(const ConstraintRows& rows, const Unconverged& unconverged) {
  for (std::size_t k = 0; k < unconverged.row.size(); ++k) {
    const ConstraintRow& solved = unconverged.rows.row[k];
    const std::uint32_t slot = slot_[unconverged.row[k]];
    const double impulse[3] = {solved.impulse, dot(solved.tangent[0], solved.friction),
                               dot(solved.tangent[1], solved.friction)};
    at_slot(slot, [&](auto& unknown, int lane) {
      for (int axis = 0; axis < unknown.axes; ++axis) {
        set_element(unknown.impulse[axis], lane, impulse[axis]);
        set_element(unknown.last[axis], lane, impulse[axis]);
      }
    });
    store_given(rows, slot / lanes);
  }
  const ImpulseSolver& from = unconverged.solver;
  for (std::size_t n = 0; n < from.island_.size(); ++n) {
    if (from.island_[n].rows == 0) continue;
    const std::uint32_t row = unconverged.row[from.row_of_slot_[from.island_[n].pack_begin * lanes]];
    const std::size_t island = mover_[row] == no_row ? island_.size() - 1 : mover_[row];
    island_[island].has_new = true;
    report_[island].row_iterations += from.report_[n].row_iterations;
    report_[island].restarts += from.report_[n].restarts;
  }
}

void ImpulseSolver::Unconverged::clear() {
  for (const std::uint32_t b : block) number[b] = no_row;
  rows.clear();
  row.clear();
  tolerated.clear();
  blocks.clear();
  block.clear();
}

void ImpulseSolver::Unconverged::add(const ConstraintRows& from, std::uint32_t i, const double (&impulse)[3],
                                     double most_change, std::span<const VelocityBlock> all_blocks,
                                     std::span<const BlockVelocity> velocities) {
  row.push_back(i);
  tolerated.push_back(most_change);
  ConstraintRow copy = from.row[i];
  copy.impulse = impulse[0];
  copy.friction = impulse[1] * copy.tangent[0] + impulse[2] * copy.tangent[1];
  const auto append = [&](auto& to, const auto& entries, EntryRange& range) {
    const EntryRange old = range;
    range.begin = static_cast<std::uint32_t>(to.size());
    for (std::uint32_t e = old.begin; e < old.end; ++e) {
      const auto b = index(entries[e].block);
      if (number[b] == no_row) {
        number[b] = static_cast<std::uint32_t>(blocks.size());
        blocks.push_back(
            {vector_at(velocities[b].component), all_blocks[b].inverse_mass, all_blocks[b].norm});
        block.push_back(static_cast<std::uint32_t>(b));
      }
      to.push_back(entries[e]);
      to.back().block = static_cast<int>(number[b]);
    }
    range.end = static_cast<std::uint32_t>(to.size());
  };
  append(rows.translation, from.translation, copy.translation);
  append(rows.rotation, from.rotation, copy.rotation);
  append(rows.matrix, from.matrix, copy.matrix);
  rows.row.push_back(copy);
}

void ImpulseSolver::Unconverged::take_impulses_off() {
  for (const ConstraintRow& one : rows.row)
    RowMap(rows, one).spread(impulse_of(one), [&](int b, const Vector3d& given) {
      VelocityBlock& to = blocks[index(b)];
      to.velocity = to.velocity - to.inverse_mass * given;
    });
}

}  // namespace brio
