// Locks that let one process at a time write a file, or the files of a folder.
#pragma once

#include <filesystem>

namespace remote_touch {

// Calls flock(), again after a signal. Returns 0, or the errno.
int lock_error(int descriptor, int operation);
// True for the errors of flock() on a file system without locks.
bool has_no_locks(int error);

// The right to write a file, held from construction to destruction. The lock is on a file beside it with the
// ending ".lock", so that the file itself can be replaced and read at any time. A killed process holds no
// lock, even if its ".lock" file remains. The constructor also removes temporary files of the target that
// killed processes left. It throws InputError, which names the target, if another process holds the lock, and
// like require_writable(), and if the lock fails for another reason. No lock is taken for /dev/null, or on a
// file system without locks.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& target);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  void release();
  std::filesystem::path lock_;
  int descriptor_ = -1;
};

// True if a process of this machine holds the lock of a file. The lock itself is not touched. False where the
// system does not list its locks.
bool is_being_written(const std::filesystem::path& target);

// The right to write files in a folder, held from construction to destruction; it leaves no file, whatever
// ends the process. Throws InputError, which names the folder, if another process holds it, and if the lock
// fails for another reason. No lock is taken if the folder cannot be opened, or on a file system without
// locks.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace remote_touch
