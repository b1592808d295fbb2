// The functions of OpenHaptics' HD library that its adapter calls. Units: mm, mm/s, rad/s, N, mN m and N/mm.
// Matrices are stored column by column. Axes: x to the right, y up, z towards the user.
#pragma once

#include "runners/libraries/shared_library.h"

namespace remote_touch {

struct HdLibrary {
  HdLibrary();  // throws InputError if the library is not found

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

  SharedLibrary library;
  unsigned (*init_device)(const char* name) = nullptr;
  void (*disable_device)(unsigned device) = nullptr;
  void (*make_current_device)(unsigned device) = nullptr;
  void (*begin_frame)(unsigned device) = nullptr;
  void (*end_frame)(unsigned device) = nullptr;
  Error (*get_error)() = nullptr;
  const char* (*get_error_string)(unsigned code) = nullptr;
  void (*enable)(unsigned capability) = nullptr;
  void (*disable)(unsigned capability) = nullptr;
  void (*get_doublev)(unsigned what, double* values) = nullptr;
  void (*get_integerv)(unsigned what, int* values) = nullptr;
  void (*set_doublev)(unsigned what, const double* values) = nullptr;
  const char* (*get_string)(unsigned what) = nullptr;
  unsigned long (*schedule_asynchronous)(Callback*, void* self, unsigned short priority) = nullptr;
  void (*unschedule)(unsigned long callback) = nullptr;
  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
};

}  // namespace remote_touch
