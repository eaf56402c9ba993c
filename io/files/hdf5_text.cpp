// Text and attributes of Hdf5File.

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <limits>

#include "io/files/hdf5_file.hpp"
#include "src/base/index.hpp"

namespace brio {
namespace {

using std::string;

/// Fixed length, padded with NUL; an empty text still takes one byte.
Hdf5Handle text_type(std::size_t length, H5T_cset_t characters) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  const bool done = type.id() >= 0 && H5Tset_size(type.id(), std::max<std::size_t>(length, 1)) >= 0 &&
                    H5Tset_strpad(type.id(), H5T_STR_NULLPAD) >= 0 && H5Tset_cset(type.id(), characters) >= 0;
  assert(done);
  (void)done;
  return type;
}

string without_padding(const char* text, std::size_t size) {
  while (size > 0 && text[size - 1] == '\0') --size;
  return {text, size};
}

}  // namespace

void Hdf5File::write_text(const string& dataset, std::string_view text) {
  const string padded(text.empty() ? std::string_view("\0", 1) : text);
  const Hdf5Handle type = text_type(text.size(), H5T_CSET_UTF8);
  const Hdf5Handle space = checked(H5Screate(H5S_SCALAR), H5Sclose, "create " + dataset);
  const Hdf5Handle made = checked(
      H5Dcreate2(file_.id(), dataset.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose, "create " + dataset);
  check(H5Dwrite(made.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), "write " + dataset);
}

void Hdf5File::write_texts(const string& dataset, const std::vector<string>& texts) {
  std::size_t longest = 1;
  for (const string& text : texts) longest = std::max(longest, text.size());
  string padded(texts.size() * longest, '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(&padded[i * longest], longest);
  const Hdf5Handle type = text_type(longest, H5T_CSET_UTF8);
  const hsize_t count = texts.size();
  const Hdf5Handle space = checked(H5Screate_simple(1, &count, nullptr), H5Sclose, "create " + dataset);
  const Hdf5Handle made = checked(
      H5Dcreate2(file_.id(), dataset.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose, "create " + dataset);
  if (texts.empty()) return;
  check(H5Dwrite(made.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), "write " + dataset);
}

std::vector<string> Hdf5File::read_texts(const string& dataset) const {
  const string doing = "read " + dataset;
  const std::vector<std::int64_t> size = dimensions(dataset);
  if (size.size() > 1) throw FileError(path_, dataset + " is not a list of texts");
  const std::size_t count = size.empty() ? 1 : index(size[0]);
  const Hdf5Handle opened = open_dataset(dataset);
  const Hdf5Handle type = checked(H5Dget_type(opened.id()), H5Tclose, doing);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0) {
    throw FileError(path_, dataset + " is not text of fixed length");
  }
  const std::size_t length = H5Tget_size(type.id());
  constexpr std::size_t most_bytes = std::numeric_limits<std::ptrdiff_t>::max();
  if (count > most_bytes / std::max<std::size_t>(1, length))
    throw FileError(path_, dataset + " claims more text than any file holds");
  string padded(count * length, '\0');
  if (count > 0) check(H5Dread(opened.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), doing);
  std::vector<string> texts;
  for (std::size_t i = 0; i < count; ++i) texts.push_back(without_padding(&padded[i * length], length));
  return texts;
}

string Hdf5File::read_text(const string& dataset) const {
  const std::vector<string> texts = read_texts(dataset);
  if (texts.size() != 1) throw FileError(path_, dataset + " is not one text");
  return texts[0];
}

void Hdf5File::write_attribute_values(const string& object, const string& name, const Hdf5Handle& space,
                                      const std::int64_t* values) {
  const string doing = "write attribute " + name + " of " + object;
  // By way of the object: in HDF5 1.10.8 an attribute that was opened with H5Aopen_by_name cannot be written.
  const Hdf5Handle owner = checked(H5Oopen(file_.id(), object.c_str(), H5P_DEFAULT), H5Oclose, doing);
  const bool exists = check(H5Aexists(owner.id(), name.c_str()), doing) > 0;
  const hid_t opened =
      exists ? H5Aopen(owner.id(), name.c_str(), H5P_DEFAULT)
             : H5Acreate2(owner.id(), name.c_str(), H5T_STD_I64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT);
  const Hdf5Handle attribute = checked(opened, H5Aclose, doing);
  check(H5Awrite(attribute.id(), H5T_NATIVE_INT64, values), doing);
}

void Hdf5File::write_attribute(const string& object, const string& name, std::int64_t value) {
  const Hdf5Handle space = checked(H5Screate(H5S_SCALAR), H5Sclose, "write attribute " + name);
  write_attribute_values(object, name, space, &value);
}

void Hdf5File::write_attribute(const string& object, const string& name,
                               const std::vector<std::int64_t>& values) {
  const hsize_t count = values.size();
  const Hdf5Handle space = checked(H5Screate_simple(1, &count, nullptr), H5Sclose, "write attribute " + name);
  write_attribute_values(object, name, space, values.data());
}

void Hdf5File::write_ascii_attribute(const string& object, const string& name, std::string_view text) {
  assert(!text.empty());
  const string doing = "write attribute " + name + " of " + object;
  const Hdf5Handle type = text_type(text.size(), H5T_CSET_ASCII);
  const Hdf5Handle space = checked(H5Screate(H5S_SCALAR), H5Sclose, doing);
  const Hdf5Handle attribute = checked(H5Acreate_by_name(file_.id(), object.c_str(), name.c_str(), type.id(),
                                                         space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                       H5Aclose, doing);
  check(H5Awrite(attribute.id(), type.id(), text.data()), doing);
}

Hdf5Handle Hdf5File::open_attribute(const string& object, const string& name) const {
  return checked(H5Aopen_by_name(file_.id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose, "read attribute " + name + " of " + object);
}

std::int64_t Hdf5File::read_integer_attribute(const string& object, const string& name) const {
  const Hdf5Handle attribute = open_attribute(object, name);
  const string doing = "read attribute " + name + " of " + object;
  const Hdf5Handle space = checked(H5Aget_space(attribute.id()), H5Sclose, doing);
  if (H5Sget_simple_extent_npoints(space.id()) != 1)
    throw FileError(path_, "cannot " + doing + ": not one number");
  std::int64_t value = 0;
  check(H5Aread(attribute.id(), H5T_NATIVE_INT64, &value), doing);
  return value;
}

string Hdf5File::read_text_attribute(const string& object, const string& name) const {
  const Hdf5Handle attribute = open_attribute(object, name);
  const string doing = "read attribute " + name + " of " + object;
  const Hdf5Handle type = checked(H5Aget_type(attribute.id()), H5Tclose, doing);
  const Hdf5Handle space = checked(H5Aget_space(attribute.id()), H5Sclose, doing);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0 ||
      H5Sget_simple_extent_npoints(space.id()) != 1) {
    throw FileError(path_, "cannot " + doing + ": not one text of fixed length");
  }
  string padded(H5Tget_size(type.id()), '\0');
  check(H5Aread(attribute.id(), type.id(), padded.data()), doing);
  return without_padding(padded.data(), padded.size());
}

}  // namespace brio
