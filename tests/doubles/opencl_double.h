// How a test sets the double of the OpenCL library: which call fails, and how.
#pragma once

#include <dlfcn.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace remote_touch {

// What every frame calls. Buffers are made for the first one of a size only, and a rectangle is written where
// depths are no integers.
inline constexpr const char* kFrameFunctions[] = {"clEnqueueWriteBuffer",    "clSetKernelArg",
                                                  "clEnqueueNDRangeKernel",  "clEnqueueMapBuffer",
                                                  "clEnqueueUnmapMemObject", "clFinish"};

struct OpenClDouble {
  // The function that fails from the given call on, 1 for its first, counted from reset(); empty: none.
  std::string failing;
  int failing_call = 0;
  int code = -5;              // that it returns: CL_OUT_OF_RESOURCES
  bool hangs = false;         // it does not return instead, until let_go
  bool is_imprecise = false;  // the device says that it flushes subnormal numbers
  bool is_wrong = false;      // the device's normals are a little off
  std::atomic<bool> let_go{false};
  std::atomic<int> calls{0};        // of the failing function
  std::atomic<int> kernel_runs{0};  // since the library was loaded
  std::atomic<int> objects{0};      // that exist: contexts, queues, programs, kernels, buffers

  void reset() {
    failing.clear(), failing_call = 0, code = -5, hangs = is_imprecise = is_wrong = false;
    let_go = false, calls = 0;
  }
};

// In the library: extern "C" remote_touch::OpenClDouble* opencl_double(). It stays loaded.
inline OpenClDouble& loaded_opencl_double(const char* file) {
  void* const loaded = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) {
    std::fprintf(stderr, "%s\n", dlerror());
    std::abort();
  }
  return *reinterpret_cast<OpenClDouble* (*)()>(dlsym(loaded, "opencl_double"))();
}

}  // namespace remote_touch
