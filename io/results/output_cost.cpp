#include "io/results/output_cost.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <system_error>

#include "io/results/write_results.hpp"
#include "src/output/observe.hpp"
#include "src/output/output_schedule.hpp"

namespace brio {

namespace {

namespace fs = std::filesystem;

// A folder that is gone when this is.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "brio-output-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw FileError(pattern, std::string("cannot make the folder: ") + std::strerror(errno));
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }
  double bytes() const {
    double sum = 0;
    for (const fs::directory_entry& file : fs::directory_iterator(path_))
      sum += static_cast<double>(file.file_size());
    return sum;
  }

 private:
  fs::path path_;
};

template <class Work>
double seconds_of(const Work& work) {
  const std::clock_t start = std::clock();  // of the processor: others may use the machine
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double width(Storage storage) { return storage == Storage::single_precision ? 4 : 8; }

}  // namespace

double field_bytes(const Snapshot& snapshot) {
  double bytes = 8 * static_cast<double>(snapshot.points.size());
  for (const std::vector<FieldArray>* fields : {&snapshot.point_fields, &snapshot.cell_fields})
    for (const FieldArray& field : *fields)
      if (!field.fixed_by_topology) bytes += width(field.storage) * static_cast<double>(field.values.size());
  return bytes;
}

// Connectivity, of a scene that is shown as a whole twice, the second time with a code or two a cell;
// offsets, types.
double topology_bytes(const Snapshot& snapshot) {
  const auto cells = static_cast<double>(snapshot.topology.cell_type.size());
  const double list = 8 * static_cast<double>(snapshot.topology.connectivity.size());
  double bytes = list + (8 + 1) * cells;
  if (!is_shown_by_parts(snapshot)) bytes += list + 8 * cells;
  for (const FieldArray& field : snapshot.cell_fields)
    if (field.fixed_by_topology) bytes += width(field.storage) * static_cast<double>(field.values.size());
  return bytes;
}

double OutputCost::bytes(double with_topology) const {
  return first_dump_bytes + std::max(0.0, dumps - 1) * dump_bytes + with_topology * topology_bytes +
         rows * row_bytes;
}

OutputCost measure_output(const Deck& deck, Model& model, double steps) {
  OutputCost cost;
  cost.dumps = std::min(field_schedule(deck).count(deck.time.end), steps + 1);
  cost.rows = std::min(history_schedule(deck).count(deck.time.end), steps + 1);

  const TemporaryFolder folder;
  const std::vector<std::string> columns = history_columns(model);
  ResultWriter writer(folder.path(), "output",
                      {.title = deck.title,
                       .deck_path = deck.file,
                       .deck_text = deck.text,
                       .overrides = {},
                       .version = BRIO_VERSION,
                       .threads = 1},
                      columns);
  FieldObserver observer(model, deck.output.fields_.variables);
  const Snapshot& snapshot = observer.observe(model);
  const double first_seconds = seconds_of([&] { writer.write(snapshot); });
  cost.first_dump_bytes = folder.bytes();
  const auto description = static_cast<double>(fs::file_size(writer.xdmf()));
  const double next_seconds = seconds_of([&] { writer.write(observer.observe(model)); });
  cost.dump_bytes = field_bytes(snapshot) + description;
  cost.topology_bytes = topology_bytes(snapshot);
  cost.dump_seconds = cost.dumps > 1 ? next_seconds : first_seconds;

  constexpr std::size_t sample = 16;
  History history(columns);
  std::vector<double> row;
  const double looking = seconds_of([&] {
    for (std::size_t i = 0; i < sample; ++i) {
      observe_history(model, row);
      history.append(row);
    }
  });
  const double before = static_cast<double>(fs::file_size(writer.history_csv()));
  const double writing = seconds_of([&] { writer.write(history); });
  const double csv = static_cast<double>(fs::file_size(writer.history_csv())) - before;
  cost.row_bytes = csv / sample + 8 * static_cast<double>(columns.size());
  // Rows are written with each dump, or when a batch is full.
  const double batches = std::max(cost.dumps, cost.rows / 1024);
  cost.row_seconds = looking / sample + writing * batches / std::max(1.0, cost.rows);
  return cost;
}

}  // namespace brio
