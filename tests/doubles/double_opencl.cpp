// A test double of an OpenCL 1.2 library with one device. It runs the project's own kernels, compiled as C++,
// one work item after the other. It fails if a test sets it to fail.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "tests/doubles/opencl_double.h"

namespace {

std::size_t ids[2], sizes[2];  // index and range of the work item being computed
int filter_half, normal_half;

namespace kernels {
// Functions that OpenCL C has and C++ lacks, or names differently.
std::size_t get_global_id(unsigned d) {
  return ids[d];
}
std::size_t get_global_size(unsigned d) {
  return sizes[d];
}
double as_double(std::uint64_t bits) {
  return std::bit_cast<double>(bits);
}
using std::fabs;
using std::sqrt;
#define __kernel
#define __global
#define __constant const
#define restrict __restrict
#define FILTER_HALF filter_half
#define NORMAL_HALF normal_half
#include "runners/libraries/depth_kernels.cl"
#undef restrict
}  // namespace kernels

remote_touch::OpenClDouble settings;
constexpr const char* kName = "double";

// Returns true if this call is to fail. It hangs first if it is set to hang.
bool fails(const char* function) {
  if (std::strcmp(settings.failing, function) != 0 || ++settings.calls < settings.failing_call) return false;
  while (settings.hangs && !settings.is_released) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return true;
}

template <class Answer>
cl_int answer(const Answer& is, std::size_t capacity, void* to, std::size_t* bytes) {
  if (bytes != nullptr) *bytes = sizeof is;
  if (to == nullptr) return CL_SUCCESS;
  if (capacity < sizeof is) return CL_INVALID_VALUE;
  std::memcpy(to, &is, sizeof is);
  return CL_SUCCESS;
}

cl_int text(const char* is, std::size_t capacity, void* to, std::size_t* bytes) {
  if (bytes != nullptr) *bytes = std::strlen(is) + 1;
  if (to != nullptr) std::strncpy(static_cast<char*>(to), is, capacity);
  return CL_SUCCESS;
}

// Every object of the library is a Thing.
struct Thing {
  Thing() { ++settings.objects; }
  ~Thing() { --settings.objects; }
  Thing(const Thing&) = delete;
  Thing& operator=(const Thing&) = delete;
  std::string name;
  std::vector<unsigned char> bytes;
  std::map<cl_uint, std::vector<unsigned char>> arguments;
};

template <class Object>
Thing& thing(Object object) {
  return *reinterpret_cast<Thing*>(object);
}

template <class Object>
Object make(const char* function, cl_int* code) {
  const bool failed = fails(function);
  if (code != nullptr) *code = failed ? settings.code.load() : CL_SUCCESS;
  return failed ? nullptr : reinterpret_cast<Object>(new Thing);
}

template <class Object>
cl_int destroy(Object object) {
  delete &thing(object);
  return CL_SUCCESS;
}

// The argument of a kernel as its function takes it.
struct Argument {
  const std::vector<unsigned char>& bytes;
  template <class Value>
  operator Value() const {  // NOLINT(google-explicit-constructor)
    if constexpr (std::is_pointer_v<Value>) {
      cl_mem memory;
      std::memcpy(&memory, bytes.data(), sizeof memory);
      return reinterpret_cast<Value>(thing(memory).bytes.data());
    } else {
      Value value;
      std::memcpy(&value, bytes.data(), sizeof value);
      return value;
    }
  }
};

template <std::size_t... kIndex, class... Types>
void call(void (*function)(Types...), const Thing& kernel, std::index_sequence<kIndex...>) {
  function(Argument{kernel.arguments.at(kIndex)}...);
}
template <class... Types>
void call(void (*function)(Types...), const Thing& kernel) {
  call(function, kernel, std::index_sequence_for<Types...>());
}

void run_item(const Thing& kernel) {
  if (kernel.name == "units_to_depths") call(kernels::units_to_depths, kernel);
  if (kernel.name == "fixture_columns") call(kernels::fixture_columns, kernel);
  if (kernel.name == "depths_to_plane") call(kernels::depths_to_plane, kernel);
  if (kernel.name == "filter_depths") call(kernels::filter_depths, kernel);
  if (kernel.name == "plane_normals") call(kernels::plane_normals, kernel);
  if (kernel.name == "place_points") call(kernels::place_points, kernel);
}

void copy_rows(const std::size_t* region, unsigned char* to, std::size_t to_pitch, const unsigned char* from,
               std::size_t from_pitch) {
  for (std::size_t row = 0; row < region[1]; ++row)
    std::memcpy(to + row * to_pitch, from + row * from_pitch, region[0]);
}

}  // namespace

