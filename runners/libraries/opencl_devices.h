// The OpenCL devices of this machine, and the depth pipeline on one of them.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120

#include <CL/cl.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
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

// The depth pipeline on one OpenCL device: uploads, then its kernels, then one download. Only for use inside
// this folder.

// depth_kernels.cl, compiled into the program.
extern const char* const kDepthKernelSource;

// The kernels of the depth pipeline for the window sizes of the settings, built once in a process for each
// device, however many runs use them. Any thread may use them.
class BuiltKernels {
 public:
  using Kernel = OpenClObject<cl_kernel>;

  // Builds the kernels, which may take seconds. Throws OpenClError.
  BuiltKernels(const OpenClLibrary& library, const OpenClDevice& device,
               const DepthPipelineSettings& settings);

  const OpenClLibrary& library() const { return cl_; }
  cl_device_id device() const { return device_; }
  cl_context context() const { return context_.get(); }
  // Returns a new kernel object, because a kernel keeps its arguments. Throws OpenClError.
  Kernel kernel(const char* name) const;

 private:
  const OpenClLibrary& cl_;
  const cl_device_id device_;
  OpenClObject<cl_context> context_;
  OpenClObject<cl_program> program_;
};

// Returns the kernels of the device for these settings. Builds them if they do not exist, after other threads
// have finished building kernels of the same platform. Throws OpenClError.
std::shared_ptr<const BuiltKernels> built_kernels(const OpenClLibrary& library, const OpenClDevice& device,
                                                  const DepthPipelineSettings& settings);
// Removes the kernels of a device that failed, so that the next call of built_kernels() builds them again.
// Returns the old ones, because their release may hang.
[[nodiscard]] std::vector<std::shared_ptr<const BuiltKernels>> forget_kernels(cl_device_id device);

// A frame with all data that the device reads and writes. The thread that runs the device shares it. If the
// caller stops waiting for that thread, the device later writes only to this frame, and not to the caller's
// own memory.
struct DeviceFrame {
  // Columns of the cloud, in the order in which they are downloaded.
  enum Column { x, y, z, nx, ny, nz, fixture_radius, stiffness, kColumns };

  CameraIntrinsics camera;
  double X_WC[12];              // row-major
  double X_CW_z[4];             // third row of its inverse
  std::vector<double> depth_m;  // empty: `units` has the depths
  std::vector<std::uint16_t> units = {};
  double metres_per_unit = 0;
  bool has_points = false;  // true: columns x, y, z are not written
  // Colour of each pixel. If it is not empty, the columns fixture_radius and stiffness are written according
  // to `steps`.
  std::vector<std::uint32_t> colour = {};
  HueSteps steps = {};
  std::vector<double> columns[kColumns] = {};

  bool has_stiffness() const;
};

class DeviceFrames {
 public:
  // kernels: built for these settings. Throws OpenClError.
  DeviceFrames(std::shared_ptr<const BuiltKernels> kernels, const DepthPipelineSettings& settings);
  // Fills the columns of the frame with the same bits as DepthPipeline and FixtureAssignment. Throws
  // OpenClError; after that this object cannot be used any more, and the device may read the frame until
  // drain() has returned.
  void run(DeviceFrame& frame);
  void drain() noexcept;

 private:
  using Buffer = OpenClObject<cl_mem>;
  using Kernel = BuiltKernels::Kernel;

  Buffer buffer(std::size_t bytes, cl_mem_flags flags = CL_MEM_READ_WRITE) const;
  void resize(const CameraIntrinsics& camera);
  void aim(const CameraIntrinsics& camera);
  template <class Value>
  void write(const Buffer& to, const std::vector<Value>& values);
  void upload(const DeviceFrame& frame);
  template <class... Arguments>
  void start(const Kernel& kernel, const Arguments&... arguments);
  void fill_columns(const DeviceFrame& frame);
  void upload_steps(const DeviceFrame& frame);
  void assign_fixtures(const DeviceFrame& frame);
  void download(DeviceFrame& frame);

  const std::shared_ptr<const BuiltKernels> kernels_;
  const OpenClLibrary& cl_;
  const DepthPipelineSettings settings_;
  OpenClObject<cl_command_queue> queue_;
  Kernel to_depths_, to_plane_, filter_, normals_of_, place_, fixtures_;
  CameraIntrinsics camera_;
  std::size_t stride_ = 0, most_step_numbers_ = 0;
  Buffer units_, depth_m_, rgb_, steps_;
  Buffer ray_x_, ray_y_, wide_ray_x_, wide_ray_y_, centre_and_focal_, X_;
  Buffer change_, raw_, smooth_, columns_;
};

}  // namespace remote_touch
