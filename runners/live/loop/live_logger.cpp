#include "runners/live/loop/live_logger.h"

#include <exception>
#include <new>
#include <utility>

namespace remote_touch {

LiveLogger::LiveLogger(Ring<LiveTick>& rows, double haptic_rate_hz, std::unique_ptr<SessionWriter> recorder,
                       std::function<void(const LiveTick&)> on_tick)
    : rows_(rows),
      haptic_rate_hz_(haptic_rate_hz),
      recorder_(std::move(recorder)),
      on_tick_(std::move(on_tick)) {}

bool LiveLogger::record(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off) {
  if (!recorder_) return true;
  const std::lock_guard lock(frames_mutex_);
  if (frames_.size() >= kMaxFrames) return false;
  frames_.push_back({frame, captured_s, fixtures_off});
  return true;
}

void LiveLogger::take_rows() {
  while (const LiveTick* row = rows_.oldest()) {
    if (on_tick_) on_tick_(*row);
    if (recorder_ && !failed_) record(*row);
    if (!log_is_full_) {
      log_is_full_ = true;  // unless this succeeds: half a row would be worse than none
      log_.append(*row, haptic_rate_hz_);
      log_is_full_ = false;
    }
    rows_.pop();
  }
}

void LiveLogger::take_frames() {
  for (;;) {
    std::unique_lock lock(frames_mutex_);
    if (frames_.empty()) return;
    const Recorded oldest = std::move(frames_.front());
    frames_.pop_front();
    lock.unlock();
    if (!failed_) recorder_->append(oldest.frame, oldest.captured_s, oldest.fixtures_off);
    take_rows();  // a frame takes a while to be written
  }
}

void LiveLogger::record(const LiveTick& row) {
  recorder_->append(SessionTick{row.number, row.device, row.taken, row.written, static_cast<int>(row.gate)});
  for (const ParameterChange& change : row.changed.all())
    recorder_->append(SessionChange{static_cast<std::uint64_t>(row.number), change.parameter, change.value});
}

// Where the disk is full it goes on without it, so that the log is whole.
void LiveLogger::take_all() noexcept try {
  take_rows();
  take_frames();
} catch (const std::exception& error) {
  fail(error);
}

void LiveLogger::step() noexcept {
  take_all();
  try {
    answer();
  } catch (const std::exception&) {
    // No memory for a report: the run is more important.
  }
}

// The log is worth having even where the disk is full.
void LiveLogger::finish() try {
  take_all();
  if (recorder_ && !failed_) recorder_->finish();
} catch (const std::exception& error) {
  fail(error);
}

// Told once: others may be reading it.
void LiveLogger::fail(const std::exception& error) {
  if (failed_) return;
  if (log_is_full_) {
    log_ = LiveLog();  // its columns may differ in length
    why_ = "the log failed: no memory for more ticks";
  } else {
    const bool no_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    why_ = std::string("the recording failed: ") + (no_memory ? "out of memory" : error.what());
  }
  failed_.store(true, std::memory_order_release);
}

std::string LiveLogger::failure() const {
  return failed_.load(std::memory_order_acquire) ? why_ : std::string();
}

void LiveLogger::ask(std::function<void(const LiveLog&)> question) {
  const std::lock_guard lock(question_mutex_);
  question_ = std::move(question);
}

void LiveLogger::answer() {
  std::function<void(const LiveLog&)> question;
  {
    const std::lock_guard lock(question_mutex_);
    std::swap(question, question_);
  }
  if (question) question(log_);
}

}  // namespace remote_touch
