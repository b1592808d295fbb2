// The OpenCL devices of this machine, and whether their arithmetic can give the same bits as the CPU.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "runners/experiment/opencl/opencl_library.h"

namespace remote_touch {

struct OpenClDevice {
  int platform = 0, number = 0;  // the numbers in opencl:PLATFORM:DEVICE
  cl_device_id id = nullptr;
  std::string name;  // "pthread-..., Portable Computing Language"
  bool is_gpu = false;
  bool has_double = false;       // has double precision, perhaps without subnormal numbers
  bool rounds_division = false;  // single division and root are rounded correctly, as double ones always are
  // Reason why it cannot give the same bits as the CPU; empty: its arithmetic is that of IEEE 754.
  std::string inexact_because;
  // Reason why it cannot compute the pipeline at all; empty: it can.
  std::string unfit_because;

  std::string address() const { return "opencl:" + std::to_string(platform) + ":" + std::to_string(number); }
  std::string full_name() const { return address() + " (" + name + ")"; }
};

// Returns the devices in the order of platforms and devices; empty if no driver is installed. Throws
// OpenClError.
std::vector<OpenClDevice> opencl_devices(const OpenClLibrary& library);

// Returns the devices of the library of this process, which the first call loads. Throws OpenClTimeout if the
// library and its drivers do not answer within `limit`, and at once in later calls until they have answered.
// Throws InputError if there is no library, and OpenClError as opencl_devices() does.
inline constexpr std::chrono::milliseconds kListLimit{20000};
std::vector<OpenClDevice> listed_devices(std::chrono::milliseconds limit = kListLimit);

}  // namespace remote_touch
