#include "io/files/hdf5_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <limits>

#include "io/files/checksum.hpp"
#include "io/files/hdf5_transaction.hpp"
#include "io/files/text_file.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using std::string;

/// The library prints nothing: what goes wrong is thrown.
void keep_quiet() {
  static const bool done = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  (void)done;
}

/// The innermost entry of the library's error stack.
string library_reason() {
  string reason;
  const auto take_first = [](unsigned depth, const H5E_error2_t* entry, void* text) -> herr_t {
    if (depth == 0 && entry->desc != nullptr) *static_cast<string*>(text) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &reason);
  return reason;
}

/// So that the reason is the system's own word.
void try_to_open(const std::filesystem::path& path, int mode) {
  const int descriptor = ::open(path.c_str(), mode | O_CLOEXEC, 0666);
  if (descriptor < 0) throw FileError(path, string("cannot open the file: ") + std::strerror(errno));
  ::close(descriptor);
}

void must_be_hdf5(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) throw FileError(path, "not a regular file");
  if (std::filesystem::file_size(path) == 0) throw FileError(path, "the file is empty");
  if (H5Fis_hdf5(path.c_str()) <= 0) throw FileError(path, "not an HDF5 file");
}

Hdf5Handle transaction_properties(const std::filesystem::path& path) {
  Hdf5Handle access(transaction_access(), H5Pclose);
  // Without a chunk cache an append writes its rows straight from the caller's memory.
  if (access.id() < 0 || H5Pset_cache(access.id(), 0, 0, 0, 0) < 0 ||
      H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG) < 0) {
    throw FileError(path, "cannot set up HDF5: " + library_reason());
  }
  return access;
}

}  // namespace

hid_t Hdf5File::check(hid_t result, const string& doing) const {
  if (result >= 0) return result;
  const string library = library_reason();
  const int error = file_.id() < 0 ? 0 : transaction_error(file_.id());
  throw FileError(path_, "cannot " + doing + ": " + (error != 0 ? std::strerror(error) : library));
}

Hdf5File Hdf5File::open_to_read(const std::filesystem::path& path) {
  keep_quiet();
  try_to_open(path, O_RDONLY | O_NONBLOCK);  // a pipe would wait for its other end
  must_be_hdf5(path);
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file.id() < 0) throw FileError(path, "cannot open as HDF5: " + library_reason());
  return {path, std::move(file)};
}

Hdf5File Hdf5File::create(const std::filesystem::path& path) {
  keep_quiet();
  ::close(new_file(path));
  const Hdf5Handle access = transaction_properties(path);
  Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
  if (file.id() < 0) throw FileError(path, "cannot create as HDF5: " + library_reason());
  return {path, std::move(file)};
}

Hdf5File Hdf5File::open_to_append(const std::filesystem::path& path, bool sync) {
  keep_quiet();
  try_to_open(path, O_RDWR | O_NOFOLLOW | O_NONBLOCK);
  must_be_hdf5(path);
  const Hdf5Handle access = transaction_properties(path);
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, access.id()), H5Fclose);
  if (file.id() < 0) throw FileError(path, "cannot open as HDF5: " + library_reason());
  if (sync) transaction_sync(file.id());
  return {path, std::move(file)};
}

Hdf5File::~Hdf5File() {
  if (file_.id() >= 0) transaction_discard(file_.id());
}

bool Hdf5File::is_at_path() const { return transaction_is_at(file_.id(), path_.c_str()); }

void Hdf5File::commit() {
  const herr_t result = H5Fflush(file_.id(), H5F_SCOPE_GLOBAL);
  const int error = transaction_error(file_.id());
  if (error != 0) throw FileError(path_, string("cannot write: ") + std::strerror(error));
  check(result, "write");
}

void Hdf5File::close() {
  commit();
  grown_.clear();
  check(file_.reset(), "close the file");
}

bool Hdf5File::contains(const string& object) const {
  assert(!object.empty() && object[0] == '/');
  for (std::size_t end = object.find('/', 1);; end = object.find('/', end + 1)) {
    if (H5Lexists(file_.id(), object.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == string::npos) return true;
  }
}

std::vector<string> Hdf5File::members(const string& group) const {
  std::vector<string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<string>*>(list)->emplace_back(name);
    return 0;
  };
  const Hdf5Handle opened =
      checked(H5Gopen2(file_.id(), group.c_str(), H5P_DEFAULT), H5Gclose, "open " + group);
  check(H5Literate(opened.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names), "list " + group);
  return names;
}

