#include "runners/live/loop/live_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <future>
#include <limits>
#include <new>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/sensors/sensor_table.h"

namespace remote_touch {
namespace {

constexpr double kPatience_s = 0.05;         // the camera's thread notices an end within this time
constexpr double kSyncCheckPeriod_s = 0.02;  // the thread that syncs the disk notices an end within this time
constexpr auto kMaxStop = std::chrono::seconds(2);

// Returns a thread that calls step every period_s. Its destructor ends it and waits for the end.
std::jthread repeat(Clock& clock, double period_s, std::function<void()> step) {
  return std::jthread([&clock, period_s, step = std::move(step)](const std::stop_token& stop) {
    for (; !stop.stop_requested(); clock.sleep_s(period_s)) step();
  });
}

// A live loop uses frames when they come.
void refuse_simulated_transport(const Transport& transport) {
  const std::pair<const char*, double> settings[] = {{"frame_latency_s", transport.latency_s},
                                                     {"frame_jitter_s", transport.jitter_s},
                                                     {"frame_drop_probability", transport.drop_probability}};
  for (const auto& [name, value] : settings)
    if (value > 0)
      throw InputError(std::string(name) + " = " + std::to_string(value),
                       "expected 0 in a live session, which uses each frame when the camera has sent it");
}

// The threads of a run.
class LiveThreads {
 public:
  LiveThreads(LiveParts& parts, Clock& clock) : parts_(parts), clock_(clock) {
    watch_ = std::jthread([this](const std::stop_token& stop) {
      outrank_the_loop();
      for (; !stop.stop_requested(); clock_.sleep_s(parts_.heartbeat().period_s()))
        parts_.heartbeat().check(clock_.now_ns());
    });
    logger_ = repeat(clock, LiveLogger::kPeriod_s, [this] { parts_.logger().step(); });
    sync_ = repeat(clock, kSyncCheckPeriod_s,
                   [this, next_s = clock.now_s() + LiveLogger::kSyncPeriod_s]() mutable {
                     if (clock_.now_s() < next_s) return;
                     parts_.logger().sync();
                     next_s = clock_.now_s() + LiveLogger::kSyncPeriod_s;
                   });
    camera_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested() && parts_.camera().step(kPatience_s)) continue;
    });
    is_done_ = done_.get_future();
    loop_ = std::thread([this] {
      real_time_ = become_real_time();
      parts_.run_loop();
      done_.set_value();
    });
  }
  // Ends the loop if an exception leaves the main thread's part. The destructor of a thread that was not
  // joined would end the program. If the loop does not end either, the program ends as in finish(), and the
  // text of the exception is lost: without that it would wait for ever.
  ~LiveThreads() {
    if (!loop_.joinable()) return;
    parts_.stop();
    parts_.release();
    if (is_done_.wait_for(kMaxStop) != std::future_status::ready) give_up();
    loop_.join();
  }

  // Ends the threads. Returns the rights that the system granted to the loop, see become_real_time(). Ends
  // the program if the loop does not end within kMaxStop.
  std::string finish() {
    parts_.stop();
    if (is_done_.wait_for(kMaxStop) != std::future_status::ready) give_up();
    loop_.join();
    end(camera_), end(logger_), end(sync_), end(watch_);
    return std::move(real_time_);
  }

 private:
  static void end(std::jthread& thread) {
    thread.request_stop();
    thread.join();
  }
  // Ends the program: the vendor's call does not return, so a join would not return either.
  [[noreturn]] void give_up() {
    parts_.release();
    end(camera_), end(logger_), end(sync_);
    parts_.logger().finish([](const LiveLog&) {
      return TextAttributes{{"ended", "the loop of the device does not end"}};
    });
    const std::string failure = parts_.logger().failure();
    std::fprintf(stderr, "remote-touch: the loop of the device does not end; the device was released%s%s\n",
                 failure.empty() ? "" : "; ", failure.c_str());
    std::_Exit(1);
  }

  LiveParts& parts_;
  Clock& clock_;
  std::string real_time_;
  std::promise<void> done_;
  std::future<void> is_done_;
  std::jthread watch_, logger_, sync_, camera_;  // these end after the loop
  std::thread loop_;
};

