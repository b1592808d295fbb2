// The record of a live run: the trace, and the times and counts of its ticks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/live/loop/camera_feed.h"
#include "runners/live/loop/samples.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

// Its memory is bounded: some hundred MB even after hours.
struct LiveLog {
  static constexpr std::size_t kMaxRows = 1'800'000;  // half an hour at 1 kHz: 0.4 GB, more with a tool

  // The first max_rows ticks. With a slave, device_force is the force that was commanded, before the gate.
  Trace trace;
  std::vector<double> row_step_s;  // LiveTick::step_s of each tick of the trace
  std::size_t max_rows = kMaxRows;
  std::int64_t ticks = 0;
  bool is_whole() const { return trace.length() == static_cast<std::size_t>(ticks); }

  Samples step_s;                     // LiveTick::step_s of every tick
  Samples interval_s;                 // time between the starts of ticks
  GreatestOfPieces pieces;            // greatest interval in each piece of the run
  Samples latency_s;                  // sensor's time stamp to the first write it affects, every frame taken
  Samples waited_s;                   // time from ready to taken, every frame taken
  std::int64_t missed_ticks = 0;      // tick numbers that were skipped
  std::int64_t exhausted_ticks = 0;   // ticks that ended before the tool came to rest
  std::int64_t zero_force_ticks = 0;  // ticks in which the gate was waiting or latched
  std::int64_t limited_ticks = 0;     // ticks in which the gate was engaged and limited force or torque
  std::int64_t contact_ticks = 0;     // ticks that touched a point, or with a force of the renderer or slave
  std::int64_t stale_ticks = 0;       // ticks before which no new frame came for stale_s
  std::int64_t reversed_frames = 0;   // frames taken although older than the one before; should be 0
  double max_force_N = 0;             // greatest force written to the device

  static constexpr double kStaleFrame_s = 0.2, kStaleFrames = 2.5;
  // Returns the time without a new frame after which the cloud is stale: 0.2 s, or 2.5 periods of a camera
  // slower than 12.5 Hz.
  static double stale_after_s(double frame_rate_hz) {
    return frame_rate_hz > 0 ? std::max(kStaleFrame_s, kStaleFrames / frame_rate_hz)  // no NaN: above 0
                             : kStaleFrame_s;
  }
  double stale_s = kStaleFrame_s;

  void append(const LiveTick& tick, double haptic_rate_hz);
  std::int64_t end_tick() const { return last_number_ + 1; }  // the number of the last tick plus 1

 private:
  std::int64_t last_number_ = -1, taken_at_ = 0;
  int last_taken_ = -1;
};

// Counts of the other parts of a live run.
struct LiveCounts {
  CameraCounts camera;
  int stalls = 0;
  std::int64_t rows_lost = 0;
};

}  // namespace remote_touch
