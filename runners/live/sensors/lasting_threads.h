// Threads that end only with the process. Some libraries crash if a thread that has called them has ended.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

namespace remote_touch {

// Runs one task after another, in a thread of its own.
class LastingThread {
 public:
  // Returns when the work is done, and throws what the work throws. Only one thread may call it at a time.
  void run(const std::function<void()>& work);

 private:
  void serve(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  const std::function<void()>* work_ = nullptr;
  std::exception_ptr thrown_;
  std::jthread thread_{[this](const std::stop_token& stop) { serve(stop); }};
};

// Returns a thread for one user alone. When that user has released it, the next user gets it, so there are
// only as many threads as were ever in use at the same time. Throws std::system_error if no thread can be
// started.
std::shared_ptr<LastingThread> lasting_thread();

}  // namespace remote_touch
