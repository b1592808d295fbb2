// Test doubles of the libraries of haptic devices, all in one library: Force Dimension's DHD, Entact's
// EntactAPI and OpenHaptics' HD. They have the vendors' signatures and none of their behaviour, except for
// what the documentation states: at Entact the state is that of the last force sent, and there is none while
// the motors are off; OpenHaptics has a thread that calls a thousand times a second, and a force counts at
// the end of its frame.
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "tests/doubles/device_double.h"

namespace {

using remote_touch::DeviceDouble;

DeviceDouble device;

// --- DHD ---

thread_local int last_error = 0;

constexpr int kCommunication = 2, kNoDevice = 5;
constexpr char kId = 7;  // a handle that no device number equals

// Returns 0 or, with the error kept, -1.
int answer(char id, int error) {
  const DeviceDouble::State state = device.state();
  last_error = id != kId ? kNoDevice : state.is_unplugged ? kCommunication : error;
  return last_error == 0 ? 0 : -1;
}

int give(const std::array<double, 3>& from, double* x, double* y, double* z, char id) {
  *x = from[0], *y = from[1], *z = from[2];
  return answer(id, device.state().reading_error);
}

// --- EntactAPI ---

std::mutex known_mutex;
DeviceDouble::State known;  // state at the last force

DeviceDouble::State last_known() {
  const std::lock_guard<std::mutex> lock(known_mutex);
  return known;
}

constexpr int kOk = 1, kError = -1, kForceControl = 1;

int answer(void* handle, int error) {
  return handle == &device && !device.state().is_unplugged && error == 0 ? kOk : kError;
}

int connect(void* handles[], int index) {
  if (device.state().devices == 0) return kError;
  handles[index] = &device;
  device.open(true);
  return kOk;
}

// --- HD ---

struct ErrorInfo {
  unsigned code;
  int internal_code;
  unsigned device;
};
thread_local std::vector<unsigned> errors;  // a stack: the newest is read first

constexpr unsigned kDevice = 3, kInvalid = 0xFFFFFFFF;
constexpr unsigned kBadHandle = 0x0104, kLost = 0x0302, kIllegalBegin = 0x0400, kIllegalEnd = 0x0401;

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
    errors.push_back(kLost);
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
// NOLINTBEGIN(readability-identifier-naming): the vendors'

DeviceDouble* device_double() {
  return &device;
}

int dhdGetDeviceCount() {
  return device.state().devices;
}

int dhdOpenID(char number) {
  last_error = number < device.state().devices ? device.state().switching_error : kNoDevice;
  device.open(last_error == 0);
  return last_error == 0 ? kId : -1;
}

int dhdClose(char id) {
  device.open(false);
  return answer(id, 0);
}

int dhdStop(char id) {
  device.switch_motors(false);
  return answer(id, 0);
}

int dhdEnableForce(unsigned char on, char id) {
  if (on != 0) device.enter(DeviceDouble::switch_on);
  const int result = answer(id, device.state().switching_error);
  if (result == 0) device.switch_motors(on != 0);
  return result;
}

const char* dhdGetSystemName(char) {
  return "double.7";
}

bool dhdHasWrist(char) {
  return device.state().sensed_axes == 6;
}

bool dhdHasActiveWrist(char) {
  return device.state().actuated_axes == 6;
}

double dhdGetMaxForce(char) {
  return device.state().max_force;
}

double dhdGetMaxTorque(char) {
  return device.state().max_torque;
}

unsigned dhdGetButtonMask(char) {
  return device.state().buttons;
}

int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double frame[3][3], char id) {
  const DeviceDouble::State state = device.state();
  std::copy(state.rotation.begin(), state.rotation.end(), &frame[0][0]);
  return give(state.position, x, y, z, id);
}

int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
  return give(device.state().velocity, x, y, z, id);
}

int dhdGetAngularVelocityRad(double* x, double* y, double* z, char id) {
  return give(device.state().turning, x, y, z, id);
}

int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz,
                                        double /*gripper*/, char id) {
  device.enter(DeviceDouble::write_force);
  const int result = answer(id, device.state().writing_error);
  if (result == 0) device.send({fx, fy, fz, tx, ty, tz});
  return result;
}

