// The OpenCL devices of this machine, and the functions that the depth pipeline calls there.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120

#include <CL/cl.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "runners/libraries/shared_library.h"

namespace remote_touch {

// The functions of OpenCL 1.2 that the depth pipeline calls, loaded when a device is requested: the program
// needs only the headers of OpenCL to be built, and no OpenCL to start. Only for use inside this folder.

// A call of OpenCL failed: "clFinish: CL_OUT_OF_RESOURCES (-5)".
class OpenClError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
// A driver did not answer within a limit.
class OpenClTimeout : public OpenClError {
 public:
  using OpenClError::OpenClError;
};

// The names of the functions in the library, without the prefix cl.
#define REMOTE_TOUCH_OPENCL_FUNCTIONS(each)                                                                 \
  each(GetPlatformIDs) each(GetPlatformInfo) each(GetDeviceIDs) each(GetDeviceInfo) each(CreateContext)     \
      each(ReleaseContext) each(CreateCommandQueue) each(ReleaseCommandQueue) each(CreateProgramWithSource) \
          each(BuildProgram) each(GetProgramBuildInfo) each(ReleaseProgram) each(CreateKernel)              \
              each(SetKernelArg) each(ReleaseKernel) each(CreateBuffer) each(ReleaseMemObject)              \
                  each(EnqueueWriteBuffer) each(EnqueueWriteBufferRect) each(EnqueueMapBuffer)              \
                      each(EnqueueUnmapMemObject) each(EnqueueNDRangeKernel) each(Finish)

struct OpenClLibrary {
  // Throws InputError if there is no library, or if it lacks a function.
  OpenClLibrary();

  SharedLibrary library;
// NOLINTNEXTLINE(bugprone-macro-parentheses): a name that is declared takes none.
#define REMOTE_TOUCH_DECLARE(name) decltype(&::cl##name) name = library["cl" #name];
  REMOTE_TOUCH_OPENCL_FUNCTIONS(REMOTE_TOUCH_DECLARE)
#undef REMOTE_TOUCH_DECLARE
};

// Returns the library of this process. Loads it at the first call. Throws as the constructor does; the next
// call then tries again.
const OpenClLibrary& opencl_library();

// Throws OpenClError unless the code is CL_SUCCESS.
void require(cl_int code, const char* function);

// An object of OpenCL, released with its owner.
template <class Object>
class OpenClObject {
 public:
  using Release = cl_int(CL_API_CALL*)(Object);
  OpenClObject() = default;
  OpenClObject(Object object, Release release) : object_(object), release_(release) {}
  OpenClObject(OpenClObject&& other) noexcept
      : object_(std::exchange(other.object_, nullptr)), release_(other.release_) {}
  OpenClObject& operator=(OpenClObject&& other) noexcept {
    std::swap(object_, other.object_), std::swap(release_, other.release_);
    return *this;
  }
  ~OpenClObject() {
    if (object_ != nullptr) release_(object_);
  }
  Object get() const { return object_; }

 private:
  Object object_ = nullptr;
  Release release_ = nullptr;
};

// The OpenCL devices of this machine, and whether their arithmetic can give the same bits as the CPU.
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
