// A test double of Force Dimension's DHD: it has the vendor's signatures and none of its behaviour.
#include "tests/doubles/device_double.h"

namespace {

using remote_touch::DeviceDouble;

DeviceDouble device;
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

}  // namespace

extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the vendor's

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
// NOLINTEND(readability-identifier-naming)
}
