// Results of write(), rename() and ftruncate() in this program, which a test can set, and a full disk.
#pragma once

#include <sys/resource.h>

#include <csignal>
#include <vector>

namespace remote_touch {

struct Faults {
  struct Answer {
    int written, error;  // error: errno after the call
  };
  std::vector<Answer> writes = {};  // answers of the first calls of write(), which write nothing
  // This number of calls of rename() fail with this errno, after renames_before calls that are executed.
  int renames_before = 0, failed_renames = 0, error_of_rename = 0;
  bool truncations_fail = false;  // the error is EIO
};

// The system has these faults until this object is destroyed. There may be only one object at a time, and
// only in a test with one thread.
class FaultySystem {
 public:
  explicit FaultySystem(const Faults& faults);
  ~FaultySystem();
  FaultySystem(const FaultySystem&) = delete;
  FaultySystem& operator=(const FaultySystem&) = delete;
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
