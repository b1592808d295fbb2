// A test double of OpenHaptics' HD library: it has the vendor's signatures and none of its behaviour, except
// for a thread that calls a thousand times a second, and the rule that a force counts at the end of its
// frame.
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "tests/doubles/device_double.h"

namespace {

using remote_touch::DeviceDouble;

DeviceDouble device;

struct ErrorInfo {
  unsigned code;
  int internal_code;
  unsigned device;
};
thread_local std::vector<unsigned> errors;  // a stack: the newest is read first

constexpr unsigned kHandle = 3, kInvalid = 0xFFFFFFFF;
constexpr unsigned kBadHandle = 0x0104, kCommunication = 0x0302, kIllegalBegin = 0x0400, kIllegalEnd = 0x0401;

thread_local bool is_in_frame = false;
thread_local std::array<double, 6> commanded{};

constexpr double kPeriod_s = 1e-3;
std::thread scheduler;
int simulated_scheduler = 0;
std::atomic<bool> is_scheduling{false};
unsigned (*callback)(void*) = nullptr;
void* callback_data = nullptr;

void call() {
  if (callback != nullptr && !device.state().is_scheduler_silent && callback(callback_data) == 0)
    callback = nullptr;
}

void call_every_millisecond() {
  for (; is_scheduling; device.clock().sleep_s(kPeriod_s)) call();
}

void start_scheduler() {
  if (is_scheduling.exchange(true)) return;
  if (remote_touch::SimulatedClock* const clock = device.simulated())
    simulated_scheduler = clock->every(kPeriod_s, clock->now_s(), call);
  else
    scheduler = std::thread(call_every_millisecond);
}

void stop_scheduler() {
  if (!is_scheduling.exchange(false)) return;
  if (device.simulated())
    device.simulated()->cancel(simulated_scheduler);
  else
    scheduler.join();
}

void keep(int error) {
  if (device.state().is_unplugged)
    errors.push_back(kCommunication);
  else if (error != 0)
    errors.push_back(static_cast<unsigned>(error));
}

// Writes the 4x4 transform column by column.
void give_transform(const DeviceDouble::State& state, double* values) {
  std::fill(values, values + 16, 0.0);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      values[4 * column + row] = state.rotation[3 * row + column];
    values[12 + row] = state.position[row];
  }
  values[15] = 1;
}

}  // namespace

extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the vendor's

DeviceDouble* device_double() {
  return &device;
}

unsigned hdInitDevice(const char* name) {
  const DeviceDouble::State state = device.state();
  const bool is_there = state.devices > 0 && (name == nullptr || std::strcmp(name, "Left Device") == 0);
  const unsigned error = is_there ? static_cast<unsigned>(state.switching_error) : kCommunication;
  if (error != 0) errors.push_back(error);
  device.open(error == 0);
  return error == 0 ? kHandle : kInvalid;
}

void hdDisableDevice(unsigned) {
  device.open(false);
}

void hdMakeCurrentDevice(unsigned handle) {
  if (handle != kHandle) errors.push_back(kBadHandle);
}

void hdBeginFrame(unsigned handle) {
  if (handle != kHandle) errors.push_back(kBadHandle);
  if (is_in_frame) errors.push_back(kIllegalBegin);
  is_in_frame = true;
  keep(0);
}

void hdEndFrame(unsigned handle) {
  if (handle != kHandle) errors.push_back(kBadHandle);
  if (!is_in_frame) errors.push_back(kIllegalEnd);
  is_in_frame = false;
  device.enter(DeviceDouble::write_force);
  const int error = device.state().writing_error;
  if (!device.state().is_unplugged && error == 0) device.send(commanded);
  keep(error);
}

ErrorInfo hdGetError() {
  if (errors.empty()) return {0, 0, kHandle};
  const ErrorInfo newest{errors.back(), -28, kHandle};
  errors.pop_back();
  return newest;
}

const char* hdGetErrorString(unsigned) {
  return "the double's text";
}

void hdEnable(unsigned capability) {
  device.enter(DeviceDouble::switch_on);
  const int error = device.state().switching_error;
  if (capability == 0x4000 && error == 0) device.switch_motors(true);
  keep(error);
}

void hdDisable(unsigned capability) {
  if (capability == 0x4000) device.switch_motors(false);
}

void hdGetDoublev(unsigned what, double* values) {
  const DeviceDouble::State state = device.state();
  if (what == 0x2052) give_transform(state, values);
  if (what == 0x2051) std::copy(state.velocity.begin(), state.velocity.end(), values);
  if (what == 0x2053) std::copy(state.turning.begin(), state.turning.end(), values);
  if (what == 0x2602) *values = state.max_stiffness;
  if (what == 0x2603) *values = state.max_force;
  if (what == 0x2604) *values = state.continuous_force;
  if (what == 0x2622) *values = state.max_torque;
  if (is_in_frame) keep(state.reading_error);
}

void hdGetIntegerv(unsigned what, int* values) {
  const DeviceDouble::State state = device.state();
  if (what == 0x2000) *values = static_cast<int>(state.buttons);
  if (what == 0x2553) *values = state.sensed_axes;
  if (what == 0x2554) *values = state.actuated_axes;
}

const char* hdGetString(unsigned) {
  return "Double Touch";
}

void hdSetDoublev(unsigned what, const double* values) {
  if (!is_in_frame) errors.push_back(0x0402);
  std::copy(values, values + 3, what == 0x2700 ? commanded.begin() : commanded.begin() + 3);
}

unsigned long hdScheduleAsynchronous(unsigned (*function)(void*), void* data, unsigned short) {
  callback = function, callback_data = data;
  return 1;
}

void hdUnschedule(unsigned long) {}

void hdStartScheduler() {
  const int error = device.state().scheduler_error;
  if (error == 0) start_scheduler();
  keep(error);
}

void hdStopScheduler() {
  stop_scheduler();
  callback = nullptr;
}
// NOLINTEND(readability-identifier-naming)
}
