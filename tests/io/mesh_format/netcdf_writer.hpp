#pragma once
/// A netCDF file that is written: dimensions, variables, then values.

#include <netcdf.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace brio::test {

/// \throws std::runtime_error where the library refuses.
inline void expect_netcdf(int status) {
  if (status != NC_NOERR) throw std::runtime_error(nc_strerror(status));
}

class NetcdfWriter {
 public:
  NetcdfWriter(const std::string& path, int mode) { expect_netcdf(nc_create(path.c_str(), mode, &file_)); }
  void dimension(const std::string& name, std::size_t length) {
    expect_netcdf(nc_def_dim(file_, name.c_str(), length, &dimension_[name]));
  }
  int variable(const std::string& name, nc_type type, const std::vector<std::string>& dimensions) {
    std::vector<int> ids;
    for (const std::string& each : dimensions) ids.push_back(dimension_.at(each));
    expect_netcdf(
        nc_def_var(file_, name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &variable_[name]));
    return variable_[name];
  }
  void attribute(const std::string& variable, const std::string& name, const std::string& text) {
    expect_netcdf(nc_put_att_text(file_, variable_.at(variable), name.c_str(), text.size(), text.data()));
  }
  void end_definitions() { expect_netcdf(nc_enddef(file_)); }
  void put(const std::string& name, const std::vector<double>& values) {
    expect_netcdf(nc_put_var_double(file_, variable_.at(name), values.data()));
  }
  void put(const std::string& name, const std::vector<int>& values) {
    expect_netcdf(nc_put_var_int(file_, variable_.at(name), values.data()));
  }
  void put(const std::string& name, const std::string& text) {
    expect_netcdf(nc_put_var_text(file_, variable_.at(name), text.data()));
  }
  void close() { expect_netcdf(nc_close(file_)); }

 private:
  int file_ = 0;
  std::map<std::string, int> dimension_, variable_;
};

inline constexpr std::size_t name_length = 33;

/// Names as variables of texts hold them.
inline std::string padded(const std::vector<std::string>& names) {
  std::string text;
  for (std::string name : names) {
    name.resize(name_length, '\0');
    text += name;
  }
  return text;
}

}  // namespace brio::test
