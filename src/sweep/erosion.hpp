#pragma once
/// Erosion: deletion of elements from their packs, transfer of their energy from internal and hourglass
/// energy to deleted energy, and treatment of their nodes. Exists only where elements can be deleted.
///
/// A deleted element is replaced by the last element of its chunk, so that the chunks of a colour still share
/// no node, and no deleted element is swept. When a quarter of the lanes is padding, all blocks are repacked.
/// Work is proportional to the number of deleted elements.

#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "elements/block.hpp"
#include "src/domains/schedule.hpp"
#include "src/motion/energy_balance.hpp"
#include "src/motion/loads.hpp"

namespace brio {

/// Maps of the nodes and elements of a part to those of the model.
struct PartInModel {
  std::string name;
  std::size_t block = 0;
  std::vector<int> node;           ///< node of the part's mesh -> node of the model
  std::vector<int> element_order;  ///< place in the block -> element of the part's mesh; -1: empty
  std::vector<int> element_slot;   ///< element of the part's mesh -> place in the block; -1: deleted
  int rigid = -1;                  ///< the rigid body that it is; its block is empty
  double mass = 0;                 ///< at the start
  std::vector<std::int64_t> node_id, element_id;  ///< in its mesh file; empty: the mesh is generated

  /// Numbers of the first node and element of a generated mesh, so that none is that of another part.
  std::int64_t first_node = 0, first_element = 0;

  /// Numbers that users know: of the mesh file, or in the order of the part's mesh.
  std::int64_t number_of_node(std::size_t of_mesh) const {
    return node_id.empty() ? first_node + static_cast<std::int64_t>(of_mesh) : node_id[of_mesh];
  }
  std::int64_t number_of_element(std::size_t of_mesh) const {
    return element_id.empty() ? first_element + static_cast<std::int64_t>(of_mesh) : element_id[of_mesh];
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(element_order, element_slot);
  }
};

struct DeletedElement {
  int part;
  int element;  ///< of the part's mesh

  friend auto operator<=>(const DeletedElement&, const DeletedElement&) = default;
};

struct Erosion {
  std::vector<DeletedElement> deleted;  ///< in the present step, ascending
  std::vector<int> freed;               ///< nodes that lost their last element in the present step, ascending

  std::vector<int> elements_of_node;        ///< not deleted
  std::vector<std::int64_t> deleted_count;  ///< of each part, so far
  CountByCause deleted_by_cause{};          ///< by DeletionCause, so far
  double mass_of_deleted = 0;               ///< of deleted elements so far; it stays on their nodes
  std::vector<int> dropping;                ///< nodes to be removed before the next step, ascending
  double dropped_mass = 0;

  std::int64_t total_deleted() const;

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(deleted, freed, elements_of_node, deleted_count, deleted_by_cause, mass_of_deleted, dropping,
            dropped_mass);
  }
};

/// True if an element of any block can be deleted.
bool can_erode(std::span<const Block> blocks);

/// \param parts by block: part p is block p
Erosion make_erosion(std::span<const Block> blocks, std::size_t node_count);

/// Deletes the elements listed by the last sweep; fills `deleted` and `freed`. \return their energies, moved
/// to those of deleted elements
Contribution erode(Erosion& erosion, SweepSchedule& schedule, std::span<const SweepResult> results,
                   std::span<Block> blocks, std::span<PartInModel> parts);

/// True when chunks are so short that repacking pays.
bool is_sparse(const SweepSchedule& schedule, std::span<const Block> blocks);

/// Repacks the elements of every piece of a domain in their present order, with new chunks and colours.
void repack(SweepSchedule& schedule, std::span<Block> blocks, std::span<PartInModel> parts,
            std::size_t node_count);

/// Removes the sides of deleted elements from a load. \param deleted ascending
void remove_sides(ActiveLoad& load, std::span<const DeletedElement> deleted);

/// Removes nodes from a load. \param dropping ascending
void remove_nodes(ActiveLoad& load, std::span<const int> dropping);

/// Removes the nodes listed in `dropping`. \return their kinetic energy and momentum
Contribution remove_nodes(Erosion& erosion, Nodes& nodes);

/// Mass of nodes with elements, and of free point masses.
struct MassBalance {
  double intact = 0, debris = 0;
};
MassBalance mass_balance(const Erosion& erosion, const Nodes& nodes);

}  // namespace brio
