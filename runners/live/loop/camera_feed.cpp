#include "runners/live/loop/camera_feed.h"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

// Memory for the reason of the end, reserved at the start: the reason may be that there is no more memory.
constexpr std::size_t kReservedForReason = 256;

}  // namespace

CameraFeed::CameraFeed(std::unique_ptr<DepthSource> source, FrameProcessing processing,
                       const Renderer& renderer, const RigidTransform& registration, const Clock& clock,
                       std::int64_t start_ns, TripleBuffer<LiveFrame>& out, FrameSink sink,
                       std::function<void(const Frame&)> on_frame, FrameChoice sends)
    : source_(std::move(source)),
      processing_(std::move(processing)),
      renderer_(renderer),
      X_WC_(registration * source_->view().X_WC),
      clock_(clock),
      start_s_(1e-9 * static_cast<double>(start_ns)),
      out_(out),
      sink_(std::move(sink)),
      on_frame_(std::move(on_frame)),
      sends_(std::move(sends)),
      newest_s_(start_s_) {
  why_.reserve(kReservedForReason);
}

std::string CameraFeed::ended() const {
  return ended_.load(std::memory_order_acquire) ? why_ : std::string();
}

// A reason that needs more memory than there is is cut off: an exception would end the program before the
// loop has released the device.
bool CameraFeed::end(std::string_view why) noexcept {
  try {
    why_ = why;
  } catch (const std::bad_alloc&) {
    why_ = why.substr(0, why_.capacity());
  }
  ended_.store(true, std::memory_order_release);
  return false;
}

CameraCounts CameraFeed::counts() const {
  const std::lock_guard lock(reported_mutex_);
  return reported_;
}

bool CameraFeed::step(double patience_s) noexcept try {
  if (ended_) return false;
  switch (source_->next(sensed_, patience_s)) {
    case SensorState::frame: {
      handle(sensed_);
      const std::lock_guard lock(reported_mutex_);
      reported_ = counts_;
      return true;
    }
    case SensorState::waiting:
      return true;
    case SensorState::ended:
      return end(kEnd);
    case SensorState::failed:
      return end(source_->failure());
  }
  return true;
} catch (const InputError& error) {
  end(error.what());
  refused_.store(true, std::memory_order_release);
  return false;
} catch (const std::bad_alloc&) {
  return end(kNoMemory);
} catch (const std::exception& error) {
  return end(error.what());
} catch (...) {
  return end("an unknown error");
}

bool CameraFeed::is_newer(const SensorFrame& sensed) {
  const bool newer =
      counts_.received == 1 || (sensed.number > last_number_ && sensed.captured_s > last_captured_s_);
  if (!newer) return false;
  if (counts_.received > 1) {
    counts_.skipped += sensed.number - last_number_ - 1;
    counts_.max_pause_s = std::max(counts_.max_pause_s, sensed.captured_s - last_captured_s_);  // no NaN
  }
  last_number_ = sensed.number, last_captured_s_ = sensed.captured_s;
  return true;
}

void CameraFeed::handle(SensorFrame& sensed) {
  ++counts_.received;
  if (!is_newer(sensed)) {
    ++counts_.reversed;
    return;
  }
  if (!is_complete(sensed, source_->view())) {
    ++counts_.incomplete;
    return;
  }
  const double begin_s = clock_.now_s();
  Frame frame;
  frame.index = index_;
  frame.captured_s = sensed.captured_s - start_s_;
  const std::uint64_t off = processing_.fixtures.off();
  if (sink_ && !sink_(sensed, frame, off)) {
    ++counts_.unrecorded;
    return;
  }
  ++index_;
  processing_.fill(frame, sensed, source_->view(), X_WC_, off);
  processing_.needs.check(frame);
  if (sends_ && !sends_(frame)) {
    ++counts_.held_back;
    newest_s_.store(clock_.now_s(), std::memory_order_relaxed);
  } else {
    renderer_.prepare(frame);
    send(std::move(frame), sensed.captured_s);
  }
  counts_.processing_s += clock_.now_s() - begin_s;
  sensed_points_.add(sensed, source_->view());  // done after the frame was sent, so as not to delay it
}

void CameraFeed::send(Frame frame, double sensed_s) {
  std::erase_if(held_, [](const Frame& old) {
    return old.points.use_count() == 1 && (!old.prepared || old.prepared.use_count() == 1);
  });
  held_.push_back(frame);
  if (on_frame_) on_frame_(frame);
  const std::uint64_t hash = frame_hash(*frame.points->stored_cloud(), frame.captured_s);
  const double ready_s = clock_.now_s();
  out_.back() = {std::move(frame), sensed_s, ready_s, hash};
  if (!out_.publish()) ++counts_.overtaken;
  newest_s_.store(ready_s, std::memory_order_relaxed);
  has_sent_.store(true, std::memory_order_release);
}

}  // namespace remote_touch
