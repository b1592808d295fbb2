// Passes frames from the sensor to the servo, processed and prepared, one step at a time.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/live/loop/servo.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

// Queues a frame to be recorded. Returns false if the recorder's queue is full.
using FrameSink = std::function<bool(const SensorFrame&, const Frame&, std::uint64_t fixtures_off)>;

struct CameraCounts {
  int received = 0;
  int skipped = 0;     // frame numbers that never came: not sent, or a newer frame came first
  int reversed = 0;    // not newer than the frame before; dropped
  int incomplete = 0;  // colours that the sensor's view promises are missing, or the size differs; dropped
  int held_back = 0;   // not sent, because the dead-band of frames did not let them pass
  int overtaken = 0;   // ready, but replaced by a newer one before the servo took them
  int unrecorded = 0;  // dropped, because the recorder's queue was full
  double max_pause_s = 0;
  double processing_s = 0;  // sum over the frames
};

// Returns true if a processed frame has to be sent to the servo.
using FrameChoice = std::function<bool(const Frame&)>;

// Frames that the renderer may hold are also held here until nothing else holds them, so that their memory is
// freed by the thread that calls step().
class CameraFeed {
 public:
  static constexpr const char* kEnd = "the recording has ended";
  static constexpr const char* kNoMemory = "out of memory";

  CameraFeed(std::unique_ptr<DepthSource> source, FrameProcessing processing, const Renderer& renderer,
             const RigidTransform& registration, const Clock& clock, std::int64_t start_ns,
             TripleBuffer<LiveFrame>& out, FrameSink sink, std::function<void(const Frame&)> on_frame = {},
             FrameChoice sends = {});

  // Waits at most patience_s for the next frame and passes it on. Returns false if there will be no more. It
  // checks each frame against the needs of the renderer and the rules, as FrameStream does in a simulated
  // run.
  bool step(double patience_s) noexcept;

  // Other threads may call the following functions, except sensed().
  CameraCounts counts() const;  // counts up to the newest frame
  std::string ended() const;    // reason why there are no more frames; empty while there may be more
  // True if an input error has ended the frames: a frame cannot be used, and ended() names it.
  bool has_refused() const { return refused_.load(std::memory_order_acquire); }
  // The time of the clock when the newest frame was ready, sent or not; the start of the run before the first
  // frame.
  double newest_s() const { return newest_s_.load(std::memory_order_relaxed); }
  // True if a frame was sent to the servo.
  bool has_sent() const { return has_sent_.load(std::memory_order_acquire); }
  const SensorView& view() const { return source_->view(); }
  const SensedPoints& sensed() const { return sensed_points_; }  // pre: step() is no longer called

 private:
  void handle(SensorFrame& sensed);
  bool is_newer(const SensorFrame& sensed);
  void send(Frame frame, double sensed_s);
  bool end(std::string_view why) noexcept;  // returns false

  const std::unique_ptr<DepthSource> source_;
  const FrameProcessing processing_;
  const Renderer& renderer_;
  const RigidTransform X_WC_;
  const Clock& clock_;
  const double start_s_;
  TripleBuffer<LiveFrame>& out_;
  const FrameSink sink_;
  const std::function<void(const Frame&)> on_frame_;  // called with every frame that is sent; may be empty
  const FrameChoice sends_;                           // empty: all frames are sent
  SensorFrame sensed_;
  CameraCounts counts_;
  SensedPoints sensed_points_;  // points in the frames that were sent
  mutable std::mutex reported_mutex_;
  CameraCounts reported_;  // copy of counts_, made after the newest frame
  int index_ = 0, last_number_ = -1;
  double last_captured_s_ = 0;
  std::deque<Frame> held_;
  std::atomic<double> newest_s_;
  std::string why_;
  std::atomic<bool> ended_ = false, refused_ = false, has_sent_ = false;
};

}  // namespace remote_touch
