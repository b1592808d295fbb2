#include "runners/live/devices/device_table.h"

#include <array>
#include <atomic>

#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

// The EntactAPI: mm, mm/s, rad/s, N and N mm, x towards the user, y to the right, z up.
struct Eapi {
  using Handle = void*;
  enum Mode { disabled = 0, force_control = 1 };
  static constexpr int kOk = 1;

  SharedLibrary library{SharedLibrary::Lookup{
      {"libEntactAPI.so", "libentactapi.so"}, "REMOTE_TOUCH_LIBENTACT", "Entact Robotics' EntactAPI"}};
  int (*open)(Handle handles[],
              int size) = library["openEAPI"];  // returns the number of devices that answered
  int (*connect_device)(Handle handles[], int index, char ip_address[]) = library["connectDeviceEAPI"];
  int (*close)() = library["closeEAPI"];
  int (*set_mode)(Handle, int mode) = library["setModeEAPI"];
  int (*home_device)(Handle) = library["homeDeviceEAPI"];
  int (*read_task_position)(Handle, double* position, int size) = library["readTaskPositionEAPI"];
  int (*read_task_velocity)(Handle, double* velocity, int size) = library["readTaskVelocityEAPI"];
  int (*write_force)(Handle, double* force, int size) = library["writeForceEAPI"];
  // Functions that some versions lack. A function that is missing is null.
  int (*is_homed)(Handle) = library.optional("isHomedEAPI");
  int (*get_device_info)(Handle, char* product, char* name, int size) = library.optional("getDeviceInfoEAPI");
};

constexpr double kMetrePerMm = 1e-3, kNmmPerNm = 1e3;

class Entact : public GatedDevice {
 public:
  Entact(const std::string& address, const std::string& subject, Clock& clock) : GatedDevice(clock) {
    try {
      connect(address, subject);
      home(subject);
    } catch (...) {
      eapi_.close();
      throw;
    }
    traits_.name = product();
    traits_.sensed_axes = traits_.actuated_axes = 6;  // the W5D exerts only two of the three torques
  }

  ~Entact() override {
    release();
    eapi_.close();
  }

 private:
  // The pose is the position, then the rotation matrix by rows.
  DeviceFault sense(DeviceReading& reading) noexcept override {
    if (const DeviceFault fault = switch_on()) return fault;
    std::array<double, 12> pose{};
    std::array<double, 6> velocity{};
    if (eapi_.read_task_position(handle_, pose.data(), 12) != Eapi::kOk)
      return {"Entact: the pose cannot be read", -1};
    if (eapi_.read_task_velocity(handle_, velocity.data(), 6) != Eapi::kOk)
      return {"Entact: the velocity cannot be read", -1};
    reading.position_m = from_user_right_up(Vec3(pose.data())) * kMetrePerMm;
    reading.velocity_m_per_s = from_user_right_up(Vec3(velocity.data())) * kMetrePerMm;
    reading.angular_velocity_rad_per_s = from_user_right_up(Vec3(velocity.data() + 3));
    reading.buttons = 0;  // the library reports no buttons
    const Eigen::Matrix3d rotation =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.data() + 3);
    if (!is_rotation(rotation)) return kNoRotation;
    reading.orientation = Eigen::Quaterniond(rotation_from_user_right_up(rotation));
    return {};
  }

  // Enters force control with zero force. The device reports its pose only after a force was written.
  DeviceFault switch_on() noexcept override {
    if (is_released()) return kReleased;
    if (has_motors_on_) return {};
    if (eapi_.set_mode(handle_, Eapi::force_control) != Eapi::kOk)
      return {"Entact: the motors cannot be switched on", -1};
    if (write_wrench({}) != Eapi::kOk) return {"Entact: the force cannot be set", -1};
    has_motors_on_ = true;
    return {};
  }

  DeviceFault exert(const Wrench& wrench) noexcept override {
    if (write_wrench(wrench) != Eapi::kOk) return {"Entact: the force cannot be set", -1};
    return {};
  }

  // No force is written while the motors are off: it is not documented whether such a call returns.
  void switch_off() noexcept override {
    if (has_motors_on_.exchange(false)) write_wrench({});
    eapi_.set_mode(handle_, Eapi::disabled);
  }

  // The address is passed by value, because the vendor's function may write to it.
  void connect(std::string address, const std::string& subject) {
    std::array<Eapi::Handle, 16> handles{};
    const bool is_found = address.empty()
                              ? eapi_.open(handles.data(), static_cast<int>(handles.size())) > 0
                              : eapi_.connect_device(handles.data(), 0, address.data()) == Eapi::kOk;
    handle_ = handles[0];
    if (!is_found || handle_ == nullptr)
      throw InputError(
          subject,
          "no device answers: expected one that is powered, in this network and not used by another "
          "program");
    eapi_.set_mode(handle_, Eapi::disabled);
  }

  // Homing is known to fail now and then without a cause, so it is tried up to 20 times.
  void home(const std::string& subject) {
    if (eapi_.is_homed != nullptr && eapi_.is_homed(handle_) == Eapi::kOk) return;
    for (int attempt = 0; attempt < 20; ++attempt)
      if (eapi_.home_device(handle_) == Eapi::kOk) return;
    throw InputError(subject,
                     "cannot be homed; hold the handle in its calibration position and open it again");
  }

  std::string product() const {
    std::array<char, 128> model{}, name{};
    if (eapi_.get_device_info == nullptr ||
        eapi_.get_device_info(handle_, model.data(), name.data(), static_cast<int>(model.size()) - 1) !=
            Eapi::kOk)
      return "Entact";
    const std::string text = model.data();
    return text.substr(0, text.find_first_of("\r\n"));
  }

  int write_wrench(const Wrench& wrench) noexcept {
    const Vec3 f = to_user_right_up(wrench.force_N), t = to_user_right_up(wrench.torque_Nm) * kNmmPerNm;
    std::array<double, 6> commanded{f.x(), f.y(), f.z(), t.x(), t.y(), t.z()};
    return eapi_.write_force(handle_, commanded.data(), 6);
  }

  Eapi eapi_;
  Eapi::Handle handle_ = nullptr;
  std::atomic<bool> has_motors_on_{false};
};

}  // namespace

std::unique_ptr<HapticDevice> open_entact(const std::string& address, Clock& clock) {
  return std::make_unique<Entact>(address, address.empty() ? "entact" : "entact:" + address, clock);
}

Availability entact_availability() {
  return availability_of_library<Eapi>();
}

}  // namespace remote_touch
