#include "tests/analysis/storage/system_answers.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <iterator>

namespace remote_touch {

namespace {
using Answers = std::vector<AnswersOfWrite::Answer>;
Answers* next_answers = nullptr;  // the last is the next one
int renames_before = 0, failed_renames = 0, error_of_rename = 0;
bool truncations_fail = false;
}  // namespace

AnswersOfWrite::AnswersOfWrite(std::initializer_list<Answer> answers)
    : answers_(std::rbegin(answers), std::rend(answers)) {
  next_answers = &answers_;
}

AnswersOfWrite::~AnswersOfWrite() {
  next_answers = nullptr;
}

FailedRename::FailedRename(int calls_before, int error, int failures) {
  renames_before = calls_before, failed_renames = failures, error_of_rename = error;
}

FailedRename::~FailedRename() {
  failed_renames = 0;
}

FailedTruncation::FailedTruncation() {
  truncations_fail = true;
}

FailedTruncation::~FailedTruncation() {
  truncations_fail = false;
}

}  // namespace remote_touch

// The functions below replace those of the C library, for all of this program.
extern "C" ssize_t write(int file, const void* data, std::size_t size) {
  using remote_touch::next_answers;
  if (next_answers == nullptr || next_answers->empty()) return ::syscall(SYS_write, file, data, size);
  const auto [written, error] = next_answers->back();
  next_answers->pop_back();
  errno = error;
  return written;
}

extern "C" int rename(const char* from, const char* to) noexcept {
  using namespace remote_touch;
  if (failed_renames == 0 || renames_before-- > 0)
    return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
  --failed_renames;
  errno = error_of_rename;
  return -1;
}

extern "C" int ftruncate(int file, off_t size) noexcept {
  if (!remote_touch::truncations_fail) return static_cast<int>(::syscall(SYS_ftruncate, file, size));
  errno = EIO;
  return -1;
}
