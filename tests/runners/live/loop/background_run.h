// A live run in a thread of its own, with what it tells its user.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "runners/live/loop/live_run.h"
#include "runners/live/timing/steady_clock.h"
#include "tests/support/scenes.h"

namespace remote_touch {

class BackgroundRun {
 public:
  BackgroundRun(std::string experiment, std::string device, std::string depth = "sim:") {
    options_.device = std::move(device), options_.depth = std::move(depth);
    options_.kernels = &scenes::kernels();
    options_.stop = &stop_;
    options_.duration_s = 60;
    options_.report_line = [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      told_ += line + "\n";
    };
    thread_ = std::thread([this, experiment = std::move(experiment)] {
      run(experiment);
      over_ = true;
    });
  }
  ~BackgroundRun() { ended_by_stop(); }

  void stop() { stop_ = true; }
  bool is_over() const { return over_; }
  // Waits for the end.
  const LiveResult& ended() {
    if (thread_.joinable()) thread_.join();
    return result_;
  }
  const LiveResult& ended_by_stop() {
    stop();
    return ended();
  }
  std::string told() {
    const std::lock_guard lock(mutex_);
    return told_;
  }

 private:
  void run(const std::string& experiment) try {
    result_ = run_live(Experiment::from_json(experiment, "test"), options_);
  } catch (const std::exception& error) {
    result_.ended = error.what(), result_.failed = true;
  }

  std::atomic<bool> stop_ = false, over_ = false;
  std::mutex mutex_;
  std::string told_;
  LiveOptions options_;
  LiveResult result_;
  std::thread thread_;
};

inline void nap() {
  std::this_thread::sleep_for(std::chrono::microseconds(200));
}

inline bool wait_until(const std::function<bool()>& is_so, double max_s = 20) {
  for (const double until_s = steady_s() + max_s; steady_s() < until_s; nap())
    if (is_so()) return true;
  return false;
}

// What a hand does, and what it feels.
struct Hand {
  std::function<void()> lift, press;
  std::function<double()> force_N;
};

// Comes from free space and presses until there is a force. Where the machine pauses, the device is let go,
// and then a hand that is inside waits for ever; some devices end the run. So it is lifted again, and a run
// that is over, or that there is not yet, is started.
inline bool press_in(std::unique_ptr<BackgroundRun>& run,
                     const std::function<std::unique_ptr<BackgroundRun>()>& start, const Hand& hand) {
  constexpr double kEnough_N = 0.4, kLift_s = 0.1, kPress_s = 0.3;
  const auto try_once = [&] {
    hand.lift();
    if (!run || run->is_over()) run = start();
    std::this_thread::sleep_for(std::chrono::duration<double>(kLift_s));
    hand.press();
    wait_until([&] { return run->is_over() || hand.force_N() > kEnough_N; }, kPress_s);
    return !run->is_over() && hand.force_N() > kEnough_N;
  };
  return wait_until(try_once);
}

// From now on until there is no force; a second at most.
inline double time_to_nothing_s(const std::function<double()>& force_N) {
  const double start_s = steady_s();
  while (force_N() > 0 && steady_s() - start_s < 1) nap();
  return steady_s() - start_s;
}

// The device's side has no force so long after a failure.
constexpr double kPromise_s = 0.02;

// A proxy over the table of `camera-scene`, of which a machine with little to spare makes images too. Without
// noise a hand at rest commands the same force in every frame, never one so small that it would engage the
// gate.
constexpr const char* kPress = R"({
  "scenario": {"name": "camera-scene", "width": 160, "height": 120, "noise_per_m": 0, "quantisation_per_m": 0},
  "renderer": {"name": "proxy"},
  "trajectory": {"name": "follow-surface"}, "safety": {"ramp_s": 0.05}})";

inline double table_height_m() {
  return Experiment::from_json(kPress, "test").build_scenario(scenes::kernels())->surface_height(0, 0, 0);
}

}  // namespace remote_touch
