// Measures how punctual the live loop is on this machine. It has no pass or failure. The tests check on a
// simulated clock, to exact times, what the loop does in which tick. `remote-touch jitter` reports how late
// ticks begin.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "runners/live/devices/clock.h"
#include "runners/live/loop/live_run.h"
#include "runners/live/loop/servo.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/support/scenes.h"
#ifdef REMOTE_TOUCH_HAPLY_SERVICE
#include "runners/live/devices/haply.h"
#include "tests/doubles/haply_service.h"
#endif

namespace remote_touch {
namespace {

void print(const char* what, std::vector<double> values_us) {
  std::sort(values_us.begin(), values_us.end());
  const auto us = [&](double fraction) { return quantile(values_us, fraction); };
  std::printf("%-56s %7zu %9.2f %9.2f %9.2f %9.2f\n", what, values_us.size(), us(0.5), us(0.99), us(0.999),
              us(1));
}

double us_since(std::int64_t start_ns) {
  return 1e-3 * static_cast<double>(steady_clock().now_ns() - start_ns);
}

// --- the tick: everything but the renderer and the device ---

class NoDevice final : public HapticDevice {
 public:
  using HapticDevice::HapticDevice;
  DeviceFault read(DeviceReading&) noexcept override { return {}; }
  DeviceFault write(const Wrench&) noexcept override { return {}; }
  void release() noexcept override {}
};

class NoRenderer final : public Renderer {
 public:
  void on_frame(const Frame&) override {}
  RenderOutput step(const DeviceState&, double) override { return {}; }
};

// Times ticks in batches, because one tick takes as long as one reading of the clock.
void measure_ticks() {
  constexpr int kBatches = 2000, kTicks = 100;
  NoDevice device(steady_clock());
  NoRenderer renderer;
  TripleBuffer<LiveFrame> frames;
  Ring<LiveTick> rows(kTicks);
  const std::atomic<bool> stop = false;
  Servo servo({device, renderer, frames, rows, steady_clock(), stop}, DevicePlacement({}), {}, 1000,
              steady_clock().now_ns(), 0.01);
  std::vector<double> each_us;
  for (int batch = 0; batch < kBatches; ++batch) {
    const std::int64_t start_ns = steady_clock().now_ns();
    for (int i = 0; i < kTicks; ++i) servo.tick();
    each_us.push_back(us_since(start_ns) / kTicks);
    while (rows.oldest()) rows.pop();
  }
  print("a tick with nothing to render, us", std::move(each_us));
}

// --- a vendor's call that hangs, until the motors are off ---

void nap() {
  steady_clock().sleep_s(20e-6);
}

void measure_letting_go() {
  constexpr int kHangs = 100;
  const DoubleInstalled behind(kForceDimension);
  std::atomic<bool> stop = false;
  LiveOptions options;
  options.kernels = &scenes::kernels();
  options.device = kForceDimension.uri;
  options.stop = &stop;
  std::thread run([&] {
    run_live(Experiment::from_json(
                 R"({"scenario": {"name": "camera-scene", "width": 160, "height": 120},
                     "renderer": {"name": "proxy"}, "trajectory": {"name": "follow-surface"}})",
                 "benchmark"),
             options);
  });
  std::vector<double> took_us;
  for (int i = 0; i < kHangs; ++i) {
    while (!behind->now().has_motors_on) nap();
    behind->hang_next(DeviceDouble::write_force);
    while (!behind->is_hanging()) nap();
    const std::int64_t start_ns = steady_clock().now_ns();
    while (behind->now().has_motors_on) nap();
    took_us.push_back(us_since(start_ns));
    behind->release();
    steady_clock().sleep_s(0.02);
  }
  stop = true;
  run.join();
  print("a call that hangs, until the motors are off, us", std::move(took_us));
}

// --- Haply's service, in a process of its own ---

#ifdef REMOTE_TOUCH_HAPLY_SERVICE
class TimedTicks final : public DeviceCycle {
 public:
  TimedTicks(HapticDevice& device, int ticks) : device_(device), left_(ticks) {}
  bool tick() noexcept override {
    DeviceReading reading;
    const std::int64_t start_ns = steady_clock().now_ns();
    const bool is_late = bool(device_.read(reading));
    if (device_.write({}) || is_late)
      ++late;
    else
      took_us.push_back(us_since(start_ns));
    return --left_ > 0;
  }
  std::vector<double> took_us;
  int late = 0;

 private:
  HapticDevice& device_;
  int left_;
};

void measure_haply(int rate_hz) {
  const HaplyServiceProcess service;
  const auto device = open_haply(service.address("?rate=" + std::to_string(rate_hz)), steady_clock());
  TimedTicks ticks(*device, 3 * rate_hz);
  std::thread loop([&] {
    become_real_time();
    device->run(ticks);
  });
  loop.join();
  const std::string what = "read and write of Haply's adapter at " + std::to_string(rate_hz) + " Hz, us";
  print(what.c_str(), std::move(ticks.took_us));
  std::printf("%-56s %7d\n", "  of these ticks the service was late in", ticks.late);
}
#endif

}  // namespace
}  // namespace remote_touch

int main() {
  using namespace remote_touch;
  std::printf("%-56s %7s %9s %9s %9s %9s\n", "", "count", "p50", "p99", "p99.9", "max");
  measure_ticks();
  measure_letting_go();
#ifdef REMOTE_TOUCH_HAPLY_SERVICE
  measure_haply(1000);
  measure_haply(4000);
#endif
}
