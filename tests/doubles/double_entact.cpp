// A test double of Entact's EntactAPI: it has the vendor's signatures and none of its behaviour, except for
// two things that its documentation states. The state is that of the last force sent, and there is no state
// while the motors are off.
#include <cstring>

#include "tests/doubles/device_double.h"

namespace {

using remote_touch::DeviceDouble;

DeviceDouble device;
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

}  // namespace

extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the vendor's

DeviceDouble* device_double() {
  return &device;
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
  std::array<double, 6> commanded{};
  std::copy(force, force + 6, commanded.begin());
  device.send(commanded);
  const std::lock_guard<std::mutex> lock(known_mutex);
  if (device.now().has_motors_on) known = device.state();
  return result;
}
// NOLINTEND(readability-identifier-naming)
}
