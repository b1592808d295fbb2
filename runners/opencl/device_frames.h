// The depth pipeline on one OpenCL device: one upload, four kernels, one download. Inside of this room only.
#pragma once

#include <memory>
#include <vector>

#include "core/depth/depth_processor.h"
#include "runners/opencl/built_kernels.h"

namespace remote_touch {

// A frame with all that the device reads and writes: it belongs to the call, so that a caller who gives up
// waiting leaves nothing behind that is written later.
struct DeviceFrame {
  std::vector<double> depth_m;
  CameraIntrinsics camera;
  double X_WC[12];
  bool keep_points = false;
  std::vector<double> x = {}, y = {}, z = {};  // not written if points are kept
  std::vector<double> nx = {}, ny = {}, nz = {};
};

class DeviceFrames {
 public:
  // With kernels that were built for these settings. Throws OpenClError.
  DeviceFrames(std::shared_ptr<const BuiltKernels> kernels, const DepthPipelineSettings& settings);
  // The same bits as DepthPipeline's. Throws OpenClError; after that it is of no use.
  void run(DeviceFrame& frame);

 private:
  using Buffer = OpenClObject<cl_mem>;
  using Kernel = BuiltKernels::Kernel;

  Buffer buffer(std::size_t bytes) const;
  void resize(const CameraIntrinsics& camera);
  template <class Value>
  void write(const Buffer& to, const std::vector<Value>& values);
  void upload(const DeviceFrame& frame);
  template <class... Arguments>
  void start(const Kernel& kernel, const Arguments&... arguments);
  void download(const Buffer& from, int column, std::vector<double>& to);

  const std::shared_ptr<const BuiltKernels> kernels_;
  const OpenClLibrary& cl_;
  const DepthPipelineSettings settings_;
  OpenClObject<cl_command_queue> queue_;
  Kernel to_plane_, filter_, normals_of_, place_;
  int width_ = 0, height_ = 0;
  std::size_t stride_ = 0;
  Buffer depth_m_, change_, raw_, smooth_, ray_x_, ray_y_, wide_ray_x_, wide_ray_y_, X_WC_, points_, normals_;
};

}  // namespace remote_touch
