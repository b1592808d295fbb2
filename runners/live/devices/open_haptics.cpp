#include "runners/live/devices/device_table.h"

#include <array>
#include <atomic>

#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

// The functions of OpenHaptics' HD library that its adapter calls. Units: mm, mm/s, rad/s, N, mN m and N/mm.
// Matrices are stored column by column. Axes: x to the right, y up, z towards the user.
struct HdLibrary {
  struct Error {
    unsigned code = 0;
    int internal_code = 0;
    unsigned device = 0;
  };
  using Callback = unsigned(void* self);

  enum : unsigned {
    current_buttons = 0x2000,
    current_velocity = 0x2051,
    current_transform = 0x2052,
    current_angular_velocity = 0x2053,
    device_model_type = 0x2501,
    input_dof = 0x2553,
    output_dof = 0x2554,
    nominal_max_stiffness = 0x2602,
    nominal_max_force = 0x2603,
    nominal_max_continuous_force = 0x2604,
    nominal_max_torque = 0x2622,
    current_force = 0x2700,
    current_torque = 0x2701,
    force_output = 0x4000,
    invalid_handle = 0xFFFFFFFF,
    callback_done = 0,
    callback_continue = 1,
  };
  static constexpr unsigned short kMaxPriority = 0xFFFF;

  // The constructor throws InputError if the library is not found.
  SharedLibrary library{SharedLibrary::Lookup{
      {"libHD.so", "libHD.so.3.5", "libHD.so.3.4"}, "REMOTE_TOUCH_LIBHD", "3D Systems' OpenHaptics"}};
  unsigned (*init_device)(const char* name) = library["hdInitDevice"];
  void (*disable_device)(unsigned device) = library["hdDisableDevice"];
  void (*make_current_device)(unsigned device) = library["hdMakeCurrentDevice"];
  void (*begin_frame)(unsigned device) = library["hdBeginFrame"];
  void (*end_frame)(unsigned device) = library["hdEndFrame"];
  Error (*get_error)() = library["hdGetError"];
  const char* (*get_error_string)(unsigned code) = library["hdGetErrorString"];
  void (*enable)(unsigned capability) = library["hdEnable"];
  void (*disable)(unsigned capability) = library["hdDisable"];
  void (*get_doublev)(unsigned what, double* values) = library["hdGetDoublev"];
  void (*get_integerv)(unsigned what, int* values) = library["hdGetIntegerv"];
  void (*set_doublev)(unsigned what, const double* values) = library["hdSetDoublev"];
  const char* (*get_string)(unsigned what) = library["hdGetString"];
  unsigned long (*schedule_asynchronous)(Callback*, void* self,
                                         unsigned short priority) = library["hdScheduleAsynchronous"];
  void (*unschedule)(unsigned long callback) = library["hdUnschedule"];
  void (*start_scheduler)() = library["hdStartScheduler"];
  void (*stop_scheduler)() = library["hdStopScheduler"];
};

constexpr double kMPerMm = 1e-3, kMmPerM = 1e3, kNmPerMNm = 1e-3, kMNmPerNm = 1e3;
constexpr double kCheckPeriod_s = 0.005, kMaxSilence_s = 1;

constexpr std::array<KnownFault, 10> kHdFaults{{
    {0x0200, "OpenHaptics: the motors are warm"},
    {0x0201, "OpenHaptics: the force is too large for the device"},
    {0x0202, "OpenHaptics: the force changes too fast for the device"},
    {0x0203, "OpenHaptics: the handle moves too fast for the device"},
    {0x0204, "OpenHaptics: the device refuses the force"},
    {0x0300, "OpenHaptics: the device has a fault"},
    {0x0302, "OpenHaptics: the device does not communicate"},
    {0x0303, "OpenHaptics: the connection of the device is not set up"},
    {0x0304, "OpenHaptics: the scheduler has no timer"},
    {0x0501, "OpenHaptics: the scheduler is full"},
}};

