#pragma once
/// What output costs, measured: a few dumps into a folder for temporary files, which is removed.

#include "src/deck/deck.hpp"
#include "src/model/model.hpp"
#include "src/output/snapshot.hpp"

namespace brio {

struct OutputCost {
  double dumps = 0, rows = 0;   ///< that the deck asks for
  double first_dump_bytes = 0;  ///< with all that is written once
  double dump_bytes = 0;        ///< of each that follows
  double topology_bytes = 0;    ///< more, where elements have been deleted since the dump before
  double row_bytes = 0;         ///< in both files
  double dump_seconds = 0, row_seconds = 0;

  /// \param with_topology dumps after the first that bring a new topology
  double bytes(double with_topology) const;
  double seconds() const { return dumps * dump_seconds + rows * row_seconds; }
};

/// Bytes of the fields of a dump, and of its topology.
double field_bytes(const Snapshot& snapshot);
double topology_bytes(const Snapshot& snapshot);

/// Fields are looked at as the model is. \throws FileError where the folder for temporary files refuses
OutputCost measure_output(const Deck& deck, Model& model, double steps);

}  // namespace brio