void Hdf5File::create_group(const string& group) {
  checked(H5Gcreate2(file_.id(), group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
          "create " + group);
}

void Hdf5File::create_table(const string& table, const TableShape& shape) {
  const int rank = shape.columns == 0 ? 1 : 2;
  const std::array<hsize_t, 2> size{0, shape.columns};
  const std::array<hsize_t, 2> limit{H5S_UNLIMITED, shape.columns};
  const std::array<hsize_t, 2> chunk{shape.chunk_rows, shape.columns};
  const string doing = "create " + table;
  const Hdf5Handle space = checked(H5Screate_simple(rank, size.data(), limit.data()), H5Sclose, doing);
  const Hdf5Handle properties = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, doing);
  check(H5Pset_chunk(properties.id(), rank, chunk.data()), doing);
  check(H5Pset_fill_time(properties.id(), H5D_FILL_TIME_NEVER), doing);
  if (shape.compression > 0) {
    check(H5Pset_shuffle(properties.id()), doing);
    check(H5Pset_deflate(properties.id(), static_cast<unsigned>(shape.compression)), doing);
  }
  checked(H5Dcreate2(file_.id(), table.c_str(), shape.type, space.id(), H5P_DEFAULT, properties.id(),
                     H5P_DEFAULT),
          H5Dclose, doing);
}

Hdf5Handle Hdf5File::open_dataset(const string& dataset) const {
  return checked(H5Dopen2(file_.id(), dataset.c_str(), H5P_DEFAULT), H5Dclose, "open " + dataset);
}

const Hdf5Handle& Hdf5File::table_to_append(const string& table) {
  const auto known = grown_.find(table);
  return known != grown_.end() ? known->second : grown_.emplace(table, open_dataset(table)).first->second;
}

hsize_t Hdf5File::first_free_row(const Hdf5Handle& dataset, hsize_t rows) const {
  const string doing = "read the layout of a table";
  const Hdf5Handle properties = checked(H5Dget_create_plist(dataset.id()), H5Pclose, doing);
  if (check(H5Pget_nfilters(properties.id()), doing) == 0) return rows;
  std::array<hsize_t, 2> chunk{};
  check(H5Pget_chunk(properties.id(), 2, chunk.data()), doing);
  return (rows + chunk[0] - 1) / chunk[0] * chunk[0];
}

std::int64_t Hdf5File::append_rows(const string& table, hsize_t rows, hid_t memory_type, const void* data) {
  const Hdf5Handle& dataset = table_to_append(table);
  const string doing = "append to " + table;
  std::array<hsize_t, 2> size{};
  Hdf5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, doing);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  assert(rank == 1 || rank == 2);
  check(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), doing);
  if (rows == 0) return static_cast<std::int64_t>(size[0]);
  const std::array<hsize_t, 2> start{first_free_row(dataset, size[0]), 0};
  size[0] = start[0] + rows;
  check(H5Dset_extent(dataset.id(), size.data()), doing);
  const std::array<hsize_t, 2> count{rows, size[1]};
  space = checked(H5Screate_simple(rank, size.data(), nullptr), H5Sclose, doing);
  const Hdf5Handle memory = checked(H5Screate_simple(rank, count.data(), nullptr), H5Sclose, doing);
  check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), doing);
  check(H5Dwrite(dataset.id(), memory_type, memory.id(), space.id(), H5P_DEFAULT, data), doing);
  const std::size_t bytes = rows * (rank == 2 ? size[1] : 1) * H5Tget_size(memory_type);
  appended_.push_back({table, static_cast<std::int64_t>(start[0]), static_cast<std::int64_t>(rows),
                       brio::checksum(data, bytes)});
  return static_cast<std::int64_t>(start[0]);
}

std::vector<std::int64_t> Hdf5File::dimensions(const string& dataset) const {
  const Hdf5Handle opened = open_dataset(dataset);
  const Hdf5Handle space = checked(H5Dget_space(opened.id()), H5Sclose, "read " + dataset);
  std::array<hsize_t, H5S_MAX_RANK> size{};
  const auto rank = check(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), "read " + dataset);
  return {size.begin(), size.begin() + rank};
}

std::int64_t Hdf5File::rows_of(const string& table) const {
  const std::vector<std::int64_t> size = dimensions(table);
  if (size.empty()) throw FileError(path_, table + " is not a table");
  return size[0];
}

std::vector<TableRows> Hdf5File::tables() const {
  std::vector<TableRows> tables;
  const auto visit = [](hid_t file, const char* name, const H5O_info_t* object, void* list) -> herr_t {
    if (object->type != H5O_TYPE_DATASET) return 0;
    const Hdf5Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
    std::array<hsize_t, H5S_MAX_RANK> size{}, limit{};
    const int rank = H5Sget_simple_extent_dims(space.id(), size.data(), limit.data());
    if (rank < 0) return -1;
    if (rank > 0 && limit[0] == H5S_UNLIMITED)
      static_cast<std::vector<TableRows>*>(list)->push_back(
          {string("/") + name, static_cast<std::int64_t>(size[0])});
    return 0;
  };
  check(H5Ovisit2(file_.id(), H5_INDEX_NAME, H5_ITER_INC, visit, &tables, H5O_INFO_BASIC), "list the tables");
  return tables;
}

