// The kernels of the depth pipeline, built for a device once in a process, however many runs use them. Inside
// of this room only.
#pragma once

#include <memory>
#include <vector>

#include "core/depth/depth_processor.h"
#include "runners/opencl/opencl_devices.h"

namespace remote_touch {

// For the windows of some settings; from any thread.
class BuiltKernels {
 public:
  using Kernel = OpenClObject<cl_kernel>;

  // May take seconds. Throws OpenClError.
  BuiltKernels(const OpenClLibrary& library, const OpenClDevice& device,
               const DepthPipelineSettings& settings);

  const OpenClLibrary& library() const { return cl_; }
  cl_device_id device() const { return device_; }
  cl_context context() const { return context_.get(); }
  // A new one, since a kernel keeps its arguments. Throws OpenClError.
  Kernel kernel(const char* name) const;

 private:
  const OpenClLibrary& cl_;
  const cl_device_id device_;
  OpenClObject<cl_context> context_;
  OpenClObject<cl_program> program_;
};

// Built now, unless they are there, after those that other threads build. Throws OpenClError.
std::shared_ptr<const BuiltKernels> built_kernels(const OpenClLibrary& library, const OpenClDevice& device,
                                                  const DepthPipelineSettings& settings);
// Those of a device that failed are built again by who asks next. Returns the old ones: to release them may
// hang.
[[nodiscard]] std::vector<std::shared_ptr<const BuiltKernels>> forget_kernels(cl_device_id device);

}  // namespace remote_touch