extern "C" {

remote_touch::OpenClDouble* opencl_double() {
  return &settings;
}

cl_int clGetPlatformIDs(cl_uint capacity, cl_platform_id* to, cl_uint* count) {
  if (fails("clGetPlatformIDs")) return settings.code;
  if (count != nullptr) *count = 1;
  if (capacity > 0) *to = reinterpret_cast<cl_platform_id>(&settings);
  return CL_SUCCESS;
}

cl_int clGetPlatformInfo(cl_platform_id, cl_platform_info, size_t capacity, void* to, size_t* bytes) {
  return fails("clGetPlatformInfo") ? settings.code.load() : text(kName, capacity, to, bytes);
}

cl_int clGetDeviceIDs(cl_platform_id, cl_device_type, cl_uint capacity, cl_device_id* to, cl_uint* count) {
  if (fails("clGetDeviceIDs")) return settings.code;
  if (count != nullptr) *count = 1;
  if (capacity > 0) *to = reinterpret_cast<cl_device_id>(&settings);
  return CL_SUCCESS;
}

cl_int clGetDeviceInfo(cl_device_id, cl_device_info what, size_t capacity, void* to, size_t* bytes) {
  if (fails("clGetDeviceInfo")) return settings.code;
  const cl_device_fp_config ieee = CL_FP_ROUND_TO_NEAREST | CL_FP_INF_NAN | CL_FP_DENORM;
  switch (what) {
    case CL_DEVICE_SINGLE_FP_CONFIG:
      return answer<cl_device_fp_config>(settings.is_imprecise ? ieee & ~CL_FP_DENORM : ieee, capacity, to,
                                         bytes);
    case CL_DEVICE_DOUBLE_FP_CONFIG:
      return answer(ieee, capacity, to, bytes);
    case CL_DEVICE_TYPE:
      return answer<cl_device_type>(CL_DEVICE_TYPE_CPU, capacity, to, bytes);
    case CL_DEVICE_COMPILER_AVAILABLE:
      return answer<cl_bool>(CL_TRUE, capacity, to, bytes);
    default:
      return text(kName, capacity, to, bytes);
  }
}

cl_context clCreateContext(const cl_context_properties*, cl_uint, const cl_device_id*,
                           void(CL_CALLBACK*)(const char*, const void*, size_t, void*), void*, cl_int* code) {
  return make<cl_context>("clCreateContext", code);
}
cl_int clReleaseContext(cl_context context) {
  return destroy(context);
}

cl_command_queue clCreateCommandQueue(cl_context, cl_device_id, cl_command_queue_properties, cl_int* code) {
  return make<cl_command_queue>("clCreateCommandQueue", code);
}
cl_int clReleaseCommandQueue(cl_command_queue queue) {
  return destroy(queue);
}

cl_program clCreateProgramWithSource(cl_context, cl_uint, const char**, const size_t*, cl_int* code) {
  return make<cl_program>("clCreateProgramWithSource", code);
}
cl_int clBuildProgram(cl_program, cl_uint, const cl_device_id*, const char* options,
                      void(CL_CALLBACK*)(cl_program, void*), void*) {
  if (fails("clBuildProgram")) return settings.code;
  const std::string all = options;
  const auto value = [&](const std::string& name) {
    return std::stoi(all.substr(all.find(name) + name.size()));
  };
  filter_half = value("FILTER_HALF="), normal_half = value("NORMAL_HALF=");
  return CL_SUCCESS;
}
cl_int clGetProgramBuildInfo(cl_program, cl_device_id, cl_program_build_info, size_t capacity, void* to,
                             size_t* bytes) {
  return text("error: of the double\nand more", capacity, to, bytes);
}
cl_int clReleaseProgram(cl_program program) {
  return destroy(program);
}

cl_kernel clCreateKernel(cl_program, const char* name, cl_int* code) {
  const auto kernel = make<cl_kernel>("clCreateKernel", code);
  if (kernel != nullptr) thing(kernel).name = name;
  return kernel;
}
cl_int clSetKernelArg(cl_kernel kernel, cl_uint index, size_t bytes, const void* value) {
  if (fails("clSetKernelArg")) return settings.code;
  const auto* const first = static_cast<const unsigned char*>(value);
  thing(kernel).arguments[index].assign(first, first + bytes);
  return CL_SUCCESS;
}
cl_int clReleaseKernel(cl_kernel kernel) {
  return destroy(kernel);
}

cl_mem clCreateBuffer(cl_context, cl_mem_flags, size_t bytes, void*, cl_int* code) {
  const auto memory = make<cl_mem>("clCreateBuffer", code);
  if (memory != nullptr) thing(memory).bytes.resize(bytes);
  return memory;
}
cl_int clReleaseMemObject(cl_mem memory) {
  return destroy(memory);
}

cl_int clEnqueueWriteBuffer(cl_command_queue, cl_mem to, cl_bool, size_t offset, size_t bytes,
                            const void* from, cl_uint, const cl_event*, cl_event*) {
  if (fails("clEnqueueWriteBuffer")) return settings.code;
  std::memcpy(thing(to).bytes.data() + offset, from, bytes);
  return CL_SUCCESS;
}
cl_int clEnqueueWriteBufferRect(cl_command_queue, cl_mem to, cl_bool, const size_t*, const size_t*,
                                const size_t* region, size_t pitch, size_t, size_t from_pitch, size_t,
                                const void* from, cl_uint, const cl_event*, cl_event*) {
  if (fails("clEnqueueWriteBufferRect")) return settings.code;
  copy_rows(region, thing(to).bytes.data(), pitch, static_cast<const unsigned char*>(from), from_pitch);
  return CL_SUCCESS;
}
void* clEnqueueMapBuffer(cl_command_queue, cl_mem from, cl_bool, cl_map_flags, size_t offset, size_t, cl_uint,
                         const cl_event*, cl_event*, cl_int* code) {
  const bool failed = fails("clEnqueueMapBuffer");
  *code = failed ? settings.code.load() : CL_SUCCESS;
  return failed ? nullptr : thing(from).bytes.data() + offset;
}
cl_int clEnqueueUnmapMemObject(cl_command_queue, cl_mem, void*, cl_uint, const cl_event*, cl_event*) {
  return fails("clEnqueueUnmapMemObject") ? settings.code.load() : CL_SUCCESS;
}

cl_int clEnqueueNDRangeKernel(cl_command_queue, cl_kernel kernel, cl_uint, const size_t*, const size_t* all,
                              const size_t*, cl_uint, const cl_event*, cl_event*) {
  if (fails("clEnqueueNDRangeKernel")) return settings.code;
  ++settings.kernel_runs;
  sizes[0] = all[0], sizes[1] = all[1];
  for (ids[1] = 0; ids[1] < all[1]; ++ids[1])
    for (ids[0] = 0; ids[0] < all[0]; ++ids[0]) run_item(thing(kernel));
  if (settings.is_wrong && thing(kernel).name == "plane_normals") {
    const int width = Argument{thing(kernel).arguments.at(6)};
    double* const columns = Argument{thing(kernel).arguments.at(7)};
    columns[3 * static_cast<std::size_t>(width) * all[1] + 40] += 1e-15;  // a normal's x
  }
  return CL_SUCCESS;
}

cl_int clFinish(cl_command_queue) {
  return fails("clFinish") ? settings.code.load() : CL_SUCCESS;
}
}
