// Settings by which a test makes the double of the OpenCL library fail: which call fails, and in which way.
#pragma once

#include <dlfcn.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <type_traits>

namespace remote_touch {

// Functions that every frame calls. Others are left out: buffers are made only for the first frame of a size,
// and clEnqueueWriteBufferRect is called only if depths are no integers.
inline constexpr const char* kFrameFunctions[] = {"clEnqueueWriteBuffer",    "clSetKernelArg",
                                                  "clEnqueueNDRangeKernel",  "clEnqueueMapBuffer",
                                                  "clEnqueueUnmapMemObject", "clFinish"};

// A thread that abandons a device may call the library while a test sets it anew, and even when the program
// ends. All of it is therefore atomic, and nothing is destroyed.
struct OpenClDouble {
  // A literal: the function that fails from call failing_call on. Its calls are counted from 1 since reset().
  // "" means none.
  std::atomic<const char*> failing{""};
  std::atomic<int> failing_call{0};
  std::atomic<int> code{-5};              // error code that it returns: CL_OUT_OF_RESOURCES
  std::atomic<bool> hangs{false};         // it hangs until is_released before it returns
  std::atomic<bool> is_imprecise{false};  // the device reports that it flushes subnormal numbers
  std::atomic<bool> is_wrong{false};      // the device's normals are a little off
  std::atomic<bool> is_released{false};
  std::atomic<int> calls{0};        // number of calls of the failing function
  std::atomic<int> kernel_runs{0};  // since the library was loaded
  std::atomic<int> objects{0};      // objects alive: contexts, queues, programs, kernels, buffers

  void reset() {
    failing = "", failing_call = 0, code = -5;
    hangs = false, is_imprecise = false, is_wrong = false, is_released = false, calls = 0;
  }
};
static_assert(std::is_trivially_destructible_v<OpenClDouble>);

#ifdef REMOTE_TOUCH_DOUBLE_OPENCL
// The double, loaded by the program of a test. It stays loaded. The library exports extern "C"
// remote_touch::OpenClDouble* opencl_double().
inline OpenClDouble& library() {
  static void* const loaded = dlopen(REMOTE_TOUCH_DOUBLE_OPENCL, RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) {
    std::fprintf(stderr, "%s\n", dlerror());
    std::abort();
  }
  static OpenClDouble& one = *reinterpret_cast<OpenClDouble* (*)()>(dlsym(loaded, "opencl_double"))();
  return one;
}
#endif

}  // namespace remote_touch
