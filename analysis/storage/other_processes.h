// Other processes: a child that does what may crash, and locks that let one process at a time write.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace remote_touch {

// Runs work that may hang, crash or take all memory, such as a library that reads a file of unknown origin,
// in a separate process.

struct ChildLimits {
  std::size_t memory_bytes;  // added to the memory that this process has
  unsigned processor_s;
};

// Limits for reading a file: 512 MiB plus memory_for_each_byte for each of its bytes; 1 s plus 1 s for each
// MiB.
ChildLimits limits_to_read(const std::filesystem::path& file, std::size_t memory_for_each_byte);

// Returns the result of `work`. Its changes to memory do not affect this process. Throws std::runtime_error
// with the message of the exception of `work`, or with the reason why the child process ended.
std::string in_child(const ChildLimits& limits, const std::function<std::string()>& work);

// A reader whose only input is a string of bytes, so that a process which was started earlier can run it too.
using ChildReader = std::string (*)(const std::string& question);
// Runs a reader in a child process. Returns and throws like in_child().
using RunInChild =
    std::function<std::string(const ChildLimits&, ChildReader reader, const std::string& question)>;
// Runs the reader in a child that begins for this question and ends with its answer.
std::string in_own_child(const ChildLimits& limits, ChildReader reader, const std::string& question);

// Prepares a child process that has just started. Signals then end it, whatever handlers the program has. The
// end of its parent and exceeding the limits end it too.
void become_limited_child(const ChildLimits& limits);

// Locks that let one process at a time write a file, or the files of a folder.

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
