#pragma once
/// A netCDF file, open for reading: what Exodus needs of it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace brio {

class NetcdfFile {
 public:
  /// \param name what messages call the file \throws MeshFileError where it is not netCDF
  NetcdfFile(const std::string& path, const std::string& name);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  /// 0 where there is none of that name.
  std::size_t dimension(const std::string& name) const;
  bool has(const std::string& variable) const;
  /// \pre has(variable) \throws MeshFileError where the count is another, or larger than the file can hold
  std::vector<std::int64_t> integers(const std::string& variable, std::size_t count) const;
  std::vector<double> reals(const std::string& variable, std::size_t count) const;
  /// Texts without blanks and zeros at their ends; of a variable that is not there as many empty ones.
  std::vector<std::string> texts(const std::string& variable, std::size_t count) const;
  /// Empty where it is not there.
  std::string text_attribute(const std::string& variable, const std::string& attribute) const;

  [[noreturn]] void fail(const std::string& variable, const std::string& fault) const;

 private:
  int id_of(const std::string& variable) const;
  std::vector<std::size_t> shape_of(const std::string& variable) const;
  void expect_count(const std::string& variable, std::size_t count) const;
  void expect_room(const std::string& variable, std::size_t count) const;

  std::string name_;
  std::uint64_t bytes_ = 0;
  int file_ = -1;
};

}  // namespace brio
