// Every haptic device that --device can name: the functions that open them, and a table with one line each.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/points/vector.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/libraries/shared_library.h"
#include "runners/live/devices/built_in_devices.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// The adapters of devices except Haply's, one source each. open_...() opens a device; it throws InputError,
// which says what is missing. ..._availability() says whether there is one. The adapters of vendors'
// libraries are written from their documentation and tested with test doubles, never with a device.

// Force Dimension's omega, sigma, delta and lambda and Novint's Falcon, through the vendor's DHD library.
// address: the number of the device among those connected; "" is 0.
std::unique_ptr<HapticDevice> open_force_dimension(const std::string& address, Clock& clock);
Availability force_dimension_availability();

// Touch, Touch X and the Phantoms before them, such as the Omni of 4.3 and 6.3, through the HD library of the
// vendor's OpenHaptics. address: the name that the device has in the vendor's setup; "" is "Default Device".
//
// The vendor's scheduler drives run(). If it does not start, or stops calling, read() returns a fault to the
// tick; release() reaches the device even if a callback hangs.
std::unique_ptr<HapticDevice> open_open_haptics(const std::string& address, Clock& clock);
// Checks the library only: the library finds devices only when one is opened.
Availability open_haptics_availability();

// Entact's W5D, the device of 7.5, and W7D, through the vendor's EntactAPI. address: network address of the
// device, "192.168.1.144". If it is empty, the network is queried and the first device that answers is
// opened. A device that is not homed must be held in its calibration position.
//
// Two things differ from the contract of HapticDevice. First, the device reports its pose only while its
// motors are on, and the pose is that at the last force command. So the first read() switches the motors on
// with zero force, and each reading is one tick old. Second, a call that is lost in the network waits for as
// long as the vendor's library does.
std::unique_ptr<HapticDevice> open_entact(const std::string& address, Clock& clock);
// Checks the library only: the library searches for devices when one is opened.
Availability entact_availability();

// A 3Dconnexion SpaceMouse, through the daemon spacenavd: input only, six axes, no motors. Needs no library.
//
// The address is the path of the daemon's socket, and settings. The default path is that of the environment
// variable SPNAV_SOCKET, or else /var/run/spnav.sock. Settings:
//   speed=M_PER_S      speed for each count of deflection, by default 0.0005; a mouse sends up to about 350
//   turning=RAD_PER_S  angular speed for each count of deflection, by default 0.003
//   box=M              half the width of the workspace, by default 0.15; the position is kept within
//
// The deflection is used as a velocity and integrated to a pose, which starts in the middle of the box. A
// deflection is used for at most 0.5 s unless it is reported again, so that an unplugged mouse comes to rest;
// if the daemon does not repeat a constant deflection, set repeat-interval = 250 in its settings. Rotations
// are about the axes of the device's frame, not those of the handle.
//
// Axes of the daemon, as its own library uses them: x to the right, y up, z away from the user, and rotations
// about x, y and -z. The settings of the daemon (spacenavd's configuration file) can change them.
//
// read() processes the messages that have arrived and does not wait. It returns a fault after the daemon has
// closed the connection; the device must then be opened again. write() exerts no force and returns the fault
// of read(), if any. release() does nothing.
std::unique_ptr<HapticDevice> open_spacenav(const std::string& address, Clock& clock);
// Reports whether the daemon accepts a connection. The daemon does not report which mouse it has, if any.
Availability spacenav_availability(const std::string& address, const Clock& clock);

// Parts that the adapters of vendors' libraries share.

// The availability of devices whose library does not report them before one is opened.
template <class Functions>
Availability availability_of_library() {
  return availability_of([] {
    return Availability{
        .detail = Functions().library.file() + ": a device is detected only when one is opened",
        .was_searched = false};
  });
}

// Converts from the axes of Force Dimension and Entact, x towards the user, y to the right, z up, to ours: x
// right, y up, z towards the user. The second function converts back.
inline Vec3 from_user_right_up(const Vec3& v) {
  return {v.y(), v.z(), v.x()};
}
inline Vec3 to_user_right_up(const Vec3& v) {
  return {v.z(), v.x(), v.y()};
}

// The handle's axes are renamed like the device's, so that the vendor's identity is the identity here too.
inline Eigen::Matrix3d rotation_from_user_right_up(const Eigen::Matrix3d& rotation) {
  Eigen::Matrix3d rotated;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rotated(i, j) = rotation((i + 1) % 3, (j + 1) % 3);
  return rotated;
}

// True if m is a rotation within the errors of encoders and single precision; false if a value is not finite.
inline bool is_rotation(const Eigen::Matrix3d& m) {
  constexpr double kSlack = 1e-3;
  return ((m * m.transpose() - Eigen::Matrix3d::Identity()).array().abs() < kSlack).all() &&
         m.determinant() > 0;
}

// Texts for vendors' error codes. They are valid for the whole run of the program; the vendors' own texts may
// not be.
struct KnownFault {
  int code;
  const char* what;
};

// Returns the fault of this code with its known text. what: the text for an unknown code.
inline DeviceFault fault_of(std::span<const KnownFault> known, int code, const char* what) {
  for (const KnownFault& fault : known)
    if (fault.code == code) what = fault.what;
  return {what, code};
}

inline constexpr DeviceFault kNoRotation{"the device reports an orientation that is not a rotation", 0};

// The table.

// The objects that a device may need. All but poses must outlive it.
struct DeviceContext {
  const Experiment& experiment;
  const Kernels& kernels;
  Clock& clock;
  std::shared_ptr<HandPoses> poses = nullptr;  // poses from a page of the viewer, for browser:
};

struct DeviceEntry {
  const char* scheme;
  const char* example;
  const char* summary;
  std::unique_ptr<HapticDevice> (*open)(const std::string& address, const DeviceContext& context);
  Availability (*availability)();
};

std::span<const DeviceEntry> devices();

// Throws InputError when the device cannot be opened.
std::unique_ptr<HapticDevice> open_device(const std::string& uri, const DeviceContext& context);

}  // namespace remote_touch
