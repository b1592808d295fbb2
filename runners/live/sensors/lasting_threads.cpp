#include "runners/live/sensors/lasting_threads.h"

#include <utility>
#include <vector>

namespace remote_touch {

namespace {

struct Idle {
  std::mutex mutex;
  std::vector<std::unique_ptr<LastingThread>> threads;
};

Idle& idle() {
  static Idle all;
  return all;
}

}  // namespace

void LastingThread::run(const std::function<void()>& work) {
  std::unique_lock lock(mutex_);
  work_ = &work;
  changed_.notify_all();
  changed_.wait(lock, [&] { return work_ == nullptr; });
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void LastingThread::serve(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [&] { return work_ != nullptr; })) {
    try {
      (*work_)();
    } catch (...) {
      thrown_ = std::current_exception();
    }
    work_ = nullptr;
    changed_.notify_all();
  }
}

std::shared_ptr<LastingThread> lasting_thread() {
  Idle& all = idle();
  const std::lock_guard lock(all.mutex);
  std::unique_ptr<LastingThread> one;
  if (all.threads.empty()) {
    one = std::make_unique<LastingThread>();
  } else {
    one = std::move(all.threads.back());
    all.threads.pop_back();
  }
  return {one.release(), [](LastingThread* back) {
            Idle& others = idle();
            const std::lock_guard locked(others.mutex);
            others.threads.emplace_back(back);
          }};
}

}  // namespace remote_touch
