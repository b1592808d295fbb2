// The OpenCL devices of this machine, and whether their arithmetic can keep the bits of the CPU.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "runners/opencl/opencl_library.h"

namespace remote_touch {

struct OpenClDevice {
  int platform = 0, number = 0;  // as in opencl:PLATFORM:DEVICE
  cl_platform_id platform_id = nullptr;
  cl_device_id id = nullptr;
  std::string name;  // "pthread-..., Portable Computing Language"
  bool is_gpu = false;
  bool has_double = false;       // IEEE double with subnormal numbers
  bool rounds_division = false;  // single division and root are rounded correctly, as double ones always are
  // Why it cannot keep the bits; empty: its arithmetic is IEEE's.
  std::string inexact_because;
  // Why it cannot compute the pipeline at all; empty: it can.
  std::string unfit_because;

  std::string address() const { return "opencl:" + std::to_string(platform) + ":" + std::to_string(number); }
  std::string full_name() const { return address() + " (" + name + ")"; }
};

// In the order of platforms and devices; empty where no driver is installed. Throws OpenClError.
std::vector<OpenClDevice> opencl_devices(const OpenClLibrary& library);

// The same of the library of this process. To load it and its drivers may take kListLimit; after that, and as
// long as they do not answer, this throws OpenClTimeout. Throws InputError where there is no library.
inline constexpr std::chrono::milliseconds kListLimit{20000};
std::vector<OpenClDevice> listed_devices(std::chrono::milliseconds limit = kListLimit);

}  // namespace remote_touch
