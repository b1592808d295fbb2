// Collects the rows of the servo and the frames of the camera: into the log, and on disk if a session is
// recorded.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "runners/live/loop/live_log.h"
#include "runners/sessions/session_recorder.h"

namespace remote_touch {

class LiveLogger {
 public:
  // recorder: null if nothing is recorded. on_tick: gets every row; must not throw; may be empty.
  LiveLogger(Ring<LiveTick>& rows, double haptic_rate_hz, std::unique_ptr<SessionRecorder> recorder,
             std::function<void(const LiveTick&)> on_tick = {});

  // Takes what has come and calls the function given to ask(); call it about every kPeriod_s.
  void step() noexcept;
  static constexpr double kPeriod_s = 0.005;
  // Makes what was recorded until now outlast a power cut. Call it about every kSyncPeriod_s, from a thread
  // of its own, because a disk may take seconds.
  void sync() noexcept;
  static constexpr double kSyncPeriod_s = 1;
  // Takes all that is left and finishes the file. closing: gets the whole log, unless that failed, and
  // returns attributes of the file that are known at the end only. pre: the servo and the camera have
  // stopped, and step() and sync() are no longer called.
  void finish(const std::function<TextAttributes(const LiveLog&)>& closing = {});

  // Writes all that is left of a run that an exception ends, in place of finish(). Returns a line on the file
  // that keeps it; empty: nothing was recorded. pre: as finish().
  std::string keep();

  // For the camera: false if kMaxFrames frames are waiting for the disk.
  bool record(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off);
  // The reason why nothing can be recorded or logged any more, and the file that keeps what was recorded;
  // empty: no failure. Other threads may call it.
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
  void take_all();
  void take_rows();
  void take_frames();
  template <class Write>
  void record(const Write& write);
  void append_to_log(const LiveTick& row);
  void answer();
  void fail(const std::string& why);

  Ring<LiveTick>& rows_;
  const double haptic_rate_hz_;
  const std::unique_ptr<SessionRecorder> recorder_;
  const std::function<void(const LiveTick&)> on_tick_;
  LiveLog log_;
  bool log_failed_ = false, recording_failed_ = false;
  std::mutex question_mutex_;
  std::function<void(const LiveLog&)> question_;
  std::mutex frames_mutex_;
  std::deque<Recorded> frames_;
  std::atomic<bool> failed_ = false, sync_failed_ = false;
  std::string why_, why_too_;  // the first failure, and the one after it
  std::string why_no_sync_;
};

}  // namespace remote_touch
