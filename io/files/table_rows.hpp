#pragma once
/// Rows of a table of a result file.

#include <cstdint>
#include <string>

namespace brio {

struct TableRows {
  std::string table;  ///< path in the file
  std::int64_t rows = 0;

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(table, rows);
  }
};

}  // namespace brio
