#pragma once
/// HDF5 as the doors of the project use it: files that change as transactions, tables that grow by rows.
/// Everything throws FileError, which names the file, what was tried and the innermost reason that the
/// library gave. Files are written with the default (oldest) version bounds and without SWMR: any reader
/// opens them, also after the writer was killed.

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/file_error.hpp"
#include "io/files/table_rows.hpp"

namespace brio {

/// Owns one identifier of the HDF5 library.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t identifier, Close close) : identifier_(identifier), close_(close) {}
  ~Hdf5Handle() { reset(); }
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : identifier_(std::exchange(other.identifier_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    if (this != &other) {
      reset();
      identifier_ = std::exchange(other.identifier_, -1);
      close_ = other.close_;
    }
    return *this;
  }

  hid_t id() const { return identifier_; }
  /// \return what the library said; negative is a failure.
  herr_t reset() { return identifier_ < 0 ? 0 : close_(std::exchange(identifier_, -1)); }

 private:
  hid_t identifier_ = -1;
  Close close_ = nullptr;
};

/// Shape and storage of a table that is about to be made.
struct TableShape {
  hid_t type;           ///< as stored, for example H5T_IEEE_F32LE
  hsize_t columns = 0;  ///< 0: one-dimensional
  hsize_t chunk_rows = 1024;
  int compression = 0;  ///< gzip level after shuffling, 0 for none
};

/// Rows that were appended to a table, and the checksum of their bytes as stored.
struct AppendedRows {
  std::string table;
  std::int64_t first = 0, rows = 0;
  std::uint64_t checksum = 0;
};

class Hdf5File {
 public:
  static Hdf5File open_to_read(const std::filesystem::path& path);
  /// Replaces a file that is there; a symbolic link is replaced, not followed.
  static Hdf5File create(const std::filesystem::path& path);
  /// \param sync whether every commit is forced to the disk
  static Hdf5File open_to_append(const std::filesystem::path& path, bool sync = false);
  /// Without `close()` before it, what came after the last commit is taken back.
  ~Hdf5File();
  Hdf5File(Hdf5File&&) noexcept = default;
  Hdf5File& operator=(Hdf5File&&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Of a file that was opened to append: whether its path still leads to it.
  bool is_at_path() const;
  hid_t id() const { return file_.id(); }

  /// Make everything so far part of the file. After a failure the file is as of the last commit.
  void commit();
  /// Commit, then close.
  void close();

  bool contains(const std::string& object) const;                    ///< an absolute path, every part of it
  std::vector<std::string> members(const std::string& group) const;  ///< names, sorted

  void create_group(const std::string& group);
  void create_table(const std::string& table, const TableShape& shape);
  /// A compressed chunk is never written again, because that would move it while the old index still shows
  /// the old place: rows of a compressed table begin at the next chunk, and what is left of the last one
  /// stays unused. \param data rows x columns values of `memory_type`. \return the row at which they now
  /// begin.
  std::int64_t append_rows(const std::string& table, hsize_t rows, hid_t memory_type, const void* data);
  /// What was appended to tables since the file was opened, or since the last call.
  std::vector<AppendedRows> take_appended() { return std::exchange(appended_, {}); }
  /// Of rows of a table as they are stored. \throws FileError where it is no table of numbers as they are
  /// written here.
  std::uint64_t checksum_of_rows(const std::string& table, std::int64_t first, std::int64_t rows) const;
  /// Dimensions of a dataset; empty for a single value.
  std::vector<std::int64_t> dimensions(const std::string& dataset) const;
  /// \throws FileError where it is no table
  std::int64_t rows_of(const std::string& table) const;
  /// Names and rows of all tables, in the order of their names.
  std::vector<TableRows> tables() const;
  /// \throws FileError where the table has fewer
  void expect_rows(const TableRows& table) const;
  /// Take back rows at the end of a table. \pre expect_rows
  void truncate(const TableRows& table);
  /// Rows [first, first + rows) of a table, all columns, converted to double (integers up to 2^53 exactly).
  std::vector<double> read_rows(const std::string& table, std::int64_t first, std::int64_t rows) const;
  /// Bytes of a table of H5T_STD_U8LE.
  void read_bytes(const std::string& table, std::int64_t first, std::int64_t rows, void* bytes) const;
  std::vector<std::int64_t> read_integers(const std::string& table, std::int64_t first,
                                          std::int64_t rows) const;

  /// A dataset of fixed-length text, UTF-8, padded with NUL.
  void write_text(const std::string& dataset, std::string_view text);
  void write_texts(const std::string& dataset, const std::vector<std::string>& texts);
  std::string read_text(const std::string& dataset) const;
  std::vector<std::string> read_texts(const std::string& dataset) const;

  /// Made if it is not there. \param values one value makes a scalar attribute.
  void write_attribute(const std::string& object, const std::string& name, std::int64_t value);
  void write_attribute(const std::string& object, const std::string& name,
                       const std::vector<std::int64_t>& values);
  /// Scalar, ASCII, exactly as long as the text, no NUL: the form that every VTKHDF reader understands.
  void write_ascii_attribute(const std::string& object, const std::string& name, std::string_view text);
  std::int64_t read_integer_attribute(const std::string& object, const std::string& name) const;
  std::string read_text_attribute(const std::string& object, const std::string& name) const;

 private:
  Hdf5File(std::filesystem::path path, Hdf5Handle file) : path_(std::move(path)), file_(std::move(file)) {}

  Hdf5Handle open_dataset(const std::string& dataset) const;
  const Hdf5Handle& table_to_append(const std::string& table);
  hsize_t first_free_row(const Hdf5Handle& dataset, hsize_t rows) const;
  Hdf5Handle open_attribute(const std::string& object, const std::string& name) const;
  void read_table(const std::string& table, std::int64_t first, std::int64_t rows, hid_t memory_type,
                  void* data) const;
  std::size_t columns_of(const std::string& table, std::int64_t first, std::int64_t rows) const;
  void write_attribute_values(const std::string& object, const std::string& name, const Hdf5Handle& space,
                              const std::int64_t* values);
  /// \throws FileError when the library returned a failure.
  hid_t check(hid_t result, const std::string& doing) const;
  Hdf5Handle checked(hid_t result, Hdf5Handle::Close release, const std::string& doing) const {
    return {check(result, doing), release};
  }

  std::filesystem::path path_;
  Hdf5Handle file_;
  std::vector<AppendedRows> appended_;
  std::map<std::string, Hdf5Handle> grown_;  ///< tables that stay open, since they grow with each dump
};

}  // namespace brio
