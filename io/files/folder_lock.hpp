#pragma once
/// One process writes in a folder at a time.

#include <filesystem>

namespace brio {

/// Holds a folder by a lock of the system (flock) on its file `.brio.lock`, in which the owner is named. The
/// system releases the lock when the process ends, however it ends; the file alone means nothing.
class FolderLock {
 public:
  /// Where the owner that the file names is dead, its child processes are ending: waits for them up to five
  /// seconds. \throws FileError naming the owner where another process writes there.
  explicit FolderLock(std::filesystem::path folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// \throws FileError where the folder under the path is no longer the one that was locked: it was moved,
  /// removed, or another took its place.
  void check() const;
  /// A child process that keeps it open holds the lock as well.
  int descriptor() const { return descriptor_; }

 private:
  bool try_to_lock();
  bool is_at_path() const;

  std::filesystem::path folder_, file_;
  int descriptor_ = -1;
};

}  // namespace brio
