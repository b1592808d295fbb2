#include "runners/experiment/opencl/opencl_library.h"

#include <mutex>

namespace remote_touch {

namespace {

const SharedLibrary::Lookup kOpenClLibrary{
    {"libOpenCL.so.1"},
    "REMOTE_TOUCH_LIBOPENCL",
    "the OpenCL loader (Debian: ocl-icd-libopencl1); a device comes with its driver (Debian: "
    "pocl-opencl-icd for the processor)"};

struct NamedCode {
  cl_int code;
  const char* name;
};
constexpr NamedCode kCodes[] = {
    {CL_DEVICE_NOT_FOUND, "CL_DEVICE_NOT_FOUND"},
    {CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE"},
    {CL_COMPILER_NOT_AVAILABLE, "CL_COMPILER_NOT_AVAILABLE"},
    {CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
    {CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES"},
    {CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY"},
    {CL_BUILD_PROGRAM_FAILURE, "CL_BUILD_PROGRAM_FAILURE"},
    {CL_INVALID_VALUE, "CL_INVALID_VALUE"},
    {CL_INVALID_COMMAND_QUEUE, "CL_INVALID_COMMAND_QUEUE"},
    {-1001, "CL_PLATFORM_NOT_FOUND_KHR"},  // the loader returns it if no driver is installed
};

}  // namespace

OpenClLibrary::OpenClLibrary() : library_(kOpenClLibrary) {
#define REMOTE_TOUCH_FIND(name) library_.find("cl" #name, name);
  REMOTE_TOUCH_OPENCL_FUNCTIONS(REMOTE_TOUCH_FIND)
#undef REMOTE_TOUCH_FIND
}

const OpenClLibrary& opencl_library() {
  // The library is never freed, because drivers leave threads behind, and objects may be released late.
  static std::mutex mutex;
  static const OpenClLibrary* one = nullptr;
  const std::lock_guard lock(mutex);
  if (one == nullptr) one = new OpenClLibrary;
  return *one;
}

void require(cl_int code, const char* function) {
  if (code == CL_SUCCESS) return;
  const char* name = "OpenCL error";
  for (const NamedCode& each : kCodes)
    if (each.code == code) name = each.name;
  throw OpenClError(std::string(function) + ": " + name + " (" + std::to_string(code) + ")");
}

}  // namespace remote_touch
