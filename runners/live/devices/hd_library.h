// The functions of OpenHaptics' HD library that its adapter calls. Units: mm, mm/s, rad/s, N, mN m and N/mm.
// Matrices are stored column by column. Axes: x to the right, y up, z towards the user.
#pragma once

#include "runners/live/devices/vendor_library.h"

namespace remote_touch {

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
  VendorLibrary library{SharedLibrary::Lookup{
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

}  // namespace remote_touch
