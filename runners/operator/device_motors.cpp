#include "runners/operator/device_motors.h"

namespace remote_touch {

namespace {

Vec3 with_motors(const Vec3& v, bool x, bool y, bool z) {
  return {x ? v.x() : 0, y ? v.y() : 0, z ? v.z() : 0};
}

Vec3 cut(const Vec3& v, double longest) {
  const double length = v.norm();
  return longest > 0 && length > longest ? Vec3(v * (longest / length)) : v;
}

}  // namespace

Parameters parameters(MotorSettings& s) {
  return {
      {"moves_x", &s.moves_x, 0, 0, "has a motor along the base frame's x"},
      {"moves_y", &s.moves_y, 0, 0, "along its y"},
      {"moves_z", &s.moves_z, 0, 0, "along its z"},
      {"turns_x", &s.turns_x, 0, 0, "has a motor about the handle's x, which is the tool's"},
      {"turns_y", &s.turns_y, 0, 0, "about its y"},
      {"turns_z", &s.turns_z, 0, 0, "about its z"},
      {"largest_force_N", &s.largest_force_N, 0, 1000, "of the device; 0: no limit"},
      {"largest_torque_Nm", &s.largest_torque_Nm, 0, 100, "of the device; 0: no limit"},
  };
}

Wrench exerted(const MotorSettings& m, const Eigen::Quaterniond& handle_W, const Wrench& told) {
  const Vec3 torque_T = handle_W.conjugate() * told.torque_Nm;
  return {cut(with_motors(told.force_N, m.moves_x, m.moves_y, m.moves_z), m.largest_force_N),
          handle_W * cut(with_motors(torque_T, m.turns_x, m.turns_y, m.turns_z), m.largest_torque_Nm)};
}

}  // namespace remote_touch
