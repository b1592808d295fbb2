#include "analysis/storage/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

bool is_special(const std::filesystem::path& target) {
  std::error_code unreachable;
  const auto there = std::filesystem::status(target, unreachable);
  return std::filesystem::exists(there) && !std::filesystem::is_regular_file(there);
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& target) : lock_(resolved(target).string() + ".lock") {
  require_writable(target);
  if (is_special(target)) return;
  // The last holder may have removed the file between our open and our lock. The name then belongs to another
  // file, or to none.
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) refuse_writing(target, errno, "a file in a writable folder");
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) continue;
    if (errno != EWOULDBLOCK) return;
    ::close(descriptor_);
    throw InputError(target.string(), "another process is writing this file: expected one at a time");
  } while (!is_name_of(lock_, descriptor_));
  try {
    remove_leftovers(target);
  } catch (...) {  // the destructor does not run for a constructor that throws
    release();
    throw;
  }
}

FileLock::FileLock(FileLock&& other) noexcept
    : lock_(std::move(other.lock_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

void FileLock::release() {
  if (descriptor_ < 0) return;
  ::unlink(lock_.c_str());
  ::close(descriptor_);
}

FileLock::~FileLock() {
  release();
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw InputError(folder.string(), "another process is writing there: expected one at a time");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace remote_touch
