#include "io/restart/restart_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <streambuf>
#include <vector>

#include "io/files/checksum.hpp"
#include "io/files/hdf5_file.hpp"
#include "io/files/read_apart.hpp"
#include "io/files/text_file.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 22;
constexpr hsize_t bytes_chunk_rows = hsize_t{1} << 16, blocks_chunk_rows = 1024;
constexpr const char* bytes_table = "/state/bytes";
constexpr const char* blocks_table = "/state/blocks";

/// A state on its way to the file, block by block.
class BlockWriter : public std::streambuf {
 public:
  explicit BlockWriter(Hdf5File& file) : file_(file), block_(block_bytes) {
    file.create_group("/state");
    file.create_table(bytes_table, {H5T_STD_U8LE, 0, bytes_chunk_rows});
    file.create_table(blocks_table, {H5T_STD_I64LE, 2, blocks_chunk_rows});
    begin_block();
  }
  void finish() {
    const auto size = index(pptr() - pbase());
    if (size == 0) return;
    file_.append_rows(bytes_table, size, H5T_NATIVE_UCHAR, block_.data());
    const std::int64_t row[] = {static_cast<std::int64_t>(size),
                                std::bit_cast<std::int64_t>(checksum(block_.data(), size))};
    file_.append_rows(blocks_table, 1, H5T_NATIVE_INT64, row);
    begin_block();
  }

 protected:
  int_type overflow(int_type c) override {
    finish();
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    *pptr() = traits_type::to_char_type(c);
    pbump(1);
    return c;
  }

 private:
  void begin_block() { setp(block_.data(), block_.data() + block_.size()); }

  Hdf5File& file_;
  std::vector<char> block_;
};

/// The blocks of a state one after the other. \throws FileError where one is not as it was written
class BlockReader : public std::streambuf {
 public:
  explicit BlockReader(const Hdf5File& file) : file_(file) {
    const std::vector<std::int64_t> size = file.dimensions(blocks_table);
    if (size.size() != 2 || size[1] != 2) throw FileError(file.path(), "is not a restart file");
    blocks_ = file.read_integers(blocks_table, 0, size[0]);
    for (std::size_t b = 0; b < blocks_.size(); b += 2) {
      if (blocks_[b] < 1 || blocks_[b] > static_cast<std::int64_t>(block_bytes))
        throw FileError(file.path(), "is damaged: a block has a size that none can have");
      bytes_ += blocks_[b];
    }
    if (file.dimensions(bytes_table) != std::vector<std::int64_t>{bytes_})
      throw FileError(file.path(), "is damaged: the state has not as many bytes as its blocks");
  }
  std::uint64_t bytes() const { return static_cast<std::uint64_t>(bytes_); }
  bool next_block() {
    if (next_ == blocks_.size()) return false;
    const std::int64_t size = blocks_[next_];
    block_.resize(index(size));
    file_.read_bytes(bytes_table, first_, size, block_.data());
    if (std::bit_cast<std::int64_t>(checksum(block_.data(), block_.size())) != blocks_[next_ + 1])
      throw FileError(file_.path(), "is damaged: checksum of block " + std::to_string(next_ / 2));
    first_ += size;
    next_ += 2;
    setg(block_.data(), block_.data(), block_.data() + size);
    return true;
  }

 protected:
  int_type underflow() override {
    return next_block() ? traits_type::to_int_type(*gptr()) : traits_type::eof();
  }

 private:
  const Hdf5File& file_;
  std::vector<std::int64_t> blocks_;  ///< size and checksum of each
  std::vector<char> block_;
  std::size_t next_ = 0;
  std::int64_t first_ = 0, bytes_ = 0;
};

std::int64_t header_checksum(const RestartHeader& header, const std::vector<std::int64_t>& blocks) {
  std::string text = texts_of(header.record);
  text.append(reinterpret_cast<const char*>(&header.time), sizeof header.time);
  text.append(reinterpret_cast<const char*>(&header.step), sizeof header.step);
  text.append(reinterpret_cast<const char*>(blocks.data()), blocks.size() * sizeof(std::int64_t));
  return std::bit_cast<std::int64_t>(checksum(text.data(), text.size()));
}