LiveResult run_parts(LiveParts& parts, const LiveOptions& options, Clock& clock) {
  if (options.on_start) options.on_start();
  std::string real_time;
  {
    LiveThreads threads(parts, clock);
    for (; !parts.is_over(); clock.sleep_s(LiveParts::kReportPeriod_s)) parts.report_changes();
    real_time = threads.finish();
  }
  LiveResult result = parts.finish();
  result.real_time = std::move(real_time);
  return result;
}

// Returns true if the true surface is known at a point that the camera sees in its first frame, or if it sees
// none there. Tries about a hundred points.
bool knows_surface(const Scenario& scenario) {
  const PointCloud cloud = scenario.cloud(0);
  const std::size_t every = std::max<std::size_t>(1, cloud.size() / 100);
  bool sees_a_point = false;
  for (std::size_t i = 0; i < cloud.size(); i += every) {
    if (!cloud.is_measured(i)) continue;
    sees_a_point = true;
    if (!std::isnan(scenario.signed_distance(cloud.point(i), scenario.captured_s(0)))) return true;
  }
  return !sees_a_point;
}

constexpr const char* kLoopEnded = "the device's loop ended by itself";
constexpr std::int64_t kHang_ns = 200'000'000;  // shorter hangs are only counted
constexpr std::size_t kRows = 1 << 14;          // 16 s at 1 kHz until rows are lost

std::size_t padded(int side_px) {
  return (static_cast<std::size_t>(side_px) + 15) / 16 * 16;
}

std::int64_t end_ns(std::int64_t start_ns, double duration_s) {
  return duration_s > 0 ? start_ns + std::llround(1e9 * duration_s)
                        : std::numeric_limits<std::int64_t>::max();
}

// Adds the refusal if `ended` does not contain it: a run that reached its duration may have read a changed
// file.
std::string with_refusal(const std::string& ended, const std::string& refused) {
  if (refused.empty() || ended.find(refused) != std::string::npos) return ended;
  return ended + (ended.empty() ? "" : "; ") + refused;
}

}  // namespace

LiveResult run_live(const Experiment& experiment, const LiveOptions& options) {
  refuse_simulated_transport(experiment.settings().transport);
  Clock& clock = steady_clock();
  auto device = open_device(options.device, {experiment, *options.kernels, clock, options.poses});
  auto source = open_sensor(options.depth, {experiment, *options.kernels, clock,
                                            options.controls ? options.controls->scenario() : nullptr});
  LiveParts parts(experiment, options, clock, std::move(device), std::move(source));
  try {
    return run_parts(parts, options, clock);
  } catch (const std::exception& error) {
    const std::string kept = parts.logger().keep();
    if (kept.empty()) throw;
    const bool no_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    throw std::runtime_error((no_memory ? "out of memory" : error.what()) + ("; " + kept));
  }
}

LiveContact::LiveContact(const Experiment& experiment)
    : ball_radius_m_(experiment.build_fixtures().empty() ? experiment.rendered_contact().ball_radius_m : 0),
      is_over_(!(ball_radius_m_ > 0)) {}

void LiveContact::add(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  if (is_over_) return;
  frames_[next_] = {frame.index, frame.points};
  next_ = (next_ + 1) % kKeptFrames;
}

void LiveContact::add(const LiveTick& tick, double time_s) {
  ContactWatch::Points points;
  {
    const std::lock_guard lock(mutex_);
    if (is_over_) return;
    const auto found = std::find_if(frames_.begin(), frames_.end(), [&](const KeptFrame& kept) {
      return kept.points && kept.index == tick.out.frame_index;
    });
    if (found == frames_.end()) return;
    points = found->points;
  }
  watch_.add(time_s, tick.device.position_W, tick.out, points);
  if (!watch_.has_contact()) return;
  const std::lock_guard lock(mutex_);
  is_over_ = true;
  frames_ = {};
}

