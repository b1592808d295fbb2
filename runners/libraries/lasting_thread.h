// Threads for calls of others' libraries, which may hang, or crash if a thread that has called them has
// ended.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

namespace remote_touch {

// Runs one task after another, in a thread of its own.
class LastingThread {
 public:
  LastingThread();
  // Does not wait for work that has missed its deadline.
  ~LastingThread();
  LastingThread(const LastingThread&) = delete;
  LastingThread& operator=(const LastingThread&) = delete;

  // Returns true when the work is done, and throws what the work throws. Returns false at the limit, if there
  // is one. Late work continues in its thread, so it must own all that it uses, and run() must not be called
  // again. Only one thread may call it at a time.
  bool run(std::function<void()> work, std::optional<std::chrono::milliseconds> limit = {});

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::function<void()> work;
    std::exception_ptr thrown;
    bool is_over = false;
  };
  static void serve(const std::shared_ptr<Shared>& shared);

  const std::shared_ptr<Shared> shared_;
};

// Returns a thread for one user alone, which ends with the process. When that user has released it, the next
// user gets it, so there are only as many threads as were ever in use at the same time. Throws
// std::system_error if no thread can be started.
std::shared_ptr<LastingThread> lasting_thread();

}  // namespace remote_touch
