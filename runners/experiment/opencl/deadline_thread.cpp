#include "runners/experiment/opencl/deadline_thread.h"

#include <thread>
#include <utility>

namespace remote_touch {

DeadlineThread::DeadlineThread() : shared_(std::make_shared<Shared>()) {
  // The thread is detached, because a thread that hangs can never be joined.
  std::thread([shared = shared_] { serve(shared); }).detach();
}

DeadlineThread::~DeadlineThread() {
  const std::lock_guard lock(shared_->mutex);
  shared_->is_over = true;
  shared_->changed.notify_all();
}

void DeadlineThread::serve(const std::shared_ptr<Shared>& shared) {
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

bool DeadlineThread::run(std::function<void()> work, std::chrono::milliseconds limit) {
  std::unique_lock lock(shared_->mutex);
  shared_->work = std::move(work);
  shared_->changed.notify_all();
  if (!shared_->changed.wait_for(lock, limit, [&] { return !shared_->work; })) return false;
  if (const std::exception_ptr thrown = std::exchange(shared_->thrown, nullptr))
    std::rethrow_exception(thrown);
  return true;
}

}  // namespace remote_touch