std::vector<Note> LiveContact::notes(const Kernels& kernels) const {
  return ball_radius_m_ > 0 ? watch_.spacing_notes(ball_radius_m_, kernels) : std::vector<Note>();
}

LiveSlave::LiveSlave(const Experiment& experiment, const std::string& depth, const Kernels& kernels)
    : touched_(depth == kSimulatedDepth ? experiment.build_simulated_scene(kernels) : nullptr),
      remote_(experiment.build_teleoperation(touched_.get(), Experiment::Hand::real)),
      sender_(experiment.frame_dead_band(), kernels) {
  if (remote_ && experiment.frame_dead_band().least_motion_m > 0) places_.emplace(kMostPlaces);
  if (!remote_ || (touched_ && knows_surface(*touched_))) return;
  const std::string source =
      depth == kSimulatedDepth ? "this scenario, played in real time," : "the camera " + depth;
  why_ = "slave without surface: " + source +
         " has no true surface, so the slave moves but cannot touch anything";
}

// A full queue has lost the positions after those in it.
bool LiveSlave::sends(const Frame& frame) {
  if (!places_) return true;
  std::size_t count = 0;
  for (; const SlavePlace* const place = places_->oldest(); places_->pop(), ++count)
    sender_.observe_slave(place->position_W, place->time_s);
  if (count >= kMostPlaces) sender_.lose_slave();
  return sender_.sends(frame);
}

std::size_t expected_points(const SensorView& view) {
  return view.cloud ? 2 * view.cloud->expected_points + 256
                    : padded(view.camera.width) * padded(view.camera.height);
}

LiveParts::LiveParts(const Experiment& experiment, const LiveOptions& options, Clock& clock,
                     std::unique_ptr<HapticDevice> device, std::unique_ptr<DepthSource> source)
    : options_(options),
      clock_(clock),
      rate_hz_(experiment.settings().haptic_rate_hz),
      switches_(std::make_shared<FixtureSwitches>()),
      renderer_(experiment.build_renderer(*options.kernels, switches_)),
      slave_(experiment, options.depth, *options.kernels),
      device_(std::move(device)),
      rows_(kRows),
      contact_(experiment),
      phases_(simulated_phases(experiment, options.device, options.depth, *options.kernels)),
      setting_notes_(slave_setting_notes(experiment, Experiment::Hand::real)) {
  require_rate();
  const SensorView& view = source->view();
  experiment.check_needs(view);
  renderer_->reserve(expected_points(view));
  const RigidTransform registration = camera_registration(experiment.live());
  FrameProcessing processing =
      experiment.build_processing(*options.kernels, switches_, [this](const std::string& line) {
        const std::lock_guard lock(pending_lines_mutex_);
        pending_lines_.push_back(line);
      });
  const auto on_tick = [this](const LiveTick& tick) {
    contact_.add(tick, static_cast<double>(tick.number) / rate_hz_);
    if (options_.on_tick) options_.on_tick(tick);
  };
  logger_ =
      std::make_unique<LiveLogger>(rows_, rate_hz_, recorder(experiment, view, registration * view.X_WC),
                                   on_tick, LiveLog::stale_after_s(view.frame_rate_hz));
  const auto sink = [this](const SensorFrame& sensed, const Frame& frame, std::uint64_t off) {
    return logger_->record(sensed, frame.captured_s, off);
  };
  const auto on_frame = [this](const Frame& frame) {
    contact_.add(frame);
    if (options_.on_frame) options_.on_frame(frame);
  };
  const std::int64_t start_ns = clock_.now_ns();
  source->start_at(start_ns);
  device_->start_at(start_ns);
  ends_ns_ = end_ns(start_ns, options.duration_s);
  camera_ = std::make_unique<CameraFeed>(std::move(source), std::move(processing), *renderer_, registration,
                                         clock_, start_ns, frames_, sink, on_frame,
                                         [this](const Frame& frame) { return slave_.sends(frame); });
  force_scale_ = force_scale(experiment.max_stiffness_N_per_m(), experiment.live().device_scale,
                             device_->traits().max_stiffness_N_per_m);
  servo_ = std::make_unique<Servo>(
      ServoLinks{*device_, *renderer_, frames_, rows_, clock_, stop_, options.stop, ends_ns_,
                 &experiment.changes(), options.controls ? &options.controls->requested() : nullptr,
                 slave_.remote(), slave_.places()},
      DevicePlacement(experiment.live(), force_scale_), limits_for(experiment.safety(), device_->traits()),
      rate_hz_, start_ns, options.stall_s);
  if (options.controls && device_->traits().actuated_axes > 0 && !options.device.starts_with("sim:"))
    options.controls->limit_stiffness();
  if (force_scale_ < 1) report_force_scale();
  if (const std::string why = slave_.why_untouching(); !why.empty()) report_line(why);
}

