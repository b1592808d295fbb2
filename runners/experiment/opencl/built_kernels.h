// The kernels of the depth pipeline, built once in a process for each device, however many runs use them.
// Only for use inside this folder.
#pragma once

#include <memory>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "runners/experiment/opencl/opencl_devices.h"

namespace remote_touch {

// Kernels built for the window sizes of the settings. Any thread may use them.
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

}  // namespace remote_touch
