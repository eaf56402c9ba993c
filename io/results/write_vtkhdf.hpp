#pragma once
/// The transient unstructured grid of VTKHDF 2.0
/// (https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html), appended to dump by dump. Offsets
/// let a later step refer to what an earlier one wrote: a topology is written once, as one "part", and fields
/// that cannot change without it are not repeated either.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "src/base/cell_type.hpp"
#include "src/output/snapshot.hpp"

namespace brio {

class Hdf5File;

/// Where the rows of one array of one dump lie.
struct StoredArray {
  std::string name;
  std::string dataset;  ///< path inside the file
  Storage storage = Storage::single_precision;
  std::int64_t components = 1;
  std::int64_t first_row = 0;
  std::int64_t rows = 0;
  std::int64_t rows_in_file = 0;  ///< of the dataset, as of this dump

  template <class Archive>
  void serialize(Archive& archive) {
    archive(name, dataset, storage, components, first_row, rows, rows_in_file);
  }
};

/// Cells that are shown under a name of their own.
struct StoredPart {
  SnapshotPart range{};            ///< within the arrays of the dump
  std::optional<CellType> type{};  ///< of all its cells; none: `connectivity` is XDMF's list of mixed cells
  StoredArray connectivity{};      ///< points of its cells, counted from the first of the dump
};

/// All that a description of the dump in another language needs.
struct StoredDump {
  double time = 0;
  std::vector<StoredPart> parts;  ///< the same ones in every dump, also without cells
  StoredArray coordinates;
  std::vector<StoredArray> point_fields, cell_fields, global_fields;
};

/// Whether a scene is described part by part: its description grows with parts times dumps. Where it is not,
/// the file has the list of mixed cells, `/xdmf/MixedTopology`, for a description of the scene as a whole.
bool is_shown_by_parts(const Snapshot& snapshot);

class VtkhdfWriter {
 public:
  /// \param compression gzip level (after shuffling) of points and fields, 0 for none: files become about a
  /// fifth smaller and ten times slower to write.
  explicit VtkhdfWriter(int compression = 0) : compression_(compression) {}

  /// Append a dump to a file; the first one makes the groups. Data and offsets are committed before the
  /// number of steps, and that before the list of times: a reader never sees a step that is not complete. A
  /// scene without cells is shown as a single vertex on the first point, because readers fail on a step
  /// without cells; at least one point is required. \throws FileError; the writer is then as it was before
  /// the call.
  StoredDump append(Hdf5File& file, const Snapshot& snapshot);

  /// Saved and restored (src/base/state_archive.hpp): what the next dump builds upon.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(progress_);
  }
  std::int64_t dumps() const { return progress_.steps; }

 private:
  /// What the next dump builds upon.
  struct Progress {
    std::int64_t steps = 0;
    std::int64_t parts = 0;
    int topology_version = 0;
    std::int64_t points = 0, cells = 0;  ///< of the current part
    std::int64_t cell_row = 0, connectivity_row = 0;
    StoredArray mixed_topology;
    std::vector<std::int64_t> fixed_point_row, fixed_cell_row;

    template <class Archive>
    void serialize(Archive& archive) {
      archive(steps, parts, topology_version, points, cells, cell_row, connectivity_row, mixed_topology,
              fixed_point_row, fixed_cell_row);
    }
  };

  void create_layout(Hdf5File& file, const Snapshot& snapshot, const Topology& topology) const;
  static void create_fields(Hdf5File& file, const std::string& group, const std::vector<FieldArray>& fields,
                            std::int64_t rows, int compression);
  void append_topology(Hdf5File& file, const Topology& topology, std::int64_t points, bool by_parts,
                       Progress& next);
  void append_fields(Hdf5File& file, const std::string& group, const std::vector<FieldArray>& fields,
                     std::int64_t rows, bool new_topology, std::vector<std::int64_t>& fixed_row,
                     std::vector<StoredArray>& stored);
  void append_global_fields(Hdf5File& file, const std::vector<FieldArray>& fields,
                            std::vector<StoredArray>& stored);
  std::int64_t append_values(Hdf5File& file, const std::string& table, const FieldArray& field,
                             std::int64_t rows);

  int compression_;
  Progress progress_;
  std::vector<float> single_;  // one field on its way to the file
  std::vector<std::int64_t> integers_;
};

}  // namespace brio
