#include "runners/live/devices/device_table.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

// The DHD library, version 3: SI units, x towards the user, y to the right, z up. A result below 0 is an
// error. A result above 0 is a notice about the timing or about motors at their limit.
struct Dhd {
  SharedLibrary library{
      SharedLibrary::Lookup{{"libdhd.so.3", "libdhd.so"}, "REMOTE_TOUCH_LIBDHD", "Force Dimension's SDK"}};
  int (*get_device_count)() = library["dhdGetDeviceCount"];
  int (*open_id)(char id) = library["dhdOpenID"];
  int (*close)(char id) = library["dhdClose"];
  bool (*has_wrist)(char id) = library["dhdHasWrist"];
  int (*enable_force)(unsigned char on, char id) = library["dhdEnableForce"];
  unsigned (*get_button_mask)(char id) = library["dhdGetButtonMask"];
  int (*get_position_and_orientation_frame)(double* x, double* y, double* z, double frame[3][3],
                                            char id) = library["dhdGetPositionAndOrientationFrame"];
  int (*get_linear_velocity)(double* x, double* y, double* z, char id) = library["dhdGetLinearVelocity"];
  int (*get_angular_velocity_rad)(double* x, double* y, double* z,
                                  char id) = library["dhdGetAngularVelocityRad"];
  int (*set_force_and_torque_and_gripper_force)(double fx, double fy, double fz, double tx, double ty,
                                                double tz, double gripper,
                                                char id) = library["dhdSetForceAndTorqueAndGripperForce"];
  const char* (*error_get_last_str)() = library["dhdErrorGetLastStr"];
  // Functions that older versions lack. A function that is missing is null.
  int (*error_get_last)() = library.optional("dhdErrorGetLast");
  const char* (*get_system_name)(char id) = library.optional("dhdGetSystemName");
  bool (*has_active_wrist)(char id) = library.optional("dhdHasActiveWrist");
  int (*stop)(char id) = library.optional("dhdStop");
  double (*get_max_force)(char id) = library.optional("dhdGetMaxForce");
  double (*get_max_torque)(char id) = library.optional("dhdGetMaxTorque");
};

constexpr std::array<KnownFault, 5> kDhdFaults{{
    {2, "Force Dimension: the device does not communicate"},
    {5, "Force Dimension: the device is no longer found"},
    {7, "Force Dimension: the device did not answer in time"},
    {12, "Force Dimension: the device is not ready"},
    {20, "Force Dimension: another program has the device"},
}};

class ForceDimension : public GatedDevice {
 public:
  ForceDimension(int number, const std::string& subject, Clock& clock) : GatedDevice(clock) {
    const int count = dhd_.get_device_count();
    if (count <= 0)
      throw InputError(
          subject,
          "no device is connected: expected one that is powered, and whose USB port this user may open");
    if (number >= count)
      throw InputError(subject, "no such device: expected 0 to " + std::to_string(count - 1));
    const int id = dhd_.open_id(static_cast<char>(number));
    if (id < 0)
      throw InputError(subject, std::string("cannot be opened (") + dhd_.error_get_last_str() +
                                    "): expected a device that no other program has");
    id_ = static_cast<char>(id);
    learn_traits();
  }

  ~ForceDimension() override {
    release();
    dhd_.close(id_);
  }

