#pragma once
/// The XDMF companion (http://www.xdmf.org/index.php/XDMF_Model_and_Format): it describes every dump by slabs
/// of the datasets in the VTKHDF file, for ParaView versions that do not read a transient VTKHDF file.
/// Nothing but the list of cells is stored twice. The ending `.xdmf2` makes ParaView take its Xdmf2 reader;
/// the Xdmf3 reader drops fields that are slabs.

#include <filesystem>
#include <string>

#include "io/results/write_vtkhdf.hpp"

namespace brio {

class XdmfWriter {
 public:
  /// \param heavy_file name of the VTKHDF file as seen from the folder of the XDMF file.
  explicit XdmfWriter(const std::string& heavy_file);

  void append(const StoredDump& dump);

  /// Write all dumps so far to a temporary name beside `path` and rename it: a reader sees the old text or
  /// the new. \throws FileError
  void write(const std::filesystem::path& path, bool sync = false) const;

  /// Saved and restored (src/base/state_archive.hpp): the dumps so far.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(steps_);
  }

 private:
  std::string slab(const StoredArray& array) const;
  std::string attribute(const StoredArray& array, const char* center) const;

  std::string heavy_file_;  // escaped for XML
  std::string steps_;
};

}  // namespace brio
