#pragma once
/// A result that another run begins with: whole by its checksums, with the deck of its run.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "io/files/run_record.hpp"
#include "io/results/read_result.hpp"
#include "io/yaml/yaml_source.hpp"

namespace brio {

/// Of a map of a deck; null where there is none.
std::shared_ptr<const YamlNode> value_in(const std::shared_ptr<const YamlNode>& map, const std::string& key);

class EarlierResult {
 public:
  /// \throws FileError where it is damaged, or no result
  explicit EarlierResult(const std::filesystem::path& path);

  const ResultReader& reader() const { return reader_; }
  const RunRecord& record() const { return record_; }

  /// That which was due at a time; without one the last. \throws FileError where none was
  std::size_t dump_at(const std::optional<double>& time) const;
  /// Number of a part. \throws FileError where there is none of that name
  std::int64_t part(const std::string& name) const;
  /// What its deck says of a part.
  std::shared_ptr<const YamlNode> deck_of(const std::string& part) const;
  /// Words of its element and its material model.
  std::string element(const std::string& part) const;
  std::string model(const std::string& part) const;
  /// Whether there is a field of that name.
  bool holds(const std::string& field) const;

 private:
  double interval_at(std::size_t dump) const;

  std::filesystem::path path_;
  ResultReader reader_;
  RunRecord record_;
  std::shared_ptr<const YamlNode> deck_;
};

}  // namespace brio
