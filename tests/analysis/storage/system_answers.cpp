#include "tests/analysis/storage/system_answers.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

namespace remote_touch {

namespace {
Faults faults;
}  // namespace

FaultySystem::FaultySystem(const Faults& given) {
  faults = given;
}

FaultySystem::~FaultySystem() {
  faults = {};
}

}  // namespace remote_touch

// The functions below replace those of the C library, for all of this program.
extern "C" ssize_t write(int file, const void* data, std::size_t size) {
  auto& answers = remote_touch::faults.writes;
  if (answers.empty()) return ::syscall(SYS_write, file, data, size);
  const auto [written, error] = answers.front();
  answers.erase(answers.begin());
  errno = error;
  return written;
}

extern "C" int rename(const char* from, const char* to) noexcept {
  remote_touch::Faults& faults = remote_touch::faults;
  if (faults.failed_renames == 0 || faults.renames_before-- > 0)
    return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
  --faults.failed_renames;
  errno = faults.error_of_rename;
  return -1;
}

extern "C" int ftruncate(int file, off_t size) noexcept {
  if (!remote_touch::faults.truncations_fail) return static_cast<int>(::syscall(SYS_ftruncate, file, size));
  errno = EIO;
  return -1;
}
