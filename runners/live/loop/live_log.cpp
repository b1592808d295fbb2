#include "runners/live/loop/live_log.h"

#include <exception>
#include <new>
#include <optional>

#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/hand/simulated_hand.h"

namespace remote_touch {

void Samples::push_back(double value) {
  least_ = count_ == 0 ? value : min_or_nan(least_, value);
  greatest_ = count_ == 0 ? value : max_or_nan(greatest_, value);
  if (count_++ % stride_ != 0) return;
  if (kept_.size() == kMax) {
    for (std::size_t i = 0; i < kMax / 2; ++i) kept_[i] = kept_[2 * i];
    kept_.resize(kMax / 2);
    stride_ *= 2;
  }
  kept_.push_back(value);
}

void GreatestOfPieces::push_back(double time_s, double value) {
  if (in_last_ == 0 || in_last_ == length_) {
    if (begin_s_.size() == 2 * kPieces) join_pairs();
    begin_s_.push_back(time_s), greatest_.push_back(value);
    in_last_ = 0;
  }
  greatest_.back() = max_or_nan(greatest_.back(), value);
  ++in_last_;
}

void GreatestOfPieces::join_pairs() {
  for (std::size_t i = 0; i < kPieces; ++i) {
    begin_s_[i] = begin_s_[2 * i];
    greatest_[i] = max_or_nan(greatest_[2 * i], greatest_[2 * i + 1]);
  }
  begin_s_.resize(kPieces), greatest_.resize(kPieces);
  length_ *= 2;
}

namespace {

// Returns the hand of the simulation that replays this tick: an ideal device, which exerts what it is
// commanded to exert. A run without a slave has none.
std::optional<HandState> hand_state(const LiveTick& tick) {
  if (!tick.slave) return {};
  const DeviceState& device = tick.device;
  const Wrench wrench = exerted({}, device.orientation_W, tick.command);
  return HandState{device.position_W, device.orientation_W, wrench.force_N, wrench.torque_Nm};
}

}  // namespace

void LiveLog::append(const LiveTick& tick, double haptic_rate_hz) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (trace.length() < max_rows) {
    trace.append(static_cast<double>(tick.number) / haptic_rate_hz, tick.device, tick.out,
                 {kUnknown, kUnknown, tick.hash}, hand_state(tick), tick.slave);
    row_step_s.push_back(tick.step_s);
  }
  ++ticks;
  step_s.push_back(tick.step_s);
  if (last_number_ >= 0) {
    interval_s.push_back(tick.since_last_tick_s);
    pieces.push_back(static_cast<double>(last_number_) / haptic_rate_hz, tick.since_last_tick_s);
    missed_ticks += tick.number - last_number_ - 1;
  }
  last_number_ = tick.number;
  if (tick.taken >= 0) {
    latency_s.push_back(tick.latency_s);
    waited_s.push_back(tick.waited_s);
    reversed_frames += tick.taken <= last_taken_ ? 1 : 0;
    last_taken_ = tick.taken, taken_at_ = tick.number;
  }
  exhausted_ticks += tick.out.tool && tick.out.tool->budget_exhausted ? 1 : 0;
  zero_force_ticks += tick.gate == GateState::waiting || tick.gate == GateState::latched ? 1 : 0;
  limited_ticks += tick.is_limited ? 1 : 0;
  contact_ticks +=
      tick.out.contact_count > 0 || tick.out.force_N.norm() > 0 || tick.command.force_N.norm() > 0 ? 1 : 0;
  stale_ticks += static_cast<double>(tick.number - taken_at_) > stale_s * haptic_rate_hz ? 1 : 0;
  max_force_N = max_or_nan(max_force_N, tick.written.force_N.norm());
}

LiveLogger::LiveLogger(Ring<LiveTick>& rows, double haptic_rate_hz, std::unique_ptr<SessionRecorder> recorder,
                       std::function<void(const LiveTick&)> on_tick, double stale_after_s)
    : rows_(rows),
      haptic_rate_hz_(haptic_rate_hz),
      recorder_(std::move(recorder)),
      on_tick_(std::move(on_tick)) {
  log_.stale_s = stale_after_s;
}

bool LiveLogger::record(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off) {
  if (!recorder_) return true;
  const std::lock_guard lock(frames_mutex_);
  if (frames_.size() >= kMaxFrames) return false;
  frames_.push_back({frame, captured_s, fixtures_off});
  return true;
}

// If the recording fails, the log continues, and vice versa: each is useful without the other.
template <class Write>
void LiveLogger::record(const Write& write) {
  if (!recorder_ || recording_failed_) return;
  try {
    if (sync_failed_.load(std::memory_order_acquire)) throw InputError(why_no_sync_);
    write(*recorder_);
  } catch (const std::exception& error) {
    recording_failed_ = true;
    const bool no_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    const std::string kept = recorder_->keep();
    fail(std::string("the recording failed: ") + (no_memory ? "out of memory" : error.what()) +
         (kept.empty() ? "" : "; ") + kept);
  }
}

void LiveLogger::append_to_log(const LiveTick& row) {
  if (log_failed_) return;
  try {
    log_.append(row, haptic_rate_hz_);
  } catch (const std::exception& error) {
    log_failed_ = true;
    log_ = LiveLog();  // its columns may differ in length: half a row would be worse than none
    const bool no_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    fail(std::string("the log failed: ") + (no_memory ? "no memory for more ticks" : error.what()));
  }
}

void LiveLogger::take_rows() {
  while (const LiveTick* row = rows_.oldest()) {
    if (on_tick_) on_tick_(*row);
    record([&](SessionRecorder& recorder) {
      for (const ParameterChange& change : row->changed.all())
        recorder.append(
            SessionChange{static_cast<std::uint64_t>(row->number), change.parameter, change.value});
      recorder.append(
          SessionTick{row->number, row->device, row->taken, row->written, static_cast<int>(row->gate)});
    });
    append_to_log(*row);
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
    record([&](SessionRecorder& recorder) {
      recorder.append(oldest.frame, oldest.captured_s, oldest.fixtures_off);
    });
    take_rows();  // a frame takes a while to be written
  }
}

void LiveLogger::take_all() {
  take_rows();
  take_frames();
}

void LiveLogger::step() noexcept {
  take_all();
  try {
    answer();
  } catch (const std::exception&) {
    // A report is skipped if there is no memory for it: the run is more important.
  }
}

void LiveLogger::sync() noexcept {
  if (!recorder_ || failed_.load(std::memory_order_acquire) || sync_failed_) return;
  try {
    recorder_->sync();
  } catch (const std::exception& error) {
    why_no_sync_ = error.what();
    sync_failed_.store(true, std::memory_order_release);
  }
}

void LiveLogger::finish(const std::function<TextAttributes(const LiveLog&)>& closing) {
  take_all();
  const TextAttributes attributes = closing && !log_failed_ ? closing(log_) : TextAttributes();
  record([&](SessionRecorder& recorder) { recorder.finish(attributes); });
  if (!second_failure_.empty()) why_ += "; " + second_failure_;
}

std::string LiveLogger::keep() {
  take_all();
  return recorder_ ? recorder_->keep() : std::string();
}

// Writes why_ only once, because other threads may be reading it.
void LiveLogger::fail(const std::string& why) {
  if (failed_) {
    second_failure_ = why;
    return;
  }
  why_ = why;
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
