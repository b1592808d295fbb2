#include "runners/libraries/lasting_thread.h"

#include <thread>
#include <utility>
#include <vector>

namespace remote_touch {

LastingThread::LastingThread() : shared_(std::make_shared<Shared>()) {
  // The thread is detached, because a thread that hangs can never be joined.
  std::thread([shared = shared_] { serve(shared); }).detach();
}

LastingThread::~LastingThread() {
  const std::lock_guard lock(shared_->mutex);
  shared_->is_over = true;
  shared_->changed.notify_all();
}

void LastingThread::serve(const std::shared_ptr<Shared>& shared) {
  std::unique_lock lock(shared->mutex);
  for (;;) {
    shared->changed.wait(lock, [&] { return shared->work || shared->is_over; });
    if (!shared->work) return;
    const std::function<void()> work = shared->work;
    lock.unlock();
    std::exception_ptr thrown;
    try {
      work();
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    shared->thrown = thrown;
    shared->work = nullptr;
    shared->changed.notify_all();
  }
}

bool LastingThread::run(std::function<void()> work, std::optional<std::chrono::milliseconds> limit) {
  std::unique_lock lock(shared_->mutex);
  shared_->work = std::move(work);
  shared_->changed.notify_all();
  const auto is_done = [&] { return !shared_->work; };
  if (!limit)
    shared_->changed.wait(lock, is_done);
  else if (!shared_->changed.wait_for(lock, *limit, is_done))
    return false;
  if (const std::exception_ptr thrown = std::exchange(shared_->thrown, nullptr))
    std::rethrow_exception(thrown);
  return true;
}

std::shared_ptr<LastingThread> lasting_thread() {
  struct Idle {
    std::mutex mutex;
    std::vector<std::unique_ptr<LastingThread>> threads;
  };
  static Idle& idle = *new Idle;  // never freed: its threads end with the process
  const std::lock_guard lock(idle.mutex);
  if (idle.threads.empty()) idle.threads.push_back(std::make_unique<LastingThread>());
  std::unique_ptr<LastingThread> one = std::move(idle.threads.back());
  idle.threads.pop_back();
  return {one.release(), [](LastingThread* back) {
            const std::lock_guard locked(idle.mutex);
            idle.threads.emplace_back(back);
          }};
}

}  // namespace remote_touch
