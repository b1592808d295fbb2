#include "runners/live/loop/live_run.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <limits>
#include <memory>
#include <thread>
#include <utility>

#include "core/kernels/isa.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/loop/live_logger.h"
#include "runners/live/sensors/sensor_table.h"
#include "runners/live/timing/real_time.h"
#include "runners/live/timing/steady_clock.h"

namespace remote_touch {

namespace {

constexpr double kStall_s = 0.01;       // without a tick for that long the device is let go
constexpr std::size_t kRows = 1 << 14;  // 16 s at 1 kHz until rows are lost
constexpr auto kPollPeriod = std::chrono::milliseconds(10);
constexpr auto kMaxStop = std::chrono::seconds(2);

std::size_t padded(int side_px) {
  return (static_cast<std::size_t>(side_px) + 15) / 16 * 16;
}

// Everything of a run, in the order in which it has to outlive each other.
class LiveRun {
 public:
  LiveRun(const Experiment& experiment, const LiveOptions& options)
      : options_(options),
        kernels_(options.kernels ? *options.kernels : kernels_for(best_isa())),
        rate_hz_(experiment.settings().haptic_rate_hz),
        switches_(std::make_shared<FixtureSwitches>()),
        renderer_(experiment.build_renderer(kernels_, switches_)),
        device_(open_device(options.device, experiment, kernels_)),
        source_(open_sensor(options.depth, experiment, kernels_)),
        rows_(kRows) {
    require_rate();
    const SensorView& view = source_->view();
    renderer_->reserve(padded(view.camera.width) * padded(view.camera.height));
    const RigidTransform registration = camera_registration(experiment.live());
    logger_ = std::make_unique<LiveLogger>(rows_, rate_hz_, recorder(view, registration));
    start_s_ = steady_s();
    const auto sink = [this](const SensorFrame& sensed, const Frame& frame, std::uint64_t off) {
      return logger_->record(sensed, frame.captured_s, off);
    };
    camera_ =
        std::make_unique<CameraThread>(std::move(source_), experiment.build_processing(kernels_, switches_),
                                       *renderer_, registration, start_s_, frames_, sink);
    force_scale_ = force_scale(experiment.max_stiffness_N_per_m(), experiment.live().device_scale,
                               device_->traits().max_stiffness_N_per_m);
    servo_ = std::make_unique<Servo>(
        ServoLinks{*device_, *renderer_, frames_, rows_, stop_, options.stop, ends_s()},
        DevicePlacement(experiment.live(), force_scale_), limits_for(experiment.safety(), device_->traits()),
        rate_hz_, start_s_, kStall_s);
  }

  LiveResult run() {
    LiveResult result;
    result.device = device_->traits().name;
    result.force_scale = force_scale_;
    if (force_scale_ < 1) report_force_scale();
    camera_->start();
    std::promise<void> done;
    const std::future<void> is_done = done.get_future();
    std::thread loop([&] {
      run_device(result.real_time);
      done.set_value();
    });
    try {
      result.ended = wait();
    } catch (...) {  // no memory for a line to the user: a loop that is not waited for would end the program
      stop_ = true;
      device_->release();
      loop.join();
      throw;
    }
    stop_ = true;
    if (is_done.wait_for(kMaxStop) != std::future_status::ready) give_up();
    loop.join();
    camera_->stop();
    logger_->finish();
    if (const std::string why = logger_->failure(); !why.empty()) result.ended = why;
    result.failed = servo_->has_failed() || servo_->is_latched() || !camera_failure().empty() ||
                    !logger_->failure().empty() || loop_failed_;
    result.log = logger_->take();
    result.counts = counts();
    return result;
  }

 private:
  double ends_s() const {
    return options_.duration_s > 0 ? start_s_ + options_.duration_s : std::numeric_limits<double>::infinity();
  }

  void run_device(std::string& real_time) noexcept {
    try {
      real_time = become_real_time();
      device_->run(*servo_);
    } catch (...) {
      loop_failed_ = true;
    }
    device_->release();
  }

  std::unique_ptr<SessionWriter> recorder(const SensorView& view, const RigidTransform& registration) const {
    if (options_.record.empty()) return nullptr;
    return std::make_unique<SessionWriter>(options_.record, view, registration * view.X_WC,
                                           options_.provenance);
  }