std::unique_ptr<SessionRecorder> LiveParts::recorder(const Experiment& experiment, const SensorView& view,
                                                     const RigidTransform& registered) const {
  if (options_.record.empty()) return nullptr;
  std::vector<std::string> names;
  if (options_.controls)
    for (const LiveParameter& parameter : options_.controls->parameters()) names.push_back(parameter.name);
  TextAttributes provenance = options_.provenance;
  provenance.emplace_back("depth", options_.depth);
  experiment.add_depth_device(provenance);
  return std::make_unique<SessionRecorder>(options_.record, view, registered, provenance, names);
}

// Ticks are numbered at the experiment's rate. The tick time of a faster loop would run ahead of the clock.
void LiveParts::require_rate() const {
  const double device_hz = device_->traits().tick_rate_hz;
  if (std::abs(device_hz - rate_hz_) > 0.01 * rate_hz_)
    throw InputError("haptic_rate_hz = " + std::to_string(rate_hz_),
                     "expected " + std::to_string(device_hz) + ", the rate of this device's loop");
}

void LiveParts::run_loop() noexcept {
  try {
    device_->run([this] { return servo_->tick(); });
  } catch (...) {
    loop_failure_ = std::current_exception();
    loop_failed_ = true;
  }
  device_->release();
  loop_ended_ = true;
}

LiveResult LiveParts::finish() {
  LiveResult result;
  is_over();  // the loop may have ended by itself after the last check
  result.refused = why_refused();
  const std::string ended = with_refusal(ended_, result.refused);
  logger_->finish([&](const LiveLog& log) {
    result.report = report(log);
    TextAttributes attributes{{"ended", ended.empty() ? "an error ended the program" : ended}};
    add_report(attributes, result.report);
    return attributes;
  });
  report_pending_lines();
  result.device = device_->traits().name;
  result.force_scale = force_scale_;
  result.ended = logger_->failure().empty() ? ended : logger_->failure();
  result.failed = servo_->has_failed() || servo_->is_latched() || !camera_failure().empty() || loop_failed_ ||
                  ended_ == kLoopEnded;
  result.lost = why_lost();
  result.log = logger_->take();
  result.counts = counts();
  return result;
}

std::string LiveParts::why_lost() const {
  if (const std::string why = logger_->failure(); !why.empty()) return why;
  const char* const trouble = servo_->trouble();  // null: none
  if (trouble && std::string_view(trouble) == Servo::kNoMemory) return Servo::kNoMemory;
  return camera_->ended() == CameraFeed::kNoMemory ? "out of memory for frames" : std::string();
}

std::string LiveParts::why_refused() const {
  if (const std::string why = unusable_frame_of_hand(); !why.empty()) return why;
  return camera_->has_refused() ? camera_->ended() : changed_input();
}

std::string LiveParts::changed_input() const try {
  if (options_.check_inputs) options_.check_inputs();
  return {};
} catch (const InputError& error) {
  return error.what();
}

std::string LiveParts::unusable_frame_of_hand() const try {
  if (loop_failure_) std::rethrow_exception(loop_failure_);
  return {};
} catch (const InputError& error) {
  return error.what();
} catch (...) {
  return {};
}