 private:
  // The orientation and the angular velocity of a device without a wrist are not used.
  DeviceFault sense(DeviceReading& reading) noexcept override {
    Vec3 p, v, w = Vec3::Zero();
    double frame[3][3];
    if (dhd_.get_position_and_orientation_frame(&p.x(), &p.y(), &p.z(), frame, id_) < 0)
      return last_fault("Force Dimension: the pose cannot be read");
    if (dhd_.get_linear_velocity(&v.x(), &v.y(), &v.z(), id_) < 0)
      return last_fault("Force Dimension: the velocity cannot be read");
    reading.position_m = from_user_right_up(p);
    reading.velocity_m_per_s = from_user_right_up(v);
    reading.buttons = dhd_.get_button_mask(id_);
    if (traits_.sensed_axes < 6) return {};
    if (dhd_.get_angular_velocity_rad(&w.x(), &w.y(), &w.z(), id_) < 0)
      return last_fault("Force Dimension: the angular velocity cannot be read");
    reading.angular_velocity_rad_per_s = from_user_right_up(w);
    const Eigen::Matrix3d rotation =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&frame[0][0]);
    if (!is_rotation(rotation)) return kNoRotation;
    reading.orientation = Eigen::Quaterniond(rotation_from_user_right_up(rotation));
    return {};
  }

  // Zero force is written before the motors are switched on, because they first exert the last written force.
  DeviceFault switch_on() noexcept override {
    if (write_wrench(Vec3::Zero(), Vec3::Zero()) < 0 || dhd_.enable_force(1, id_) < 0)
      return last_fault("Force Dimension: the motors cannot be switched on");
    return {};
  }

  DeviceFault exert(const Wrench& wrench) noexcept override {
    const Vec3 torque_Nm = traits_.actuated_axes == 6 ? wrench.torque_Nm : Vec3::Zero();
    if (write_wrench(wrench.force_N, torque_Nm) < 0)
      return last_fault("Force Dimension: the force cannot be set");
    return {};
  }

  // Errors are ignored: there is no caller left to report them to.
  void switch_off() noexcept override {
    write_wrench(Vec3::Zero(), Vec3::Zero());
    dhd_.enable_force(0, id_);
    if (dhd_.stop != nullptr) dhd_.stop(id_);
  }

  // The library reports a limit below 0 if none is set. Such a limit is stored as 0 (unknown).
  void learn_traits() {
    if (dhd_.get_system_name != nullptr)
      if (const char* name = dhd_.get_system_name(id_); name != nullptr) traits_.name = name;
    traits_.sensed_axes = dhd_.has_wrist(id_) ? 6 : 3;
    traits_.actuated_axes = dhd_.has_active_wrist != nullptr && dhd_.has_active_wrist(id_) ? 6 : 3;
    if (dhd_.get_max_force != nullptr) traits_.max_force_N = std::max(0.0, dhd_.get_max_force(id_));
    if (dhd_.get_max_torque != nullptr && traits_.actuated_axes == 6)
      traits_.max_torque_Nm = std::max(0.0, dhd_.get_max_torque(id_));
  }

  int write_wrench(const Vec3& force_N, const Vec3& torque_Nm) noexcept {
    const Vec3 f = to_user_right_up(force_N), t = to_user_right_up(torque_Nm);
    return dhd_.set_force_and_torque_and_gripper_force(f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), 0, id_);
  }

  DeviceFault last_fault(const char* what) const noexcept {
    return fault_of(kDhdFaults, dhd_.error_get_last != nullptr ? dhd_.error_get_last() : -1, what);
  }

  Dhd dhd_;
  char id_ = -1;
};

int device_number(const std::string& address, const std::string& subject) {
  int number = 0;
  const char* end = address.data() + address.size();
  const auto [stop, error] = std::from_chars(address.data(), end, number);
  if (!address.empty() && (error != std::errc() || stop != end || number < 0 || number > 127))
    throw InputError(subject, "not the number of a device: expected 0 for the first, 1, ...");
  return number;
}

}  // namespace

std::unique_ptr<HapticDevice> open_force_dimension(const std::string& address, Clock& clock) {
  const std::string subject = "fd:" + (address.empty() ? "0" : address);
  return std::make_unique<ForceDimension>(device_number(address, subject), subject, clock);
}

Availability force_dimension_availability() {
  return availability_of([] {
    const Dhd dhd;
    const int count = dhd.get_device_count();
    return Availability{
        .found = count > 0,
        .detail = dhd.library.file() + ": " +
                  (count > 0 ? std::to_string(count) + (count == 1 ? " device" : " devices")
                             : "no device is connected or this user may not open its USB port")};
  });
}

}  // namespace remote_touch
