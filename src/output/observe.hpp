#pragma once
/// Output of a model: fields, history rows, end state.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/base/index.hpp"
#include "src/base/parallel.hpp"
#include "src/fields/cell_variables.hpp"
#include "src/fields/contact_fields.hpp"
#include "src/fields/rotation.hpp"
#include "src/model/model.hpp"
#include "src/output/history.hpp"
#include "src/output/snapshot.hpp"
#include "src/output/summary.hpp"

namespace brio {

/// Fills snapshots. Points and cells stand in the order of the parts and of their meshes, whatever the order
/// in memory.
class FieldObserver {
 public:
  /// Stores the present positions as the reference of displacements.
  /// \param variables fields of cells beside part and element number, of `output.fields.variables`; empty:
  /// the default
  explicit FieldObserver(const Model& model, std::span<const std::string> variables = {});
  FieldObserver(const FieldObserver&) = delete;  // what fills its fields refers to it
  FieldObserver& operator=(const FieldObserver&) = delete;

  /// Fields at the time of the step; call between update_velocities and update_positions. \param time in the
  /// step that begins: positions are those of that time, along which nodes move evenly. With `state` it is
  /// that of the step, from which other runs can start.
  const Snapshot& observe(const Model& model, double time, ThreadTeam& team);
  const Snapshot& observe(const Model& model, double time) {
    ThreadTeam alone;
    return observe(model, time, alone);
  }
  const Snapshot& observe(const Model& model) { return observe(model, model.times.time); }
  /// From now on another snapshot is filled, and the last one stays as it is until the next turn. The second
  /// is allocated by the first turn. \pre one has been observed
  void turn();

  /// Saved and restored (src/base/state_archive.hpp): which topology the last snapshot had.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(topology_version_, deleted_);
  }
  /// After a restored model and observer: cells as they are.
  void follow(const Model& model);

 private:
  static constexpr std::size_t none = index(-1);

  /// What fills a field of cells.
  struct CellSource {
    enum class Kind { part, element, variable, strain, strain_rate, history, state };
    Kind kind;
    const CellVariable* variable = nullptr;
  };
  /// What fills points [begin, end) of a field, whose values are given.
  using PointValues = std::function<void(const Model&, std::size_t begin, std::size_t end, double* values)>;

  /// Of which part, the place among its elements, and which of all cells.
  struct Cell {
    std::size_t part, place;
    std::int64_t element;  ///< its number in the mesh
    std::size_t number;
  };
  /// Elements of a part that one task fills, and the first cell of them.
  struct ElementRange {
    std::size_t part, begin, end, first_cell;
  };

  void fill_cell(const Model& model, const CellSource& source, const ElementSample& sample, const Cell& at,
                 FieldArray& field) const;
  void add_point_fields(const Model& model, std::span<const std::string> variables);
  /// \param value (model, point, its values)
  template <class Value>
  void add_point_field(FieldArray field, Value value);
  void add_point_variable(const PointVariable& variable);
  void note_thickness(const Model& model);
  std::span<const std::int64_t> strained_corners(const Model& model, const Cell& at) const;
  SymmetricTensor<double> strain_of(const Model& model, const ElementSample& sample, const Cell& at) const;
  SymmetricTensor<double> strain_rate_of(const Model& model, const Cell& at) const;
  void add_cell_fields(const Model& model, std::span<const std::string> variables);
  void add_cell_field(std::string_view name, CellSource source);
  void add_state(const Model& model);
  void note_parts(const Model& model);
  void take_topology(const Model& model);
  void take_positions(const Model& model, std::size_t begin, std::size_t end, double after);
  void number_points(const Model& model);
  void fill_points(const Model& model, std::size_t begin, std::size_t end);
  void fill_cells(const Model& model, const ElementRange& range);
  void fill_state(const Model& model, const PartInModel& part, std::size_t element, std::size_t cell);

  std::unique_ptr<Snapshot> snapshot_ = std::make_unique<Snapshot>();  ///< that is filled
  std::unique_ptr<Snapshot> other_;                                    ///< null until the first turn
  std::vector<int> node_of_point_;
  std::vector<std::int64_t> point_of_node_;
  int topology_version_ = 0;
  std::int64_t deleted_ = 0;               ///< elements, in the topology of that version
  std::vector<ElementRange> range_;        ///< of all elements
  bool is_topology_new_ = true;            ///< what it fixes is not filled yet
  std::vector<CellSource> cell_source_;    ///< of each cell field
  std::vector<PointValues> point_values_;  ///< of each point field
  std::vector<double> reference_;
  std::vector<double> point_number_;            ///< of each point, with mesh files
  std::vector<std::vector<double>> thickness_;  ///< at the start, by part and element, for strains of shells
  bool in_full_ = false;            ///< whether a field asks for more of elements than the default
  std::size_t state_field_ = none;  ///< among those of cells
};

/// Names of the history's columns: time, step, energies, momenta, and the mean velocity of every part (of the
/// first hundred parts).
std::vector<std::string> history_columns(const Model& model);

/// Working space of a row: sums over ranges of nodes and, for mean velocities, over ranges of the nodes of a
/// part.
struct HistorySums {
  struct PartRange {
    std::size_t part, begin, end;  ///< of its nodes
    Row4 momentum{};
    double mass = 0;
  };
  std::vector<Momentum> of_nodes;
  std::vector<PartRange> of_parts;
};

/// One row, into `row`; updates the momentum balance.
void observe_history(Model& model, HistorySums& sums, std::vector<double>& row, ThreadTeam& team);
inline void observe_history(Model& model, std::vector<double>& row) {
  HistorySums sums;
  ThreadTeam alone;
  observe_history(model, sums, row, alone);
}

/// End state in figures; the caller adds version, deck, status, wall time, memory and threads.
Summary observe_end(Model& model);

/// What the scene switched on: kinds of elements, laws, loads, contact, ...
std::vector<std::string> active_features(const Model& model);

}  // namespace brio
