#include "analysis/storage/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
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

[[noreturn]] void refuse_lock(const std::filesystem::path& target, int error) {
  throw InputError(target.string(), std::string("cannot be locked (") + std::strerror(error) +
                                        "): expected a file system whose locks work, or one without locks");
}

}  // namespace

int lock_error(int descriptor, int operation) {
  while (::flock(descriptor, operation) != 0)
    if (errno != EINTR) return errno;
  return 0;
}

bool has_no_locks(int error) {
  return error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP || error == EINVAL;
}

FileLock::FileLock(const std::filesystem::path& target) : lock_(resolved(target).string() + ".lock") {
  require_writable(target);
  if (is_special(target)) return;
  // The last holder may have removed the file between our open and our lock. The name then belongs to another
  // file, or to none.
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) refuse_writing(target, errno, "a file in a writable folder");
    const int error = lock_error(descriptor_, LOCK_EX | LOCK_NB);
    if (error == 0) continue;
    if (has_no_locks(error)) return;
    ::close(descriptor_);
    if (error != EWOULDBLOCK) refuse_lock(target, error);
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

// /proc/locks has a line for each lock: "1: FLOCK  ADVISORY  WRITE 712 fe:00:1835069 0 EOF". The sixth word
// is the device, in hexadecimal digits, and the number of the file.
bool is_being_written(const std::filesystem::path& target) {
  struct stat there = {};
  if (::stat((resolved(target).string() + ".lock").c_str(), &there) != 0) return false;
  char name[64];
  std::snprintf(name, sizeof name, "%02x:%02x:%ju", ::major(there.st_dev), ::minor(there.st_dev),
                static_cast<std::uintmax_t>(there.st_ino));
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);)
    if (line.find(" FLOCK ") != std::string::npos &&
        line.find(std::string(" ") + name + " ") != std::string::npos)
      return true;
  return false;
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) return;
  const int error = lock_error(descriptor_, LOCK_EX | LOCK_NB);
  if (error == 0 || has_no_locks(error)) return;
  ::close(descriptor_);
  if (error != EWOULDBLOCK) refuse_lock(folder, error);
  throw InputError(folder.string(), "another process is writing there: expected one at a time");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace remote_touch
