#pragma once
/// A table over time: energies, momentum, probes. Rows gather here and are written in batches.

#include <cassert>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace brio {

class History {
 public:
  /// \param columns names, snake_case; `time` comes first by custom.
  /// \param batch rows to hold before `full()`; room for them is allocated here, so that `append` allocates
  /// nothing.
  explicit History(std::vector<std::string> columns, std::size_t batch = 1024)
      : columns_(std::move(columns)), batch_(batch) {
    assert(!columns_.empty() && batch > 0);
    pending_.reserve(columns_.size() * batch);
  }

  const std::vector<std::string>& columns() const { return columns_; }

  /// One value a column.
  void append(std::span<const double> row) {
    assert(row.size() == columns_.size());
    pending_.insert(pending_.end(), row.begin(), row.end());
  }

  std::size_t pending_rows() const { return pending_.size() / columns_.size(); }
  const std::vector<double>& pending() const { return pending_; }  ///< row after row, not yet written
  bool full() const { return pending_rows() >= batch_; }
  void clear_pending() { pending_.clear(); }

 private:
  std::vector<std::string> columns_;
  std::vector<double> pending_;
  std::size_t batch_;
};

}  // namespace brio
