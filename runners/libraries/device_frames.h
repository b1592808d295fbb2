// The depth pipeline on one OpenCL device: uploads, then its kernels, then one download. Only for use inside
// this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "runners/libraries/opencl_devices.h"

namespace remote_touch {

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
