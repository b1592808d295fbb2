// Results of write(), rename() and ftruncate() in this program, which a test can set, and a full disk.
#pragma once

#include <sys/resource.h>

#include <csignal>
#include <initializer_list>
#include <vector>

namespace remote_touch {

// The first calls of write() return these answers and write nothing, until this object is destroyed. There
// may be only one object at a time, and only in a test with one thread.
class AnswersOfWrite {
 public:
  struct Answer {
    int written, error;  // error: errno after the call
  };
  AnswersOfWrite(std::initializer_list<Answer> answers);
  ~AnswersOfWrite();
  AnswersOfWrite(const AnswersOfWrite&) = delete;
  AnswersOfWrite& operator=(const AnswersOfWrite&) = delete;

 private:
  std::vector<Answer> answers_;
};

// This number of calls of rename() fail with this errno, after calls_before calls that are executed. The
// effect ends with the object.
class FailedRename {
 public:
  FailedRename(int calls_before, int error, int failures = 1);
  ~FailedRename();
  FailedRename(const FailedRename&) = delete;
  FailedRename& operator=(const FailedRename&) = delete;
};

// Every call of ftruncate() fails with EIO as long as the object exists.
class FailedTruncation {
 public:
  FailedTruncation();
  ~FailedTruncation();
  FailedTruncation(const FailedTruncation&) = delete;
  FailedTruncation& operator=(const FailedTruncation&) = delete;
};

// No file of this process can grow beyond this size as long as this object exists, as on a full disk.
class NoRoom {
 public:
  explicit NoRoom(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit less{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &less);
  }
  ~NoRoom() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }
  NoRoom(const NoRoom&) = delete;
  NoRoom& operator=(const NoRoom&) = delete;

 private:
  rlimit old_{};
  void (*handler_)(int);
};

}  // namespace remote_touch
