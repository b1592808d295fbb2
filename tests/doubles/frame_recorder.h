// Keeps the frames that it receives, and the frames that a stream delivers in a run.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "runners/experiment/catalog/frame_stream.h"

namespace remote_touch {

class FrameRecorder final : public FrameReceiver {
 public:
  void on_frame(const Frame& frame) override { frames.push_back(frame); }
  std::vector<Frame> frames;
};

// Returns the frames that arrive up to a time. The stream is polled every millisecond, as in a run.
inline std::vector<Frame> received(FrameStream& stream, double until_s) {
  FrameRecorder recorder;
  for (int tick = 0; 0.001 * tick <= until_s; ++tick) {
    const double now_s = 0.001 * tick;
    const std::size_t before = recorder.frames.size();
    stream.deliver_until(now_s, recorder);
    for (std::size_t i = before; i < recorder.frames.size(); ++i) {
      // A frame is delivered in the tick in which it arrives, neither before nor after.
      EXPECT_LE(recorder.frames[i].arrives_s, now_s + kSameTime_s);
      EXPECT_GT(recorder.frames[i].arrives_s, now_s - 0.001 - kSameTime_s);
    }
  }
  return recorder.frames;
}

}  // namespace remote_touch