LiveCounts LiveParts::counts() const {
  return {camera_->counts(), servo_->heartbeat().stalls(), servo_->rows_lost()};
}

RunReport LiveParts::report(const LiveLog& log) const {
  RunReport report = report_of(
      {options_.depth, camera_->view(), camera_->sensed(), camera_->counts(), log, rate_hz_, phases_});
  for (Note& note : contact_.notes(*options_.kernels)) report.notes.push_back(std::move(note));
  report.notes.insert(report.notes.end(), setting_notes_.begin(), setting_notes_.end());
  for (Note& note : slave_notes(log.trace)) report.notes.push_back(std::move(note));
  return report;
}

std::string LiveParts::camera_failure() const {
  const std::string why = camera_->ended();
  return why == CameraFeed::kEnd ? std::string() : why;
}

bool LiveParts::is_over() {
  if (ended_.empty()) ended_ = why_over();
  return !ended_.empty();
}

std::string LiveParts::why_over() const {
  if (options_.stop && *options_.stop) return "stopped by a signal";
  if (servo_->has_failed()) return std::string("the device failed: ") + servo_->trouble();
  if (loop_failed_) return "the device's loop failed";
  if (camera_->has_refused()) return camera_->ended();
  if (const std::string why = logger_->failure(); !why.empty()) return why;
  if (clock_.now_ns() >= ends_ns_) return "its duration has elapsed";
  // The adapter has left its loop although tick() did not return false.
  if (loop_ended_) return kLoopEnded;
  return {};
}

void LiveParts::report_line(const std::string& line) const {
  if (options_.report_line) options_.report_line(line);
}

void LiveParts::report_pending_lines() {
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(pending_lines_mutex_);
    lines.swap(pending_lines_);
  }
  for (const std::string& line : lines) report_line(line);
}

void LiveParts::report_force_scale() const {
  report_line(
      formatted("the maximum stiffness of the device is %.4g N/m: forces and torques are scaled by %.3g",
                device_->traits().max_stiffness_N_per_m, force_scale_));
}

std::string LiveParts::camera_trouble() const {
  if (camera_->has_refused()) return {};  // the run ends and then reports the reason
  const char* const held =
      camera_->has_sent() ? "the last cloud is still rendered" : "there is nothing to touch";
  if (const std::string why = camera_->ended(); !why.empty()) return "no more frames (" + why + "): " + held;
  const double stale_after_s = LiveLog::stale_after_s(camera_->view().frame_rate_hz);
  if (clock_.now_s() - camera_->newest_s() <= stale_after_s) return {};
  if (!camera_->has_sent()) return std::string("no frame has arrived yet: ") + held;
  return formatted("no frame for %.2g s: ", stale_after_s) + held;
}

std::string LiveParts::force_trouble() const {
  if (hangs_since_ns_ >= 0 && clock_.now_ns() - hangs_since_ns_ > kHang_ns)
    return "the haptic loop hangs, and the device was released";
  if (!servo_->is_latched()) return {};
  return servo_->trouble() + std::string(servo_->has_failed() ? "" : "; SIGUSR2 re-arms");
}

void LiveParts::report_changes() {
  report_pending_lines();
  if (!heartbeat().is_released())
    hangs_since_ns_ = -1;
  else if (hangs_since_ns_ < 0)
    hangs_since_ns_ = clock_.now_ns();
  if (const LiveTrouble now{camera_trouble(), force_trouble()}; now != reported_) {
    if (now.camera != reported_.camera) report_line(now.camera.empty() ? "frames arrive" : now.camera);
    if (now.force != reported_.force)
      report_line(now.force.empty() ? "re-armed: the force starts again when the hand is in free space"
                                    : "force is off: " + now.force);
    reported_ = now;
    if (options_.on_trouble) options_.on_trouble(now);
  }
  if (options_.rearm && options_.rearm->exchange(false)) servo_->rearm();
  if (options_.report && options_.report->exchange(false) && options_.on_report)
    logger_->ask([this](const LiveLog& log) { options_.on_report(live_report(log, counts())); });
}

}  // namespace remote_touch
