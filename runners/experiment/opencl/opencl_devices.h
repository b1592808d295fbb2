// The OpenCL devices of this machine, with the ability of their arithmetic to keep the bits of the CPU.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "runners/experiment/opencl/opencl_library.h"

namespace remote_touch {

struct OpenClDevice {
  int platform = 0, number = 0;  // the numbers in opencl:PLATFORM:DEVICE
  cl_platform_id platform_id = nullptr;
  cl_device_id id = nullptr;
  std::string name;  // "pthread-..., Portable Computing Language"
  bool is_gpu = false;
  bool has_double = false;       // IEEE double with subnormal numbers
  bool rounds_division = false;  // single division and root are rounded correctly, as double ones always are
  // Reason why it cannot keep the bits; empty: its arithmetic is that of IEEE 754.
  std::string inexact_because;
  // Reason why it cannot compute the pipeline at all; empty: it can.
  std::string unfit_because;

  std::string address() const { return "opencl:" + std::to_string(platform) + ":" + std::to_string(number); }
  std::string full_name() const { return address() + " (" + name + ")"; }
};

// Returns the devices in the order of platforms and devices; empty if no driver is installed. Throws
// OpenClError.
std::vector<OpenClDevice> opencl_devices(const OpenClLibrary& library);

// Returns the same for the library of this process. Loading it and its drivers may take `limit`; after that,
// and as long as they do not answer, throws OpenClTimeout. Throws InputError if there is no library.
inline constexpr std::chrono::milliseconds kListLimit{20000};
std::vector<OpenClDevice> listed_devices(std::chrono::milliseconds limit = kListLimit);

}  // namespace remote_touch
