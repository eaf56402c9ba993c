#pragma once
/// The XDMF companion (http://www.xdmf.org/index.php/XDMF_Model_and_Format): it describes every dump by slabs
/// of the datasets in the VTKHDF file, for ParaView versions that do not read a transient VTKHDF file.
/// Each part is a temporal collection of its own, which ParaView shows as a block under the name of the part.
/// The ending `.xdmf2` makes ParaView take its Xdmf2 reader; the Xdmf3 reader drops fields that are slabs.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/results/write_vtkhdf.hpp"

namespace brio {

class XdmfWriter {
 public:
  /// \param heavy_file name of the VTKHDF file as seen from the folder of the XDMF file.
  explicit XdmfWriter(const std::string& heavy_file);

  void append(const StoredDump& dump);

  /// Whether dumps have grown by a tenth since they were last written. If each text that is due is written,
  /// all of them together have about eleven times the length of the last.
  bool is_due() const { return 10 * dumps_ >= 11 * written_; }

  /// Whether there are dumps that are not written.
  bool is_behind() const { return written_ < dumps_; }

  /// Write all dumps so far to a temporary name beside `path` and rename it: a reader sees the old text or
  /// the new. Nothing is written of no dump. \throws FileError
  void write(const std::filesystem::path& path, bool sync = false);

  /// Saved and restored (src/base/state_archive.hpp): the dumps so far.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(blocks_, dumps_, written_);
  }

 private:
  /// The dumps of a part.
  struct Block {
    std::string name, steps;

    template <class Archive>
    void serialize(Archive& archive) {
      archive(name, steps);
    }
  };

  std::string slab(const StoredArray& array) const;
  std::string list(const StoredArray& array) const;
  std::string attribute(const StoredArray& array, const char* center) const;
  std::string grid(const StoredDump& dump, const StoredPart& part) const;

  std::string heavy_file_;  // escaped for XML
  std::vector<Block> blocks_;
  std::int64_t dumps_ = 0, written_ = 0;
};

}  // namespace brio
