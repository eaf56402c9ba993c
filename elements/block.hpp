#pragma once
/// A block: elements of one kind and one material, state packed lane by lane.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elements/base/element_sample.hpp"
#include "elements/base/motion.hpp"
#include "elements/deletion.hpp"
#include "elements/kinds.hpp"
#include "elements/particle/particle_cloud.hpp"
#include "materials/material.hpp"
#include "src/base/aligned.hpp"
#include "src/base/index.hpp"
#include "src/base/nodes.hpp"

namespace brio {

inline int nodes_per_element(const Element& element) {
  return std::visit([](const auto& kind) { return kind.nodes; }, element);
}
inline bool has_rotations(const Element& element) {
  return std::visit([](const auto& kind) { return kind.rotations; }, element);
}
inline const ElementTraits& traits_of(const Element& element) {
  return std::visit([](const auto& kind) -> const ElementTraits& { return kind.traits; }, element);
}
inline std::string_view name_of(const Element& element) {
  return std::visit([](const auto& kind) { return kind.name; }, element);
}
inline std::string_view name_of(const Material& material) {
  return std::visit([](const auto& law) { return law.name; }, material);
}

/// Packs [first, last) of a block: the piece of work that one thread does at a time. Its elements fill the
/// first of these packs; what deletion has emptied stands behind them.
struct Chunk {
  std::size_t first_pack, last_pack;
  std::size_t element_count;
};

/// Sums over a chunk since the last step, and what bounds the next one.
struct SweepResult {
  double internal_energy = 0;
  double hourglass_energy = 0;
  double viscous_energy = 0;
  double stable_step = 0;            ///< smallest over the chunk; not positive: an element has broken down
  std::size_t critical_element = 0;  ///< index within the block of the element that sets it
  double strain_rate_squared = 0;    ///< largest
  double damping = 0;      ///< largest that it adds to the square of a frequency (nodal_stiffness.hpp)
  std::size_t lost = 0;    ///< elements to be deleted, listed in Block::lost
  CountByCause lost_by{};  ///< of these, by DeletionCause
  std::size_t scaled = 0;  ///< elements that got mass, listed in Block::scaled
};

struct Block;
/// The code of one (element, material, precision), chosen once when the block is made.
struct BlockKernel {
  /// Stress update and internal forces of one chunk, subtracted from nodes.force (and nodes.moment), and as
  /// their fourth components the stiffness of nodes.
  SweepResult (*sweep)(Block&, Chunk, Nodes&, double step);
  /// Reference state and lumped masses, added to nodes.mass (and nodes.rotational_inertia).
  /// Throws std::invalid_argument naming the element where the geometry is not valid.
  void (*initialize)(Block&, Nodes&);
  /// \param in_full with what fields beyond the default ask for
  ElementSample (*sample)(const Block&, const Nodes&, std::size_t element, bool in_full);
  double (*mass)(const Block&, std::size_t element);
  /// Rotational inertia of a node over its mass, of the element's share of both; 0 where nodes do not turn.
  double (*gyration)(const Block&, std::size_t element);
  /// Second part of the sweep, when all first parts are done: forces between elements, added to nodes.force
  /// of a chunk's own nodes. Null for elements that act on their own nodes alone.
  /// \returns work since the last step that no first part has accounted for.
  double (*exchange)(Block&, Chunk, Nodes&, double step);
  /// The sweep adds to the stiffness of nodes (src/sweep/assembled_step.hpp).
  bool gives_stiffness;
  /// Subtracts the products of the elastic stiffness of a chunk's elements and displacements of nodes; null
  /// where there is none (elements/stiffness_product.hpp).
  void (*multiply_stiffness)(Block&, Chunk, const Nodes&, const NodalRows& displacement,
                             const NodalRows& product);
};

struct Block {
  std::string part;
  Element element;
  Material material;
  Precision precision = Precision::double_precision;
  BlockKernel kernel{};

  std::size_t element_count = 0;  ///< that live
  int lanes = 0;                  ///< elements to a pack
  std::size_t pack_count = 0;
  std::size_t pack_bytes = 0;
  AlignedBuffer<int> connectivity;     ///< [pack][node][lane]; padding lanes repeat the last element
  AlignedBuffer<std::byte> state;      ///< [pack][component][lane]
  std::optional<ParticleCloud> cloud;  ///< of particles

  Deletion deletion;
  /// Whether an element can be deleted at all: by failure of the material or by what `deletion` names. The
  /// two arrays are empty where not.
  bool loses_elements = false;
  AlignedBuffer<double> held;  ///< energy received: [pack][internal, hourglass][lane]
  AlignedBuffer<int> lost;     ///< by chunk from its first place on: places that the last sweep gave up

  /// Stable step up to which elements get mass; 0: none gets any, and the two arrays are empty.
  double scaled_step = 0;
  AlignedBuffer<int> scaled;  ///< by chunk from its first place on: places that the last sweep gave mass
  AlignedBuffer<double> mass_gain;  ///< [place]: mass that the last sweep gave the listed

  int node(std::size_t e, int corner) const {
    const auto width = index(lanes);
    const auto corners = index(nodes_per_element(element));
    return connectivity[((e / width) * corners + index(corner)) * width + e % width];
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(element_count, pack_count, connectivity, state, cloud, held);
  }
};

/// True where the law has the update that the element needs.
bool accepts(const Element& element, const Material& material);

/// A block with its state allocated and zero; call kernel.initialize next.
/// \param connectivity nodes of each element, one after the other; ordered for locality by the caller.
/// \throws std::invalid_argument if the law does not fit the element.
Block make_block(std::string part, const Element& element, const Material& material, Precision precision,
                 std::span<const int> connectivity, const std::optional<Deletion>& deletion = {});

/// From now on elements of the block get mass where their stable step is below this.
/// \pre traits_of(block.element).gains_mass
void scale_to(double stable_step, Block& block);

/// Energy that an element has received. \pre block.loses_elements
struct HeldEnergy {
  double internal, hourglass;
};
HeldEnergy held_energy(const Block& block, std::size_t element);

/// Everything that is kept of an element, to another place.
void copy_element(Block& block, std::size_t from, std::size_t to);

}  // namespace brio
