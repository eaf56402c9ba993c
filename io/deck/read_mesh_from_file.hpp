#pragma once
/// A block of a mesh file, as a deck asks for it.

#include "io/deck/read_fields.hpp"

namespace brio {

/// Reads the entry, and the mesh. \throws DeckError for what is wrong with either
void read_mesh_from_file(const YamlNode& node, const Slot& slot, MeshFromFile& source);

}  // namespace brio
