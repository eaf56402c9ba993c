#pragma once
/// Constraint rows of a step with their unknowns, which are numbered as rows name them. Rows are built in
/// pieces by threads, and stand in the order of contacts.

#include <cstdint>
#include <span>
#include <vector>

#include "contact/enforcement/constraint_row.hpp"
#include "contact/enforcement/impulse_work.hpp"
#include "contact/enforcement/row_builder.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// Allocates nothing once as many rows have been seen.
struct ContactRows {
  ConstraintRows rows;  ///< one per contact
  RowCounts end;        ///< of the rows since `clear`; arrays are cut to them as rows are added
  std::vector<VelocityBlock> block;
  std::vector<BlockOwner> owner;  ///< of each block
  std::vector<Vector3d> before;   ///< velocities at the half step before
  std::vector<BlockPlace> place;  ///< of each block
  std::vector<int> unknown;       ///< of each block
  std::vector<int> block_of;      ///< of each unknown; -1: no row names it
  std::vector<SymmetricTensor<double>> body_inertia;
  std::vector<RowWork> work;           ///< working space
  std::vector<std::uint8_t> taken;     ///< working space
  std::vector<RowPiece> piece;         ///< working space, one a task
  std::vector<RowCounts> piece_begin;  ///< working space: where it begins among all rows

  /// Clear rows and blocks.
  void clear();
};

/// Append one row per contact, with the impulses of the contact.
void add_rows(ContactRows& rows, const RowSources& sources, std::span<const Contact> contacts,
              ThreadTeam& team);

/// Append one row per contact with a wall.
void add_rows(ContactRows& rows, const RowSources& sources, std::span<const ContactWall> walls,
              std::span<const NodeAtWall> touches, ThreadTeam& team);

}  // namespace brio
