#include "runners/experiment/hand/device_motors.h"

#include "core/geometry/vector.h"

namespace remote_touch {

namespace {

Vec3 with_motors(const Vec3& v, bool x, bool y, bool z) {
  return {x ? v.x() : 0, y ? v.y() : 0, z ? v.z() : 0};
}

Vec3 cut(const Vec3& v, double max_length) {
  return max_length > 0 ? limited_length(v, max_length) : v;
}

}  // namespace

Parameters parameters(MotorSettings& s) {
  return {
      {"force_x", &s.force_x, 0, 0, "the device can exert a force along x of the base frame"},
      {"force_y", &s.force_y, 0, 0, "the device can exert a force along y"},
      {"force_z", &s.force_z, 0, 0, "the device can exert a force along z"},
      {"torque_x", &s.torque_x, 0, 0,
       "the device can exert a torque about x of the handle, which is that of the tool"},
      {"torque_y", &s.torque_y, 0, 0, "the device can exert a torque about y of the handle"},
      {"torque_z", &s.torque_z, 0, 0, "the device can exert a torque about z of the handle"},
      {"max_force_N", &s.max_force_N, 0, 1000, "maximum force of the device; 0: no limit"},
      {"max_torque_Nm", &s.max_torque_Nm, 0, 100, "maximum torque of the device; 0: no limit"},
  };
}

Wrench exerted(const MotorSettings& m, const Eigen::Quaterniond& handle_W, const Wrench& commanded) {
  const Vec3 torque_T = handle_W.conjugate() * commanded.torque_Nm;
  return {cut(with_motors(commanded.force_N, m.force_x, m.force_y, m.force_z), m.max_force_N),
          handle_W * cut(with_motors(torque_T, m.torque_x, m.torque_y, m.torque_z), m.max_torque_Nm)};
}

}  // namespace remote_touch