class OpenHaptics : public GatedDevice {
 public:
  OpenHaptics(const std::string& address, const std::string& subject, Clock& clock) : GatedDevice(clock) {
    take_errors();  // an earlier device may have left some
    const bool is_default = address.empty() || address == "Default Device";
    device_ = hd_.init_device(is_default ? nullptr : address.c_str());
    const HdLibrary::Error error = take_errors();
    if (error.code != 0 || device_ == HdLibrary::invalid_handle) {
      const char* text = hd_.get_error_string(error.code);
      throw InputError(subject, std::string("cannot be opened (") +
                                    (text != nullptr ? text : "unknown error") + ", " +
                                    std::to_string(error.code) + "/" + std::to_string(error.internal_code) +
                                    "): expected the name of a connected device in the vendor's setup");
    }
    learn_traits();
  }

  // Writes zero force in a last frame, for the program that switches the motors on next.
  ~OpenHaptics() override {
    release();
    constexpr std::array<double, 3> kNone{};
    hd_.begin_frame(device_);
    hd_.set_doublev(HdLibrary::current_force, kNone.data());
    hd_.end_frame(device_);
    hd_.disable_device(device_);
  }

  void run(const DeviceTick& tick) override {
    tick_ = &tick;
    has_ended_ = false;
    frame_fault_ = {};
    hd_.make_current_device(device_);
    const unsigned long callback = hd_.schedule_asynchronous(&on_schedule, this, HdLibrary::kMaxPriority);
    hd_.start_scheduler();
    const DeviceFault fault = newest_error("OpenHaptics: the scheduler does not start");
    const bool is_done = !fault && is_scheduler_done();
    if (!is_done) hd_.unschedule(callback);
    hd_.stop_scheduler();
    if (is_done || has_ended_) return;
    switch_off();
    scheduler_fault_ = fault ? fault : DeviceFault{"OpenHaptics: the scheduler has stopped calling", 0};
    HapticDevice::run(tick);
  }

 private:
  // The transform has the position in its last column.
  DeviceFault sense(DeviceReading& reading) noexcept override {
    if (scheduler_fault_) return scheduler_fault_;
    if (frame_fault_) return frame_fault_;
    Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
    Vec3 velocity = Vec3::Zero(), turning = Vec3::Zero();
    int buttons = 0;
    hd_.get_doublev(HdLibrary::current_transform, pose.data());
    hd_.get_doublev(HdLibrary::current_velocity, velocity.data());
    hd_.get_doublev(HdLibrary::current_angular_velocity, turning.data());
    hd_.get_integerv(HdLibrary::current_buttons, &buttons);
    if (const DeviceFault fault = newest_error("OpenHaptics: the state cannot be read")) return fault;
    reading.position_m = pose.topRightCorner<3, 1>() * kMPerMm;
    reading.velocity_m_per_s = velocity * kMPerMm;
    reading.angular_velocity_rad_per_s = turning;
    reading.buttons = static_cast<std::uint32_t>(buttons);
    const Eigen::Matrix3d rotation = pose.topLeftCorner<3, 3>();
    if (!is_rotation(rotation)) return kNoRotation;
    reading.orientation = Eigen::Quaterniond(rotation);
    return {};
  }

  DeviceFault switch_on() noexcept override {
    if (scheduler_fault_) return scheduler_fault_;
    hd_.enable(HdLibrary::force_output);
    return newest_error("OpenHaptics: the motors cannot be switched on");
  }

  DeviceFault exert(const Wrench& wrench) noexcept override {
    if (scheduler_fault_) return scheduler_fault_;
    hd_.set_doublev(HdLibrary::current_force, wrench.force_N.data());
    if (traits_.actuated_axes == 6) {
      const Vec3 torque_mNm = wrench.torque_Nm * kMNmPerNm;
      hd_.set_doublev(HdLibrary::current_torque, torque_mNm.data());
    }
    has_written_ = true;
    return newest_error("OpenHaptics: the force cannot be set");
  }

  // Disables the motors and writes no force: a force can be written only within a frame, and frames belong to
  // the scheduler's thread.
  void switch_off() noexcept override {
    hd_.make_current_device(device_);
    hd_.disable(HdLibrary::force_output);
  }

