// The double of the OpenCL library, loaded by the program of a test. It stays loaded.
#pragma once

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

#include "tests/doubles/opencl_double.h"

namespace remote_touch {

// The library exports extern "C" remote_touch::OpenClDouble* opencl_double().
inline OpenClDouble& library() {
  static void* const loaded = dlopen(REMOTE_TOUCH_DOUBLE_OPENCL, RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) {
    std::fprintf(stderr, "%s\n", dlerror());
    std::abort();
  }
  static OpenClDouble& one = *reinterpret_cast<OpenClDouble* (*)()>(dlsym(loaded, "opencl_double"))();
  return one;
}

}  // namespace remote_touch
