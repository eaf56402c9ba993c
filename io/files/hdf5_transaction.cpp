#include "io/files/hdf5_transaction.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <string_view>
#include <vector>

#include "src/base/index.hpp"

namespace brio {
namespace {

/// Committed bytes that are to change.
struct Piece {
  haddr_t address;
  std::vector<unsigned char> bytes;
  H5FD_mem_t kind;

  haddr_t end() const { return address + bytes.size(); }
};

struct TransactionFile : H5FD_t {
  int descriptor = -1;
  dev_t device = 0;
  ino_t inode = 0;
  haddr_t end_of_allocation = 0;  ///< as HDF5 wants it
  haddr_t end_of_file = 0;
  haddr_t committed = 0;  ///< length of the file in its last complete state
  std::vector<Piece> waiting;
  int error = 0;
  bool discarded = false;
  bool synchronous = false;  ///< commits are forced to the disk
  bool changed = false;      ///< since the last commit

  bool lost() const { return error != 0 || discarded; }
};

TransactionFile& self(H5FD_t* file) { return *static_cast<TransactionFile*>(file); }
const TransactionFile& self(const H5FD_t* file) { return *static_cast<const TransactionFile*>(file); }

bool write_all(TransactionFile& file, haddr_t address, const unsigned char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = pwrite(file.descriptor, bytes, size, static_cast<off_t>(address));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      file.error = written < 0 ? errno : ENOSPC;
      return false;
    }
    address += static_cast<haddr_t>(written);
    bytes += written;
    size -= index(written);
    file.end_of_file = std::max(file.end_of_file, address);
  }
  return true;
}

bool set_length(TransactionFile& file, haddr_t length) {
  if (ftruncate(file.descriptor, static_cast<off_t>(length)) != 0) {
    file.error = errno;
    return false;
  }
  file.end_of_file = length;
  return true;
}

void sync_if_wanted(TransactionFile& file) {
  if (file.synchronous && file.changed && file.error == 0 && fdatasync(file.descriptor) != 0)
    file.error = errno;
}

/// Remember a change of committed bytes; changes that touch each other become one.
void postpone(TransactionFile& file, H5FD_mem_t kind, haddr_t address, const unsigned char* bytes,
              std::size_t size) {
  Piece piece{address, std::vector<unsigned char>(bytes, bytes + size), kind};
  for (Piece& old : file.waiting) {
    if (old.address != address || old.bytes.size() != size) continue;
    old = std::move(piece);
    return;
  }
  for (auto old = file.waiting.begin(); old != file.waiting.end();) {
    if (old->end() <= piece.address || piece.end() <= old->address) {
      ++old;
      continue;
    }
    const haddr_t first = std::min(old->address, piece.address);
    std::vector<unsigned char> merged(std::max(old->end(), piece.end()) - first);
    std::copy(old->bytes.begin(), old->bytes.end(), merged.begin() + static_cast<long>(old->address - first));
    std::copy(piece.bytes.begin(), piece.bytes.end(),
              merged.begin() + static_cast<long>(piece.address - first));
    piece = Piece{first, std::move(merged), kind};
    old = file.waiting.erase(old);
  }
  file.waiting.push_back(std::move(piece));
}

/// Small goes first. An index node of version 1 begins "TREE", type, level; leaves have level 0.
int rank(const Piece& piece) {
  constexpr std::string_view signature = "TREE";
  constexpr std::size_t level_at = 5;
  if (piece.kind == H5FD_MEM_SUPER) return 0;
  const bool is_node =
      piece.bytes.size() > level_at && std::equal(signature.begin(), signature.end(), piece.bytes.begin());
  return is_node ? 256 - piece.bytes[level_at] : 257;
}

/// Each write of these leaves a file that reads as before.
void apply_waiting(TransactionFile& file) {
  std::sort(file.waiting.begin(), file.waiting.end(), [](const Piece& a, const Piece& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.address < b.address;
  });
  file.committed = file.end_of_file;  // once the superblock knows the new length, the file must keep it
  for (const Piece& piece : file.waiting) {
    if (!write_all(file, piece.address, piece.bytes.data(), piece.bytes.size())) return;
  }
  file.waiting.clear();
  if (file.end_of_file > file.end_of_allocation) set_length(file, file.end_of_allocation);
  file.committed = file.end_of_file;
}

void commit(TransactionFile& file) {
  if (file.lost()) return;
  const bool locked =
      flock(file.descriptor, LOCK_EX | LOCK_NB) == 0;  // a reader that is there already may stay
  if (file.end_of_file < file.end_of_allocation) set_length(file, file.end_of_allocation);
  sync_if_wanted(file);
  if (file.error == 0) apply_waiting(file);
  sync_if_wanted(file);
  file.changed = false;
  if (locked) flock(file.descriptor, LOCK_UN);
}

H5FD_t* open_file(const char* name, unsigned flags, hid_t, haddr_t) {
  int mode = (flags & H5F_ACC_RDWR) != 0 ? O_RDWR : O_RDONLY;
  if ((flags & H5F_ACC_TRUNC) != 0) mode |= O_TRUNC;
  if ((flags & H5F_ACC_CREAT) != 0) mode |= O_CREAT;
  if ((flags & H5F_ACC_EXCL) != 0) mode |= O_EXCL;
  const int descriptor = open(name, mode | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0) return nullptr;
  struct stat status {};
  auto* file = fstat(descriptor, &status) == 0 ? new (std::nothrow) TransactionFile{} : nullptr;
  if (file == nullptr) {
    close(descriptor);
    return nullptr;
  }
  file->descriptor = descriptor;
  file->device = status.st_dev;
  file->inode = status.st_ino;
  file->end_of_file = file->committed = static_cast<haddr_t>(status.st_size);
  return file;
}