  void learn_traits() {
    const auto number = [this](unsigned what) {
      double value = 0;
      hd_.get_doublev(what, &value);
      return take_errors().code == 0 ? value : 0;
    };
    const auto axes = [this](unsigned what) {
      int count = 0;
      hd_.get_integerv(what, &count);
      return take_errors().code == 0 && count >= 6 ? 6 : 3;
    };
    if (const char* model = hd_.get_string(HdLibrary::device_model_type); model != nullptr)
      traits_.name = model;
    traits_.sensed_axes = axes(HdLibrary::input_dof);
    traits_.actuated_axes = axes(HdLibrary::output_dof);
    traits_.max_force_N = number(HdLibrary::nominal_max_force);
    traits_.continuous_force_N = number(HdLibrary::nominal_max_continuous_force);
    traits_.max_stiffness_N_per_m = number(HdLibrary::nominal_max_stiffness) * kMmPerM;
    if (traits_.actuated_axes == 6) traits_.max_torque_Nm = number(HdLibrary::nominal_max_torque) * kNmPerMNm;
  }

  // Returns the newest error. The library keeps a stack of errors. It is emptied, so that an older error is
  // not taken for that of a later call.
  HdLibrary::Error take_errors() const noexcept {
    constexpr int kMost = 100;  // a library may never run out of errors
    const HdLibrary::Error newest = hd_.get_error();
    for (int i = 0; newest.code != 0 && i < kMost && hd_.get_error().code != 0;) ++i;
    return newest;
  }

  DeviceFault newest_error(const char* what) const noexcept {
    const HdLibrary::Error error = take_errors();
    return error.code == 0 ? DeviceFault{} : fault_of(kHdFaults, static_cast<int>(error.code), what);
  }

  // Makes one tick in one frame. Writes zero force if the tick wrote none, because the device would then keep
  // the force of the frame before. Also writes zero after release(), and in the last frame, because nothing
  // would set the force to zero after it.
  bool frame() noexcept {
    hd_.begin_frame(device_);
    if (const DeviceFault fault = newest_error("OpenHaptics: the state cannot be read")) frame_fault_ = fault;
    has_written_ = false;
    const bool continues = (*tick_)();
    if (!has_written_ || is_released() || !continues) exert({});
    hd_.end_frame(device_);
    frame_fault_ = newest_error("OpenHaptics: the force cannot be set");
    return continues;
  }

  // Waits for the end of the ticks. Returns true after the last tick; false if no callback came for longer
  // than kMaxSilence_s although none is in progress.
  bool is_scheduler_done() noexcept {
    long before = -1;
    for (double called_s = 0; !has_ended_; clock().sleep_s(kCheckPeriod_s)) {
      const double now_s = clock().now_s();
      if (in_callback_ || callbacks_ != before) {
        before = callbacks_, called_s = now_s;
      } else if (now_s - called_s > kMaxSilence_s) {
        return false;
      }
    }
    return true;
  }

  static unsigned on_schedule(void* self) noexcept {
    OpenHaptics& device = *static_cast<OpenHaptics*>(self);
    device.in_callback_ = true;
    ++device.callbacks_;
    const bool continues = device.frame();
    device.in_callback_ = false;
    if (continues) return HdLibrary::callback_continue;
    device.has_ended_ = true;
    return HdLibrary::callback_done;
  }

  HdLibrary hd_;
  unsigned device_ = HdLibrary::invalid_handle;

  // Members used only by the thread of the ticks.
  DeviceFault frame_fault_;   // fault at the end of the frame before, or at the beginning of this one
  bool has_written_ = false;  // true if a force was written in this frame

  DeviceFault scheduler_fault_;  // set only while no callback can be in progress
  const DeviceTick* tick_ = nullptr;
  std::atomic<long> callbacks_{0};
  std::atomic<bool> in_callback_{false}, has_ended_{false};
};

}  // namespace

std::unique_ptr<HapticDevice> open_open_haptics(const std::string& address, Clock& clock) {
  return std::make_unique<OpenHaptics>(address, "touch:" + (address.empty() ? "Default Device" : address),
                                       clock);
}

Availability open_haptics_availability() {
  return availability_of_library<HdLibrary>();
}

}  // namespace remote_touch
