// Collects the rows of the servo in the log. If a session is recorded, it also writes the rows and the frames
// of the camera to disk.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "runners/experiment/sessions/session_recorder.h"
#include "runners/live/loop/live_log.h"

namespace remote_touch {

class LiveLogger {
 public:
  // recorder: null if nothing is recorded. on_tick: receives every row; must not throw; may be empty.
  // stale_after_s: see LiveLog.
  LiveLogger(Ring<LiveTick>& rows, double haptic_rate_hz, std::unique_ptr<SessionRecorder> recorder,
             std::function<void(const LiveTick&)> on_tick = {},
             double stale_after_s = LiveLog::kStaleFrame_s);

  // Processes all rows and frames that have arrived, and calls the function given to ask(). Call it about
  // every kPeriod_s.
  void step() noexcept;
  static constexpr double kPeriod_s = 0.005;
  // Makes everything that was written until now survive a power cut. Call it about every kSyncPeriod_s, from
  // a thread of its own, because a disk may need seconds.
  void sync() noexcept;
  static constexpr double kSyncPeriod_s = 1;
  // Processes all that is left and finishes the file. closing: receives the whole log, and returns the
  // attributes of the file that are known only at the end. It is not called if the log failed. pre: the servo
  // and the camera have stopped, and step() and sync() are no longer called.
  void finish(const std::function<TextAttributes(const LiveLog&)>& closing = {});

  // Writes all that is left of the recording. Call it instead of finish() if an exception ends the run.
  // Returns a line on the file that keeps the recording; empty if nothing was recorded. pre: as for finish().
  std::string keep();

  // Queues a frame of the camera. Returns false if kMaxFrames frames are waiting for the disk.
  bool record(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off);
  // Returns the reason why the recording or the log has failed, and the file that keeps what was recorded;
  // empty if neither has failed. Other threads may call it.
  std::string failure() const;
  LiveLog take() { return std::move(log_); }  // pre: finish() was called
  // Calls the question once, in the next step(), with the log at that time. A question that waits is
  // replaced.
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
  std::string why_, second_failure_;  // the first failure, and the one after it
  std::string why_no_sync_;
};

}  // namespace remote_touch
