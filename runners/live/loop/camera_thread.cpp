#include "runners/live/loop/camera_thread.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "runners/live/sensors/sensor_cloud.h"
#include "runners/live/timing/steady_clock.h"

namespace remote_touch {

namespace {

constexpr double kPatience_s = 0.05;  // a stop is noticed in that time

bool is_complete(const SensorFrame& frame, const SensorView& view) {
  const std::size_t pixels =
      static_cast<std::size_t>(view.camera.width) * static_cast<std::size_t>(view.camera.height);
  return frame.depth.size() == pixels && (!view.has_colour || frame.colour.size() == pixels);
}

}  // namespace

CameraThread::CameraThread(std::unique_ptr<DepthSource> source, FrameProcessing processing,
                           const Renderer& renderer, const RigidTransform& registration, double start_s,
                           TripleBuffer<LiveFrame>& out, FrameSink sink)
    : source_(std::move(source)),
      processing_(std::move(processing)),
      renderer_(renderer),
      X_WC_(registration * source_->view().X_WC),
      start_s_(start_s),
      out_(out),
      sink_(std::move(sink)),
      newest_s_(start_s) {}

CameraThread::~CameraThread() {
  stop();
}

void CameraThread::start() {
  thread_ = std::thread([this] { run(); });
}

void CameraThread::stop() {
  stop_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

std::string CameraThread::ended() const {
  return ended_.load(std::memory_order_acquire) ? why_ : std::string();
}

void CameraThread::end(std::string why) {
  why_ = std::move(why);
  ended_.store(true, std::memory_order_release);
}

CameraCounts CameraThread::counts() const {
  const std::lock_guard lock(reported_mutex_);
  return reported_;
}

void CameraThread::run() try {
  SensorFrame sensed;
  while (!stop_.load(std::memory_order_relaxed)) switch (source_->next(sensed, kPatience_s)) {
      case SensorState::frame: {
        handle(sensed);
        const std::lock_guard lock(reported_mutex_);
        reported_ = counts_;
        break;
      }
      case SensorState::waiting:
        break;
      case SensorState::ended:
        return end(kEnd);
      case SensorState::failed:
        return end(source_->failure());
    }
} catch (const std::exception& error) {
  end(error.what());
} catch (...) {
  end("an unknown error");
}

bool CameraThread::is_newer(const SensorFrame& sensed) {
  const bool newer =
      counts_.received == 1 || (sensed.number > last_number_ && sensed.captured_s > last_captured_s_);
  if (!newer) return false;
  if (counts_.received > 1) {
    counts_.passed_over += sensed.number - last_number_ - 1;
    counts_.max_pause_s = std::max(counts_.max_pause_s, sensed.captured_s - last_captured_s_);
  }
  last_number_ = sensed.number, last_captured_s_ = sensed.captured_s;
  return true;
}

void CameraThread::handle(SensorFrame& sensed) {
  ++counts_.received;
  if (!is_newer(sensed)) {
    ++counts_.reversed;
    return;
  }
  if (!is_complete(sensed, source_->view())) {
    ++counts_.incomplete;
    return;
  }
  const double begin_s = steady_s();
  Frame frame;
  frame.index = index_;
  frame.captured_s = sensed.captured_s - start_s_;
  const std::uint64_t off = processing_.fixtures.off();
  if (sink_ && !sink_(sensed, frame, off)) {
    ++counts_.unrecorded;
    return;
  }
  ++index_;
  processing_.fill(frame, cloud_of(sensed, source_->view(), X_WC_), off);
  renderer_.prepare(frame);
  send(std::move(frame), sensed.captured_s);
  counts_.processing_s += steady_s() - begin_s;
}

void CameraThread::send(Frame frame, double sensed_s) {
  std::erase_if(retained_frames_, [](const Frame& old) {
    return old.points.use_count() == 1 && (!old.prepared || old.prepared.use_count() == 1);
  });
  retained_frames_.push_back(frame);
  const std::uint64_t hash =
      frame_hash(dynamic_cast<const CloudSearch&>(*frame.points).cloud(), frame.captured_s);
  const double ready_s = steady_s();
  out_.back() = {std::move(frame), sensed_s, ready_s, hash};
  if (!out_.publish()) ++counts_.overtaken;
  newest_s_.store(ready_s, std::memory_order_relaxed);
}

}  // namespace remote_touch
