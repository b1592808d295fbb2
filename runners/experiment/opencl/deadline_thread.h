// Work with a deadline: a driver that hangs blocks only its own thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>

namespace remote_touch {

class DeadlineThread {
 public:
  DeadlineThread();
  // Does not wait for work that has missed its deadline.
  ~DeadlineThread();
  DeadlineThread(const DeadlineThread&) = delete;
  DeadlineThread& operator=(const DeadlineThread&) = delete;

  // Returns true if the work was done in time; throws what the work throws. Late work continues in its
  // thread, so it must own all that it uses, and run() must not be called again.
  bool run(std::function<void()> work, std::chrono::milliseconds limit);

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

}  // namespace remote_touch
