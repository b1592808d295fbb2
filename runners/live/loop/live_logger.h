// Collects the rows of the servo and the frames of the camera: into the log, and on disk if a session is
// recorded.
#pragma once

#include <atomic>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "runners/live/loop/live_log.h"
#include "runners/sessions/session_file.h"

namespace remote_touch {

class LiveLogger {
 public:
  // recorder: null if nothing is recorded. on_tick: gets every row; must not throw; may be empty.
  LiveLogger(Ring<LiveTick>& rows, double haptic_rate_hz, std::unique_ptr<SessionWriter> recorder,
             std::function<void(const LiveTick&)> on_tick = {});

  // Takes what has come and calls the function given to ask(); call it about every kPeriod_s.
  void step() noexcept;
  static constexpr double kPeriod_s = 0.005;
  // Takes all that is left and finishes the file. pre: the servo and the camera have stopped, and step() is
  // no longer called.
  void finish();

  // For the camera: false if kMaxFrames frames are waiting for the disk.
  bool record(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off);
  // For other threads: why nothing can be recorded or logged any more; empty: no failure.
  std::string failure() const;
  LiveLog take() { return std::move(log_); }  // after finish()
  // Calls the question once, in a step(), with the log at that time.
  void ask(std::function<void(const LiveLog&)> question);

 private:
  static constexpr std::size_t kMaxFrames = 90;
  struct Recorded {
    SensorFrame frame;
    double captured_s;
    std::uint64_t fixtures_off;
  };
  void take_all() noexcept;
  void take_rows();
  void record(const LiveTick& row);
  void take_frames();
  void answer();
  void fail(const std::exception& error);

  Ring<LiveTick>& rows_;
  const double haptic_rate_hz_;
  const std::unique_ptr<SessionWriter> recorder_;
  const std::function<void(const LiveTick&)> on_tick_;
  LiveLog log_;
  bool log_is_full_ = false;
  std::mutex question_mutex_;
  std::function<void(const LiveLog&)> question_;
  std::mutex frames_mutex_;
  std::deque<Recorded> frames_;
  std::atomic<bool> failed_ = false;
  std::string why_;
};

}  // namespace remote_touch
