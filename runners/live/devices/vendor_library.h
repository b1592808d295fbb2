// The adapters of vendors' libraries share these parts: availability, axes, rotations and the texts of
// faults.
#pragma once

#include <span>

#include "core/points/vector.h"
#include "runners/libraries/shared_library.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

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

}  // namespace remote_touch
