#pragma once
/// Snapshot of the model at one time (a dump of the results): plain arrays that the observer (observe.hpp)
/// fills and a writer reads. The same snapshot is filled again for the next dump, so that its buffers are
/// allocated once.

#include <cstdint>
#include <string>
#include <vector>

#include "src/base/cell_type.hpp"

namespace brio {

/// How the numbers of a field are kept in the file. Stress, velocity and the like lose nothing that a picture
/// or a plot can show in single precision (seven digits) and halve the file; displacements, from which
/// strains may be formed by difference, are kept in double precision, as positions always are.
enum class Storage { single_precision, double_precision, integer };

/// One named array over points, over cells, or over the whole scene.
struct FieldArray {
  std::string name;  ///< snake_case, no '/'
  int components = 1;
  std::vector<double> values;  ///< components of the first point (cell), then of the second, ...
  Storage storage = Storage::single_precision;
  /// True of what cannot change while the topology stays as it is (part, element number): written only with a
  /// new topology. Means nothing for a field of the whole scene.
  bool fixed_by_topology = false;
  bool is_partial = false;  ///< not a number where there is no such thing
};

/// Cells over the points of a snapshot.
struct Topology {
  std::vector<unsigned char> cell_type;    ///< one CellType a cell
  std::vector<std::int64_t> connectivity;  ///< points of the first cell, of the second, ..., in VTK order
  std::vector<std::int64_t> offset;  ///< cells + 1; cell c has connectivity[offset[c]] to [offset[c + 1])
};

/// Cells of one type that stand together, over points that may be those of other parts too.
struct SnapshotPart {
  std::string name;
  std::int64_t first_cell = 0, cells = 0;
  std::int64_t first_point = 0, points = 0;  ///< all that its cells refer to
};

/// The scene at one time. Every dump of one file holds the same fields in the same order.
struct Snapshot {
  double time = 0;
  std::int64_t step = 0;
  std::vector<double> points;  ///< current x y z of every point
  Topology topology;
  int topology_version = 0;         ///< raise it whenever topology or the number of points has changed
  std::vector<SnapshotPart> parts;  ///< the same ones in every dump, also without cells; may be left empty
  std::vector<FieldArray> point_fields;
  std::vector<FieldArray> cell_fields;
  std::vector<FieldArray> global_fields;  ///< `components` values each
};

/// The name of a field with a value that is not finite as it is stored; empty where there is none.
std::string what_results_cannot_hold(const Snapshot& snapshot);

}  // namespace brio
