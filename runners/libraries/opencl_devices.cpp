#include "runners/libraries/opencl_devices.h"

#include <atomic>
#include <memory>
#include <mutex>

#include "runners/libraries/shared_library.h"

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

constexpr cl_int kNoPlatform = -1001;  // CL_PLATFORM_NOT_FOUND_KHR

template <class Value>
Value device_info(const OpenClLibrary& library, cl_device_id device, cl_device_info what) {
  Value value{};
  require(library.GetDeviceInfo(device, what, sizeof value, &value, nullptr), "clGetDeviceInfo");
  return value;
}

// ask(bytes, buffer, bytes needed) is clGetPlatformInfo or clGetDeviceInfo.
template <class Ask>
std::string text_info(const char* function, const Ask& ask) {
  std::size_t bytes = 0;
  require(ask(0, nullptr, &bytes), function);
  std::string text(bytes, '\0');
  require(ask(bytes, text.data(), nullptr), function);
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
  return text;
}

// Returns the property of IEEE arithmetic that the device lacks in this precision, single or double; empty:
// none.
std::string missing_arithmetic(cl_device_fp_config has, const char* precision) {
  const std::string of = std::string(" in ") + precision + " precision";
  if (!(has & CL_FP_ROUND_TO_NEAREST)) return "does not round to nearest" + of;
  if (!(has & CL_FP_INF_NAN)) return "has no infinity and NaN" + of;
  if (!(has & CL_FP_DENORM)) return "flushes subnormal numbers to zero" + of;
  return {};
}

void read_arithmetic(const OpenClLibrary& library, OpenClDevice& device) {
  const auto single = device_info<cl_device_fp_config>(library, device.id, CL_DEVICE_SINGLE_FP_CONFIG);
  const auto wide = device_info<cl_device_fp_config>(library, device.id, CL_DEVICE_DOUBLE_FP_CONFIG);
  device.rounds_division = (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  device.has_double = wide != 0;
  if (!device.has_double)
    device.unfit_because = "has no double precision, in which points and normals are given";
  else if (device_info<cl_bool>(library, device.id, CL_DEVICE_COMPILER_AVAILABLE) == CL_FALSE)
    device.unfit_because = "has no compiler for kernels";
  device.inexact_because = missing_arithmetic(single, "single");
  if (device.inexact_because.empty() && device.has_double)
    device.inexact_because = missing_arithmetic(wide, "double");
}

}  // namespace

OpenClLibrary::OpenClLibrary() : library(kOpenClLibrary) {}

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

std::vector<OpenClDevice> opencl_devices(const OpenClLibrary& library) {
  cl_uint count = 0;
  const cl_int code = library.GetPlatformIDs(0, nullptr, &count);
  if (code == kNoPlatform || (code == CL_SUCCESS && count == 0)) return {};
  require(code, "clGetPlatformIDs");
  std::vector<cl_platform_id> platforms(count);
  require(library.GetPlatformIDs(count, platforms.data(), nullptr), "clGetPlatformIDs");
  std::vector<OpenClDevice> all;
  for (cl_uint p = 0; p < count; ++p) {
    const auto platform_name = text_info("clGetPlatformInfo", [&](auto... to) {
      return library.GetPlatformInfo(platforms[p], CL_PLATFORM_NAME, to...);
    });
    cl_uint devices = 0;
    const cl_int found = library.GetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 0, nullptr, &devices);
    if (found == CL_DEVICE_NOT_FOUND) continue;
    require(found, "clGetDeviceIDs");
    std::vector<cl_device_id> ids(devices);
    require(library.GetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, devices, ids.data(), nullptr),
            "clGetDeviceIDs");
    for (cl_uint d = 0; d < devices; ++d) {
      OpenClDevice device;
      device.platform = static_cast<int>(p), device.number = static_cast<int>(d), device.id = ids[d];
      device.name = text_info("clGetDeviceInfo", [&](auto... to) {
        return library.GetDeviceInfo(ids[d], CL_DEVICE_NAME, to...);
      });
      device.name += ", " + platform_name;
      device.is_gpu =
          (device_info<cl_device_type>(library, ids[d], CL_DEVICE_TYPE) & CL_DEVICE_TYPE_GPU) != 0;
      read_arithmetic(library, device);
      all.push_back(std::move(device));
    }
  }
  return all;
}

std::vector<OpenClDevice> listed_devices(std::chrono::milliseconds limit) {
  struct Listing {
    std::vector<OpenClDevice> devices;
    std::atomic<bool> is_over = false;
  };
  static std::mutex mutex;
  static std::shared_ptr<const Listing> late;  // the last listing that was late
  // Loaders and drivers initialise at the first call, not all of them safely in two threads. The mutex is
  // never freed, because a driver that hangs may hold it when the process ends.
  static std::mutex& one_at_a_time = *new std::mutex;
  const OpenClTimeout no_answer("its drivers did not list their devices in " +
                                std::to_string(limit.count() / 1000) + " s");
  {
    const std::lock_guard lock(mutex);
    if (late && !late->is_over) throw OpenClTimeout(no_answer);
  }
  const auto listing = std::make_shared<Listing>();
  LastingThread thread;
  const bool in_time = thread.run(
      [listing] {
        const std::lock_guard alone(one_at_a_time);
        const std::shared_ptr<void> at_end(nullptr, [&](void*) { listing->is_over = true; });
        listing->devices = opencl_devices(opencl_library());
      },
      limit);
  if (in_time) return std::move(listing->devices);
  const std::lock_guard lock(mutex);
  late = listing;
  throw OpenClTimeout(no_answer);
}

}  // namespace remote_touch