int dhdErrorGetLast() {
  return last_error;
}

const char* dhdErrorGetLastStr() {
  return "the double's text";
}

int openEAPI(void* handles[], int size) {
  return size > 0 && connect(handles, 0) == kOk ? 1 : 0;
}

int connectDeviceEAPI(void* handles[], int index, char ip_address[]) {
  return std::strcmp(ip_address, "192.168.1.144") == 0 ? connect(handles, index) : kError;
}

int closeEAPI() {
  device.open(false);
  return kOk;
}

int getDeviceInfoEAPI(void* handle, char* product, char* name, int size) {
  std::strncpy(product, "Double W5D\n", static_cast<std::size_t>(size));
  std::strncpy(name, "double", static_cast<std::size_t>(size));
  return answer(handle, 0);
}

int isHomedEAPI(void*) {
  return device.state().is_homed ? kOk : 0;
}

int homeDeviceEAPI(void* handle) {
  bool succeeds = false;
  device.set([&](DeviceDouble::State& state) {
    succeeds = state.failing_homings == 0;
    if (succeeds)
      state.is_homed = true;
    else
      --state.failing_homings;
  });
  return succeeds ? answer(handle, 0) : kError;
}

int setModeEAPI(void* handle, int mode) {
  const bool on = mode == kForceControl;
  if (on) device.enter(DeviceDouble::switch_on);
  const DeviceDouble::State state = device.state();
  if (on && !state.is_homed) return kError;
  const int result = answer(handle, on ? state.switching_error : 0);
  if (result == kOk) device.switch_motors(on);
  return result;
}

int readTaskPositionEAPI(void* handle, double* position, int size) {
  if (size < 12 || !device.now().has_motors_on) return kError;
  const DeviceDouble::State state = last_known();
  std::copy(state.position.begin(), state.position.end(), position);
  std::copy(state.rotation.begin(), state.rotation.end(), position + 3);
  return answer(handle, device.state().reading_error);
}

int readTaskVelocityEAPI(void* handle, double* velocity, int size) {
  if (size < 6 || !device.now().has_motors_on) return kError;
  const DeviceDouble::State state = last_known();
  std::copy(state.velocity.begin(), state.velocity.end(), velocity);
  std::copy(state.turning.begin(), state.turning.end(), velocity + 3);
  return answer(handle, device.state().reading_error);
}

int writeForceEAPI(void* handle, double* force, int size) {
  device.enter(DeviceDouble::write_force);
  if (size < 6) return kError;
  const int result = answer(handle, device.state().writing_error);
  if (result != kOk) return result;
  std::array<double, 6> sent{};
  std::copy(force, force + 6, sent.begin());
  device.send(sent);
  const std::lock_guard<std::mutex> lock(known_mutex);
  if (device.now().has_motors_on) known = device.state();
  return result;
}

unsigned hdInitDevice(const char* name) {
  const DeviceDouble::State state = device.state();
  const bool is_there = state.devices > 0 && (name == nullptr || std::strcmp(name, "Left Device") == 0);
  const unsigned error = is_there ? static_cast<unsigned>(state.switching_error) : kLost;
  if (error != 0) errors.push_back(error);
  device.open(error == 0);
  return error == 0 ? kDevice : kInvalid;
}

void hdDisableDevice(unsigned) {
  device.open(false);
}

void hdMakeCurrentDevice(unsigned handle) {
  if (handle != kDevice) errors.push_back(kBadHandle);
}

void hdBeginFrame(unsigned handle) {
  if (handle != kDevice) errors.push_back(kBadHandle);
  if (is_in_frame) errors.push_back(kIllegalBegin);
  is_in_frame = true;
  keep(0);
}

void hdEndFrame(unsigned handle) {
  if (handle != kDevice) errors.push_back(kBadHandle);
  if (!is_in_frame) errors.push_back(kIllegalEnd);
  is_in_frame = false;
  device.enter(DeviceDouble::write_force);
  const int error = device.state().writing_error;
  if (!device.state().is_unplugged && error == 0) device.send(commanded);
  keep(error);
}

ErrorInfo hdGetError() {
  if (errors.empty()) return {0, 0, kDevice};
  const ErrorInfo newest{errors.back(), -28, kDevice};
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
