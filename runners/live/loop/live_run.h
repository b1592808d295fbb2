// The live loop: sensor, renderer and device in real time. runners/experiment/simulation/simulation.cpp does
// the same in simulated time.
#pragma once

#include <array>
#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/hand/teleoperation.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/loop/live_log.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

// The parts of a running live session that do not work at the moment, as texts for the user. Each text is a
// statement that is true now; it is empty if there is nothing to report.
struct LiveTrouble {
  std::string camera;  // why the scene does not change
  std::string force;   // why the device gets no force, and what the user can do

  bool operator==(const LiveTrouble&) const = default;
};

struct LiveOptions {
  std::string device = "sim:", depth = "sim:";
  double duration_s = 0;                                // 0: until stopped
  std::filesystem::path record;                         // empty: nothing is recorded
  TextAttributes provenance;                            // attributes of the recording
  double stall_s = 0.01;                                // the device is released if no tick comes for longer
  const Kernels* kernels = nullptr;                     // required
  const std::atomic<bool>* stop = nullptr;              // SIGINT and SIGTERM
  std::atomic<bool>* report = nullptr;                  // set by SIGUSR1; calls on_report and is reset
  std::atomic<bool>* rearm = nullptr;                   // set by SIGUSR2; re-arms after a latch and is reset
  std::function<void(const std::string&)> report_line;  // lines to the user while it runs
  std::function<void()> on_start;                       // device and sensor are open, and the loop begins
  // Called after the loop, before the recording is finished. It throws InputError if a file that the run has
  // read has changed meanwhile. Empty: no check.
  std::function<void()> check_inputs;
  // Report of the run so far, called from the thread that writes the recording, so that no other thread uses
  // HDF5.
  std::function<void(const LiveReport&)> on_report;
  // Called for a viewer: on_tick with every tick, in the thread that writes the recording; on_frame with
  // every frame on its way to the renderer, in the camera's thread. They must not throw.
  std::function<void(const LiveTick&)> on_tick;
  std::function<void(const Frame&)> on_frame;
  // Called in the thread of run_live() whenever the texts about what does not work have changed, also if
  // report_line is empty.
  std::function<void(const LiveTrouble&)> on_trouble;
  std::shared_ptr<HandPoses> poses;        // required by the device browser:
  std::shared_ptr<LiveControls> controls;  // must belong to the same experiment; null: nothing changes
};

struct LiveResult {
  LiveLog log;
  LiveCounts counts;
  RunReport report;        // the frames that it read, and notes; empty if the log failed
  std::string real_time;   // rights that the system granted, see become_real_time()
  std::string device;      // its name
  double force_scale = 1;  // factor on the rendered force, for the device's maximum stiffness
  std::string ended;       // reason why it ended
  bool failed = false;     // device, sensor or renderer failed, or the gate was latched at the end
  // An input error in one line: a frame does not fit the view of its sensor, the renderer or the simulated
  // hand cannot use a frame, or an input file has changed. Empty: none of these.
  std::string refused;
  std::string lost;  // why the recording or the log is not whole, or there was no memory; empty: neither
};

// Throws InputError if something cannot be opened; then no force was exerted. Throws std::runtime_error if an
// exception ended the run and a file keeps the recording; the message names the file.
LiveResult run_live(const Experiment& experiment, const LiveOptions& options);

// Watches the first contact of a live session, for a note on points that are too far apart.
class LiveContact {
 public:
  // Watches nothing if the renderer is not a ball that single points hold (RenderedContact), or if the
  // experiment has fixtures, because their regions may be larger than the ball.
  explicit LiveContact(const Experiment& experiment);

  // The camera's thread calls it with each frame that is sent to the renderer.
  void add(const Frame& frame);
  // Another thread calls it with each tick, in order. A tick whose frame is no longer kept is skipped.
  void add(const LiveTick& tick, double time_s);
  // See ContactWatch::spacing_notes(). pre: no thread calls add() any more.
  std::vector<Note> notes(const Kernels& kernels) const;

 private:
  // The number is large enough, because a tick is read within about one period of the logger after it was
  // made, and few frames come meanwhile.
  static constexpr std::size_t kKeptFrames = 8;
  struct KeptFrame {
    int index = -1;
    ContactWatch::Points points;
  };

  const double ball_radius_m_;  // 0: watches nothing
  std::mutex mutex_;            // guards the frames
  std::array<KeptFrame, kKeptFrames> frames_;
  std::size_t next_ = 0;
  bool is_over_ = false;  // the first contact is known: frames are no longer kept
  ContactWatch watch_;
};

// The slave of a live session: what it touches, why it may touch nothing, and which frames it sends. The
// slave is simulated, also behind a real hand. It touches the true surface of a simulated scene
// (Experiment::build_simulated_scene()). It has a scene of its own, because the haptic loop must not wait
// for the thread of the camera. With any other camera it moves but touches nothing.
//
// The mass of the hand is not known, whatever the section operator says, because a replay of the session has
// no operator. Passivity control then uses the published rule.
//
// The dead-band of frames needs memory and time, so the thread of the camera decides which frames are sent.
// The haptic loop passes it the positions of the slave. A recording stores which frames the renderer
// received, so a replay needs no decision.
class LiveSlave {
 public:
  // depth: the address of the sensor; kSimulatedDepth: the scenario is the camera.
  LiveSlave(const Experiment& experiment, const std::string& depth, const Kernels& kernels);
  LiveSlave(const LiveSlave&) = delete;
  LiveSlave& operator=(const LiveSlave&) = delete;

  // Returns null if there is no slave. Only the haptic loop may use the result while the run lasts.
  Teleoperation* remote() { return remote_ ? &*remote_ : nullptr; }

  // Returns a line that says why the slave cannot touch anything; empty if it can, or if there is no slave.
  const std::string& why_untouching() const { return why_; }

  // The queue for the position of the slave at every tick. Only the haptic loop may write to it. Null if
  // every frame is sent.
  Ring<SlavePlace>* places() { return places_ ? &*places_ : nullptr; }
  // Returns true if a frame that was captured has to be sent to the renderer. Only the thread of the camera
  // may call it. If no frame came for kMostPlaces ticks, the next one is sent.
  bool sends(const Frame& frame);
  static constexpr std::size_t kMostPlaces = 1 << 12;  // 4 s at 1 kHz

 private:
  const std::unique_ptr<const Scenario> touched_;
  std::optional<Teleoperation> remote_;
  FrameSender sender_;
  std::optional<Ring<SlavePlace>> places_;
  std::string why_;
};

// The number of points for which renderers have to reserve memory, so that no frame needs memory from the
// system. For images: the number of pixels, with width and height rounded up to multiples of 16. For clouds,
// which may grow: twice the number that the view expects, plus 256.
std::size_t expected_points(const SensorView& view);

// All parts of a live run except its threads. Each thread only repeats one of the steps below. The same
// steps, called without threads on a simulated clock, make the same run.
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
