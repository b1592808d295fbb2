#include "runners/operator/device_motors.h"

namespace remote_touch {

namespace {

Vec3 with_motors(const Vec3& v, bool x, bool y, bool z) {
  return {x ? v.x() : 0, y ? v.y() : 0, z ? v.z() : 0};
}

Vec3 cut(const Vec3& v, double max_length) {
  const double length = v.norm();
  return max_length > 0 && length > max_length ? Vec3(v * (max_length / length)) : v;
}

}  // namespace

Parameters parameters(MotorSettings& s) {
  return {
      {"force_x", &s.force_x, 0, 0, "has a motor along the base frame's x"},
      {"force_y", &s.force_y, 0, 0, "along its y"},
      {"force_z", &s.force_z, 0, 0, "along its z"},
      {"torque_x", &s.torque_x, 0, 0, "has a motor about the handle's x, which is the tool's"},
      {"torque_y", &s.torque_y, 0, 0, "about its y"},
      {"torque_z", &s.torque_z, 0, 0, "about its z"},
      {"max_force_N", &s.max_force_N, 0, 1000, "of the device; 0: no limit"},
      {"max_torque_Nm", &s.max_torque_Nm, 0, 100, "of the device; 0: no limit"},
  };
}

Wrench exerted(const MotorSettings& m, const Eigen::Quaterniond& handle_W, const Wrench& commanded) {
  const Vec3 torque_T = handle_W.conjugate() * commanded.torque_Nm;
  return {cut(with_motors(commanded.force_N, m.force_x, m.force_y, m.force_z), m.max_force_N),
          handle_W * cut(with_motors(torque_T, m.torque_x, m.torque_y, m.torque_z), m.max_torque_Nm)};
}

}  // namespace remote_touch
