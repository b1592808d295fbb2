// All parts of a live run except its threads. Each thread only repeats one of the steps below. The same
// steps, called without threads on a simulated clock, make the same run.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runners/live/loop/camera_feed.h"
#include "runners/live/loop/live_contact.h"
#include "runners/live/loop/live_log.h"
#include "runners/live/loop/live_run.h"
#include "runners/live/loop/live_slave.h"

namespace remote_touch {

// The number of points for which renderers have to reserve memory, so that no frame needs memory from the
// system. For images: the number of pixels, with width and height rounded up to multiples of 16. For clouds,
// which may grow: twice the number that the view expects, plus 256.
std::size_t expected_points(const SensorView& view);

class LiveParts {
 public:
  // The objects that are passed by reference must outlive it. Throws InputError if the arguments do not fit
  // each other, or if the recording cannot be opened.
  LiveParts(const Experiment& experiment, const LiveOptions& options, Clock& clock,
            std::unique_ptr<HapticDevice> device, std::unique_ptr<DepthSource> source);

  // Runs the haptic loop until the run ends, and then releases the device.
  void run_loop() noexcept;
  // While the loop runs, other threads must call camera().step(), heartbeat().check(), logger().step() and
  // logger().sync(). One thread must call is_over() every kReportPeriod_s, and then report_changes(), which
  // informs the user.
  CameraFeed& camera() { return *camera_; }
  Heartbeat& heartbeat() { return servo_->heartbeat(); }
  LiveLogger& logger() { return *logger_; }
  static constexpr double kReportPeriod_s = 0.01;
  // True if something other than stop() has ended the run.
  bool is_over();
  void report_changes();

  // Ends the loop.
  void stop() { stop_ = true; }
  // Any thread may call it.
  void release() noexcept { device_->release(); }
  // pre: none of the steps is called any more.
  LiveResult finish();

 private:
  std::unique_ptr<SessionRecorder> recorder(const Experiment& experiment, const SensorView& view,
                                            const RigidTransform& registered) const;
  void require_rate() const;
  LiveCounts counts() const;
  RunReport report(const LiveLog& log) const;
  std::string camera_failure() const;
  std::string why_over() const;
  std::string why_lost() const;
  std::string why_refused() const;
  std::string unusable_frame_of_hand() const;
  std::string changed_input() const;
  void report_line(const std::string& line) const;
  void report_pending_lines();
  void report_force_scale() const;
  std::string camera_trouble() const;
  std::string force_trouble() const;

  const LiveOptions& options_;
  const Clock& clock_;
  const double rate_hz_;
  std::int64_t ends_ns_ = 0;
  double force_scale_ = 1;
  std::atomic<bool> stop_ = false, loop_failed_ = false, loop_ended_ = false;
  std::exception_ptr loop_failure_;  // exception that ended the loop, for finish()
  const std::shared_ptr<FixtureSwitches> switches_;
  const std::unique_ptr<Renderer> renderer_;
  LiveSlave slave_;
  const std::unique_ptr<HapticDevice> device_;
  std::mutex pending_lines_mutex_;
  std::vector<std::string> pending_lines_;  // lines from the camera's thread, for report_changes()
  TripleBuffer<LiveFrame> frames_;
  Ring<LiveTick> rows_;
  std::unique_ptr<LiveLogger> logger_;
  std::unique_ptr<CameraFeed> camera_;
  std::unique_ptr<Servo> servo_;
  LiveContact contact_;
  const std::vector<Phase> phases_;  // see simulated_phases()
  const std::vector<Note> setting_notes_;
  std::string ended_;  // reason why the run has ended; empty: not yet
  LiveTrouble reported_;
  // The time at which report_changes() first found the device released by the heartbeat; -1 if it is not
  // released.
  std::int64_t hangs_since_ns_ = -1;
};

}  // namespace remote_touch
