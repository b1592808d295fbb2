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
int renames_before = -1, error_of_rename = 0;
}  // namespace

AnswersOfWrite::AnswersOfWrite(std::initializer_list<Answer> answers)
    : answers_(std::rbegin(answers), std::rend(answers)) {
  next_answers = &answers_;
}

AnswersOfWrite::~AnswersOfWrite() {
  next_answers = nullptr;
}

FailedRename::FailedRename(int calls_before, int error) {
  renames_before = calls_before, error_of_rename = error;
}

FailedRename::~FailedRename() {
  renames_before = -1;
}

}  // namespace remote_touch

// The two functions below replace those of the C library, for all of this program.
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
  if (renames_before-- != 0)
    return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
  errno = error_of_rename;
  return -1;
}