void Hdf5File::expect_rows(const TableRows& table) const {
  const std::int64_t rows = rows_of(table.table);
  if (rows < table.rows)
    throw FileError(path_, table.table + " has " + std::to_string(rows) + " rows of " +
                               std::to_string(table.rows) + " that it had when the run was saved");
}

void Hdf5File::truncate(const TableRows& table) {
  const Hdf5Handle dataset = open_dataset(table.table);
  const string doing = "shorten " + table.table;
  const Hdf5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, doing);
  std::array<hsize_t, H5S_MAX_RANK> size{};
  check(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), doing);
  const auto rows = static_cast<hsize_t>(table.rows);
  assert(rows <= size[0]);
  if (size[0] == rows) return;
  size[0] = rows;
  check(H5Dset_extent(dataset.id(), size.data()), doing);
}

std::size_t Hdf5File::columns_of(const string& table, std::int64_t first, std::int64_t rows) const {
  const std::vector<std::int64_t> size = dimensions(table);
  if (size.empty() || size.size() > 2) throw FileError(path_, table + " is not a table");
  if (first < 0 || rows < 0 || first > size[0] - rows) {
    throw FileError(path_,
                    table + " has " + std::to_string(size[0]) + " rows, too few for what the file says");
  }
  const std::int64_t columns = size.size() == 2 ? size[1] : 1;
  constexpr std::int64_t most_values = std::numeric_limits<std::int64_t>::max() / 8;
  if (rows > 0 && (columns < 0 || columns > most_values / rows))
    throw FileError(path_, table + " claims more values than any file holds");
  return index(columns);
}

void Hdf5File::read_table(const string& table, std::int64_t first, std::int64_t rows, hid_t memory_type,
                          void* data) const {
  const Hdf5Handle dataset = open_dataset(table);
  const string doing = "read " + table;
  std::array<hsize_t, 2> size{};
  const Hdf5Handle space = checked(H5Dget_space(dataset.id()), H5Sclose, doing);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  check(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), doing);
  const std::array<hsize_t, 2> start{static_cast<hsize_t>(first), 0};
  const std::array<hsize_t, 2> count{static_cast<hsize_t>(rows), size[1]};
  const Hdf5Handle memory = checked(H5Screate_simple(rank, count.data(), nullptr), H5Sclose, doing);
  check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), doing);
  check(H5Dread(dataset.id(), memory_type, memory.id(), space.id(), H5P_DEFAULT, data), doing);
}

std::vector<double> Hdf5File::read_rows(const string& table, std::int64_t first, std::int64_t rows) const {
  std::vector<double> values(columns_of(table, first, rows) * index(rows));
  if (!values.empty()) read_table(table, first, rows, H5T_NATIVE_DOUBLE, values.data());
  return values;
}

std::vector<std::int64_t> Hdf5File::read_integers(const string& table, std::int64_t first,
                                                  std::int64_t rows) const {
  std::vector<std::int64_t> values(columns_of(table, first, rows) * index(rows));
  if (!values.empty()) read_table(table, first, rows, H5T_NATIVE_INT64, values.data());
  return values;
}

void Hdf5File::read_bytes(const string& table, std::int64_t first, std::int64_t rows, void* bytes) const {
  if (columns_of(table, first, rows) != 1) throw FileError(path_, table + " is not a list");
  if (rows > 0) read_table(table, first, rows, H5T_NATIVE_UCHAR, bytes);
}

std::uint64_t Hdf5File::checksum_of_rows(const string& table, std::int64_t first, std::int64_t rows) const {
  const std::size_t values = columns_of(table, first, rows) * index(rows);
  const Hdf5Handle dataset = open_dataset(table);
  const Hdf5Handle stored = checked(H5Dget_type(dataset.id()), H5Tclose, "read " + table);
  for (const hid_t type : {H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_U8LE}) {
    if (H5Tequal(stored.id(), type) <= 0) continue;
    std::vector<unsigned char> bytes(values * H5Tget_size(type));
    if (!bytes.empty()) read_table(table, first, rows, type, bytes.data());
    return brio::checksum(bytes.data(), bytes.size());
  }
  throw FileError(path_, table + " does not hold numbers of a type that brio writes");
}

}  // namespace brio
