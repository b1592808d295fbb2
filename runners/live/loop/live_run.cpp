#include "runners/live/loop/live_run.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <future>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/kernels/isa.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/loop/live_parts.h"
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

}  // namespace remote_touch
