#include "io/mesh_format/netcdf_file.hpp"

#include <netcdf.h>

#include <algorithm>
#include <filesystem>

#include "io/mesh_file/mesh_file_error.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Numbers that a file can hold for each of its bytes: data may be compressed.
constexpr std::uint64_t most_bytes_a_byte = 1100, bytes_beside = 1 << 20;

}  // namespace

NetcdfFile::NetcdfFile(const std::string& path, const std::string& name)
    : name_(name), bytes_(std::filesystem::file_size(path)) {
  const int status = nc_open(path.c_str(), NC_NOWRITE, &file_);
  if (status != NC_NOERR)
    throw MeshFileError(name_, 0, std::string("is not an Exodus file: ") + nc_strerror(status));
}

NetcdfFile::~NetcdfFile() { nc_close(file_); }

void NetcdfFile::fail(const std::string& variable, const std::string& fault) const {
  throw MeshFileError(name_, 0, "variable '" + variable + "': " + fault);
}

std::size_t NetcdfFile::dimension(const std::string& name) const {
  int dimension = 0;
  std::size_t length = 0;
  if (nc_inq_dimid(file_, name.c_str(), &dimension) != NC_NOERR) return 0;
  return nc_inq_dimlen(file_, dimension, &length) == NC_NOERR ? length : 0;
}

bool NetcdfFile::has(const std::string& variable) const {
  int id = 0;
  return nc_inq_varid(file_, variable.c_str(), &id) == NC_NOERR;
}

int NetcdfFile::id_of(const std::string& variable) const {
  int id = 0;
  if (nc_inq_varid(file_, variable.c_str(), &id) != NC_NOERR) fail(variable, "is not there");
  return id;
}

std::vector<std::size_t> NetcdfFile::shape_of(const std::string& variable) const {
  const int id = id_of(variable);
  int count = 0;
  if (nc_inq_varndims(file_, id, &count) != NC_NOERR || count < 0 || count > 8)
    fail(variable, "has dimensions that cannot be read");
  std::vector<int> dimensions(index(count));
  if (count > 0 && nc_inq_vardimid(file_, id, dimensions.data()) != NC_NOERR)
    fail(variable, "has dimensions that cannot be read");
  std::vector<std::size_t> shape;
  for (const int dimension : dimensions) {
    std::size_t length = 0;
    if (nc_inq_dimlen(file_, dimension, &length) != NC_NOERR)
      fail(variable, "has dimensions that cannot be read");
    shape.push_back(length);
  }
  return shape;
}

void NetcdfFile::expect_room(const std::string& variable, std::size_t count) const {
  if (count / most_bytes_a_byte > bytes_ + bytes_beside)
    fail(variable, std::to_string(count) + " numbers are announced, more than the file can hold");
}

void NetcdfFile::expect_count(const std::string& variable, std::size_t count) const {
  std::size_t found = 1;
  for (const std::size_t length : shape_of(variable)) {
    expect_room(variable, length);
    if (length > 0 && found > SIZE_MAX / length) fail(variable, "has too many numbers");
    found *= length;
  }
  if (found != count)
    fail(variable, "has " + std::to_string(found) + " numbers; expected are " + std::to_string(count));
  expect_room(variable, count);
}

std::vector<std::int64_t> NetcdfFile::integers(const std::string& variable, std::size_t count) const {
  expect_count(variable, count);
  std::vector<long long> numbers(count);
  if (const int status = nc_get_var_longlong(file_, id_of(variable), numbers.data());
      count > 0 && status != NC_NOERR)
    fail(variable, nc_strerror(status));
  return {numbers.begin(), numbers.end()};
}

std::vector<double> NetcdfFile::reals(const std::string& variable, std::size_t count) const {
  expect_count(variable, count);
  std::vector<double> numbers(count);
  if (const int status = nc_get_var_double(file_, id_of(variable), numbers.data());
      count > 0 && status != NC_NOERR)
    fail(variable, nc_strerror(status));
  return numbers;
}

std::vector<std::string> NetcdfFile::texts(const std::string& variable, std::size_t count) const {
  std::vector<std::string> texts(count);
  if (!has(variable)) return texts;
  const std::vector<std::size_t> shape = shape_of(variable);
  if (shape.size() != 2 || shape[0] != count) fail(variable, "does not hold one text each");
  expect_room(variable, shape[1]);
  expect_count(variable, count * shape[1]);
  std::string all(count * shape[1], '\0');
  if (const int status = nc_get_var_text(file_, id_of(variable), all.data());
      !all.empty() && status != NC_NOERR)
    fail(variable, nc_strerror(status));
  for (std::size_t i = 0; i < count; ++i) {
    texts[i] = all.substr(i * shape[1], shape[1]);
    texts[i].resize(std::min(texts[i].find('\0'), texts[i].size()));
    while (!texts[i].empty() && texts[i].back() == ' ') texts[i].pop_back();
  }
  return texts;
}

std::string NetcdfFile::text_attribute(const std::string& variable, const std::string& attribute) const {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  if (nc_inq_att(file_, id_of(variable), attribute.c_str(), &type, &length) != NC_NOERR || type != NC_CHAR)
    return {};
  expect_room(variable, length);
  std::string text(length, '\0');
  if (nc_get_att_text(file_, id_of(variable), attribute.c_str(), text.data()) != NC_NOERR) return {};
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

}  // namespace brio