std::vector<std::int64_t> blocks_of(const Hdf5File& file) {
  return file.read_integers(blocks_table, 0, file.rows_of(blocks_table));
}

RestartHeader read_header(const Hdf5File& file) {
  for (const char* part : {"/deck/title", "/state", bytes_table, blocks_table})
    if (!file.contains(part)) throw FileError(file.path(), "is not a restart file of brio");
  RestartHeader header{.record = read_record(file)};
  header.time = std::bit_cast<double>(file.read_integer_attribute("/state", "time"));
  header.step = file.read_integer_attribute("/state", "step");
  if (file.read_integer_attribute("/state", "checksum") != header_checksum(header, blocks_of(file)))
    throw FileError(file.path(), "is damaged: checksum of what it says of itself");
  return header;
}

void expect_own_program(const Hdf5File& file, const RestartHeader& header) {
  if (file.read_integer_attribute("/state", "program") == program_checksum()) return;
  throw FileError(file.path(), "was written by another build of brio (version " + header.record.version +
                                   "); a state is read by the program that wrote it");
}

// What HDF5 makes of a damaged file is kept away from this process.
void verify_apart(const std::filesystem::path& path) {
  read_apart(path, [&] {
    verify_restart(path);
    return std::string("good");
  });
}

std::filesystem::path previous_of(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  const std::string ending = restart_ending;
  if (!name.ends_with(ending)) return {};
  return path.parent_path() / (name.substr(0, name.size() - ending.size()) + previous_restart_ending);
}

}  // namespace

void write_restart(const std::filesystem::path& folder, const std::string& name, const RestartHeader& header,
                   const std::function<void(std::ostream&)>& save) {
  const std::filesystem::path path = folder / (name + restart_ending);
  std::filesystem::path partial = path;
  partial += ".partial";
  Hdf5File file = Hdf5File::create(partial);
  write_record(file, header.record);
  BlockWriter blocks(file);
  std::ostream out(&blocks);
  out.exceptions(std::ios::badbit);
  save(out);
  blocks.finish();
  file.commit();
  file.write_attribute("/state", "time", std::bit_cast<std::int64_t>(header.time));
  file.write_attribute("/state", "step", header.step);
  file.write_attribute("/state", "program", program_checksum());
  // Of the record as it is stored: a path need not be UTF-8.
  const RestartHeader stored{.record = read_record(file), .time = header.time, .step = header.step};
  file.write_attribute("/state", "checksum", header_checksum(stored, blocks_of(file)));
  file.close();
  sync_to_disk(partial);
  if (std::filesystem::exists(path)) rename_file(path, previous_of(path));
  rename_file(partial, path);
  sync_to_disk(folder);
}

bool is_restart_file(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.ends_with(restart_ending) || name.ends_with(previous_restart_ending);
}

RestartHeader verify_restart(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open_to_read(path);
  RestartHeader header = read_header(file);
  BlockReader blocks(file);
  while (blocks.next_block()) {
  }
  return header;
}

std::string restart_text(const std::filesystem::path& path) {
  const RestartHeader header = verify_restart(path);
  std::string text = fmt::format(
      "{}\n  restart    of a run saved at time {:.6g}, after {} steps; whole by its checksums\n"
      "  deck       {}\n  version    {}\n",
      path.string(), header.time, header.step, header.record.deck_path, header.record.version);
  for (const std::string& setting : header.record.overrides) text += "  --set      " + setting + "\n";
  return text;
}

RestartFile find_restart(const std::filesystem::path& path) {
  RestartFile found;
  found.path = path;
  try {
    verify_apart(path);
  } catch (const FileError& fault) {
    found.path = previous_of(path);
    found.instead_of = fault.what();
    if (found.path.empty() || !std::filesystem::exists(found.path)) throw;
    verify_apart(found.path);
  }
  const Hdf5File file = Hdf5File::open_to_read(found.path);
  found.header = read_header(file);
  expect_own_program(file, found.header);
  return found;
}

void read_restart(const RestartFile& restart,
                  const std::function<void(std::istream&, std::uint64_t)>& restore) {
  const Hdf5File file = Hdf5File::open_to_read(restart.path);
  BlockReader blocks(file);
  std::istream in(&blocks);
  in.exceptions(std::ios::badbit);
  restore(in, blocks.bytes());
}

}  // namespace brio
