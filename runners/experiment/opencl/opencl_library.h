// The functions of OpenCL 1.2 that the depth pipeline calls, loaded when a device is requested: the program
// needs only the headers of OpenCL to be built, and no OpenCL to start. Only for use inside this folder.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "runners/libraries/shared_library.h"

namespace remote_touch {

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

// The functions, as pointers. Each is null until the constructor has found the function. Its name is the name
// in the library without the prefix cl.
#define REMOTE_TOUCH_OPENCL_FUNCTIONS(each)                                                                 \
  each(GetPlatformIDs) each(GetPlatformInfo) each(GetDeviceIDs) each(GetDeviceInfo) each(CreateContext)     \
      each(ReleaseContext) each(CreateCommandQueue) each(ReleaseCommandQueue) each(CreateProgramWithSource) \
          each(BuildProgram) each(GetProgramBuildInfo) each(ReleaseProgram) each(CreateKernel)              \
              each(SetKernelArg) each(ReleaseKernel) each(CreateBuffer) each(ReleaseMemObject)              \
                  each(EnqueueWriteBuffer) each(EnqueueWriteBufferRect) each(EnqueueMapBuffer)              \
                      each(EnqueueUnmapMemObject) each(EnqueueNDRangeKernel) each(Finish)

class OpenClLibrary {
 public:
  // Throws InputError if there is no library, or if it lacks a function.
  OpenClLibrary();

// NOLINTNEXTLINE(bugprone-macro-parentheses): a name that is declared takes none.
#define REMOTE_TOUCH_DECLARE(name) decltype(&::cl##name) name = nullptr;
  REMOTE_TOUCH_OPENCL_FUNCTIONS(REMOTE_TOUCH_DECLARE)
#undef REMOTE_TOUCH_DECLARE

 private:
  SharedLibrary library_;
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

}  // namespace remote_touch
