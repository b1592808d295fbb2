// The device behind the library: the part that the test doubles of vendors' libraries share. A test sets its
// state and reads it. Each double exports it under the name device_double.
//
// They are test doubles: they have the vendors' signatures and none of their behaviour. A test that passes
// with them shows what an adapter calls, not what a device does.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <type_traits>
#include <vector>

#include "runners/live/devices/clock.h"
#include "tests/doubles/simulated_clock.h"

namespace remote_touch {

class DeviceDouble {
 public:
  static constexpr const char* kExport = "device_double";

  // All values are in the vendor's units and axes.
  struct State {
    std::array<double, 3> position{}, velocity{}, turning{};
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
    unsigned buttons = 0;

    int devices = 1;
    int sensed_axes = 6, actuated_axes = 6;
    double max_force = 0, continuous_force = 0, max_torque = 0, max_stiffness = 0;
    bool is_unplugged = false;
    int reading_error = 0, writing_error = 0, switching_error = 0;  // the vendor's code, until it is 0 again
    // The rest concerns only devices that have homing or a scheduler.
    bool is_homed = true;
    int failing_homings = 0;
    int scheduler_error = 0;
    bool is_scheduler_silent = false;  // true: it calls no callback from now on
  };

  struct Event {
    std::int64_t at_ns;
    std::array<double, 6> sent;  // last force and torque sent to the library
    bool has_motors_on;

    // Returns the force that the device exerts, which is 0 while its motors are off.
    double force() const { return has_motors_on ? std::hypot(sent[0], sent[1], sent[2]) : 0; }
  };

  // --- for tests ---
  // Waiting and remembered events use this clock from now on; null: the steady clock.
  void follow(SimulatedClock* clock) { simulated_ = clock; }
  void reset() {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = {}, sent_ = {}, events_ = {};
    has_motors_on_ = is_open_ = false;
    hang_next_ = none, hangs_ = false;
  }
  template <class Change>
  void set(Change change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change(state_);
  }
  template <class Value>
  void set(Value State::*member, const std::type_identity_t<Value>& value) {
    set([&](State& state) { state.*member = value; });
  }
  // The next such call hangs until release(), and then does its work.
  enum Call { none, write_force, switch_on };
  void hang_next(Call call) { hangs_ = true, hang_next_ = call; }
  void release() { hangs_ = false; }
  bool is_hanging() const { return hangs_ && hang_next_ == none; }

  std::vector<Event> events() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return events_;
  }
  Event now() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {clock().now_ns(), sent_, has_motors_on_};
  }
  bool is_open() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return is_open_;
  }

  // --- for the library ---
  SimulatedClock* simulated() const { return simulated_; }
  Clock& clock() const { return simulated_ ? *simulated_ : steady_clock(); }
  State state() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return state_;
  }
  void open(bool is_open) {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_open_ = is_open;
  }
  void send(const std::array<double, 6>& sent) {
    const std::lock_guard<std::mutex> lock(mutex_);
    sent_ = sent;
    remember();
  }
  void switch_motors(bool on) {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_motors_on_ = on;
    remember();
  }
  void enter(Call call) {
    if (!hang_next_.compare_exchange_strong(call, none)) return;
    while (hangs_) clock().sleep_s(1e-3);
  }

 private:
  void remember() { events_.push_back({clock().now_ns(), sent_, has_motors_on_}); }

  SimulatedClock* simulated_ = nullptr;
  mutable std::mutex mutex_;
  State state_;
  std::array<double, 6> sent_{};
  bool has_motors_on_ = false, is_open_ = false;
  std::vector<Event> events_;
  std::atomic<Call> hang_next_{none};
  std::atomic<bool> hangs_{false};
};

}  // namespace remote_touch

extern "C" remote_touch::DeviceDouble* device_double();