herr_t close_file(H5FD_t* base) {
  TransactionFile& file = self(base);
  if (file.end_of_file > file.committed) set_length(file, file.committed);
  const int result = close(file.descriptor);
  delete &file;
  return result == 0 ? 0 : -1;
}

int compare(const H5FD_t* left, const H5FD_t* right) {
  const TransactionFile& a = self(left);
  const TransactionFile& b = self(right);
  if (a.device != b.device) return a.device < b.device ? -1 : 1;
  if (a.inode != b.inode) return a.inode < b.inode ? -1 : 1;
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA |
           H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t end_of_allocation(const H5FD_t* file, H5FD_mem_t) { return self(file).end_of_allocation; }

herr_t set_end_of_allocation(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  self(file).end_of_allocation = address;
  return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) { return self(file).end_of_file; }

herr_t handle(H5FD_t* file, hid_t, void** result) {
  *result = &self(file);
  return 0;
}

herr_t read(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, size_t size, void* buffer) {
  TransactionFile& file = self(base);
  auto* const bytes = static_cast<unsigned char*>(buffer);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count =
        pread(file.descriptor, bytes + done, size - done, static_cast<off_t>(address + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return -1;
    if (count == 0) break;
    done += index(count);
  }
  std::memset(bytes + done, 0, size - done);  // beyond the end of the file
  for (const Piece& piece : file.waiting) {
    const haddr_t first = std::max(address, piece.address);
    const haddr_t last = std::min<haddr_t>(address + size, piece.end());
    if (first < last)
      std::memcpy(bytes + (first - address), &piece.bytes[first - piece.address], last - first);
  }
  return 0;
}

herr_t write(H5FD_t* base, H5FD_mem_t kind, hid_t, haddr_t address, size_t size, const void* buffer) {
  TransactionFile& file = self(base);
  if (file.discarded && file.error == 0) file.error = EBADF;  // known to whoever else has it open
  if (file.lost()) return 0;
  file.changed = true;
  const auto* const bytes = static_cast<const unsigned char*>(buffer);
  std::size_t waits = 0;  // leading bytes that must wait
  if (kind != H5FD_MEM_DRAW && address < file.committed)
    waits = std::min<haddr_t>(size, file.committed - address);
  try {
    if (waits > 0) postpone(file, kind, address, bytes, waits);
  } catch (const std::bad_alloc&) {
    file.error = ENOMEM;
    return 0;
  }
  write_all(file, address + waits, bytes + waits, size - waits);
  return 0;
}

herr_t flush(H5FD_t* file, hid_t, hbool_t) {
  commit(self(file));
  return 0;
}

const H5FD_class_t& driver_class() {
  static const H5FD_class_t driver = [] {
    H5FD_class_t c{};
#ifdef H5FD_CLASS_VERSION
    c.version = H5FD_CLASS_VERSION;
    c.value = static_cast<H5FD_class_value_t>(600);  // of the range for drivers that are not registered
#endif
    c.name = "brio_transaction";
    c.maxaddr = (static_cast<haddr_t>(1) << 62) - 1;
    c.fc_degree = H5F_CLOSE_STRONG;
    c.open = open_file;
    c.close = close_file;
    c.cmp = compare;
    c.query = query;
    c.get_eoa = end_of_allocation;
    c.set_eoa = set_end_of_allocation;
    c.get_eof = end_of_file;
    c.get_handle = handle;
    c.read = read;
    c.write = write;
    c.flush = flush;
    const H5FD_mem_t separate[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(separate), std::end(separate), std::begin(c.fl_map));
    return c;
  }();
  return driver;
}

TransactionFile* transaction(hid_t file) {
  void* found = nullptr;
  return H5Fget_vfd_handle(file, H5P_DEFAULT, &found) < 0 ? nullptr : static_cast<TransactionFile*>(found);
}

}  // namespace

hid_t transaction_access() {
  static const hid_t driver = H5FDregister(&driver_class());
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  // A kill takes effect between the pages of a write: index nodes (2 to 4 kB) keep within one.
  constexpr hsize_t smallest_node = 2048, page = 4096;
  if (driver < 0 || access < 0 || H5Pset_driver(access, driver, nullptr) < 0 ||
      H5Pset_alignment(access, smallest_node, page) < 0)
    return -1;
  return access;
}

int transaction_error(hid_t file) {
  const TransactionFile* const found = transaction(file);
  return found == nullptr ? 0 : found->error;
}

void transaction_sync(hid_t file) {
  if (TransactionFile* const found = transaction(file)) found->synchronous = true;
}

bool transaction_is_at(hid_t file, const char* path) {
  const TransactionFile* const found = transaction(file);
  struct stat status {};
  return found != nullptr && lstat(path, &status) == 0 && status.st_dev == found->device &&
         status.st_ino == found->inode;
}

void transaction_discard(hid_t file) {
  if (TransactionFile* const found = transaction(file)) found->discarded = true;
}

}  // namespace brio