  // Ticks are numbered in steps of the experiment's rate: of a faster loop time would run ahead.
  void require_rate() const {
    const double device_hz = device_->traits().tick_rate_hz;
    if (std::abs(device_hz - rate_hz_) > 0.01 * rate_hz_)
      throw InputError("haptic_rate_hz = " + std::to_string(rate_hz_),
                       "expected " + std::to_string(device_hz) + ", the rate of this device's loop");
  }

  LiveCounts counts() const { return {camera_->counts(), servo_->stalls(), servo_->rows_lost()}; }

  std::string camera_failure() const {
    const std::string why = camera_->ended();
    return why == CameraThread::kEnd ? std::string() : why;
  }

  // Why the run is over; empty while it is not.
  std::string over() const {
    if (options_.stop && *options_.stop) return "stopped by a signal";
    if (servo_->has_failed()) return std::string("the device failed: ") + servo_->trouble();
    if (loop_failed_) return "the device's loop failed";
    if (const std::string why = logger_->failure(); !why.empty()) return why;
    if (options_.duration_s > 0 && steady_s() - start_s_ >= options_.duration_s)
      return "its duration is over";
    return {};
  }

  std::string wait() {
    for (;;) {
      if (std::string why = over(); !why.empty()) return why;
      report_changes();
      std::this_thread::sleep_for(kPollPeriod);
    }
  }

  void report_line(const std::string& line) const {
    if (options_.report_line) options_.report_line(line);
  }

  void report_force_scale() const {
    char line[160];
    std::snprintf(line, sizeof line,
                  "the maximum stiffness of the device is %.4g N/m: forces and torques are scaled by %.3g",
                  device_->traits().max_stiffness_N_per_m, force_scale_);
    report_line(line);
  }

  void report_changes() {
    if (!reported_camera_ && !camera_->ended().empty()) {
      reported_camera_ = true;
      report_line("no more frames (" + camera_->ended() + "): the last cloud stays");
    }
    const bool stale = steady_s() - camera_->newest_s() > LiveLog::kStaleFrame_s;
    if (stale != reported_stale_ && !reported_camera_) {
      reported_stale_ = stale;
      report_line(stale ? "no frame for 0.2 s: the last cloud stays" : "frames come again");
    }
    if (servo_->is_latched() != reported_latch_) {
      reported_latch_ = !reported_latch_;
      report_line(reported_latch_ ? std::string("force is off: ") + servo_->trouble() + "; SIGUSR2 re-arms"
                                  : std::string("armed again"));
    }
    if (options_.rearm && options_.rearm->exchange(false)) servo_->rearm();
    if (options_.report && options_.report->exchange(false) && options_.on_report)
      logger_->ask([this](const LiveLog& log) { options_.on_report(live_report(log, counts())); });
  }

  // The vendor's call does not come back, and neither would a join.
  [[noreturn]] void give_up() {
    device_->release();
    camera_->stop();
    logger_->finish();  // what was recorded until then is whole
    std::fputs("remote-touch: the loop of the device does not end; the device was released\n", stderr);
    std::_Exit(1);
  }

  const LiveOptions& options_;
  const Kernels& kernels_;
  const double rate_hz_;
  double start_s_ = 0, force_scale_ = 1;
  std::atomic<bool> stop_ = false, loop_failed_ = false;
  const std::shared_ptr<FixtureSwitches> switches_;
  const std::unique_ptr<Renderer> renderer_;
  const std::unique_ptr<HapticDevice> device_;
  std::unique_ptr<DepthSource> source_;  // until the camera thread has it
  TripleBuffer<LiveFrame> frames_;
  Ring<LiveTick> rows_;
  std::unique_ptr<LiveLogger> logger_;
  std::unique_ptr<CameraThread> camera_;
  std::unique_ptr<Servo> servo_;
  bool reported_camera_ = false, reported_stale_ = false, reported_latch_ = false;
};

}  // namespace

LiveResult run_live(const Experiment& experiment, const LiveOptions& options) {
  return LiveRun(experiment, options).run();
}

}  // namespace remote_touch
