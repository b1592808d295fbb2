// The record of a live run: the trace, and the times and counts of its ticks.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/live/loop/camera_feed.h"
#include "runners/live/loop/samples.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

// Its memory has a bound: after hours of running, too, some hundred MB.
struct LiveLog {
  static constexpr std::size_t kMaxRows = 1'800'000;  // half an hour at 1 kHz: 0.4 GB, more with a tool

  Trace trace;                     // of the first max_rows ticks
  std::vector<double> row_step_s;  // of its ticks: taking the frame and rendering
  std::size_t max_rows = kMaxRows;
  std::int64_t ticks = 0;
  bool is_whole() const { return trace.length() == static_cast<std::size_t>(ticks); }

  Samples step_s;                 // of every tick: taking the frame and rendering
  Samples interval_s;             // between the starts of ticks
  GreatestOfPieces pieces;        // of those, over the run
  Samples latency_s;              // of every frame taken: sensor's time stamp to the first write it counts in
  Samples waited_s;               // of every frame taken: ready to taken
  std::int64_t missed_ticks = 0;  // tick numbers that were skipped
  std::int64_t exhausted_ticks = 0;   // that ended before the tool came to rest
  std::int64_t zero_force_ticks = 0;  // in which the gate was waiting or latched
  std::int64_t contact_ticks = 0;     // in which a point was touched or the renderer's force was not zero
  std::int64_t stale_ticks = 0;       // with no new frame for kStaleFrame_s
  std::int64_t reversed_frames = 0;   // taken although older than the frame before; should be 0
  double max_force_N = 0;             // written to the device

  static constexpr double kStaleFrame_s = 0.2;

  void append(const LiveTick& tick, double haptic_rate_hz);
  std::int64_t end_tick() const { return last_number_ + 1; }  // the number of the last tick plus 1

 private:
  void add_row(const LiveTick& tick, double time_s);
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
