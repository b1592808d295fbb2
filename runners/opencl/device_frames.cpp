#include "runners/opencl/device_frames.h"

#include <cmath>
#include <utility>

#include "core/kernels/depth_kernels.h"

namespace remote_touch {

namespace {

constexpr std::size_t kBorder = 7, kGroup = 64;  // BORDER of the kernels; pixels of a row in a work group

// Of pixels -kBorder .. count + kBorder - 1.
std::vector<double> rays(std::size_t count, double centre, double focal) {
  std::vector<double> all(count + 2 * kBorder);
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = (static_cast<int>(i) - static_cast<int>(kBorder) - centre) / focal;
  return all;
}

std::vector<float> narrow(const std::vector<double>& wide) {
  return {wide.begin(), wide.end()};
}

}  // namespace

DeviceFrames::DeviceFrames(std::shared_ptr<const BuiltKernels> kernels, const DepthPipelineSettings& settings)
    : kernels_(std::move(kernels)), cl_(kernels_->library()), settings_(settings) {
  cl_int code = CL_SUCCESS;
  queue_ = {cl_.CreateCommandQueue(kernels_->context(), kernels_->device(), 0, &code),
            cl_.ReleaseCommandQueue};
  require(code, "clCreateCommandQueue");
  to_plane_ = kernels_->kernel("depths_to_plane"), filter_ = kernels_->kernel("filter_depths");
  normals_of_ = kernels_->kernel("plane_normals"), place_ = kernels_->kernel("place_points");
}

DeviceFrames::Buffer DeviceFrames::buffer(std::size_t bytes) const {
  cl_int code = CL_SUCCESS;
  Buffer made{cl_.CreateBuffer(kernels_->context(), CL_MEM_READ_WRITE, bytes, nullptr, &code),
              cl_.ReleaseMemObject};
  require(code, "clCreateBuffer");
  return made;
}

template <class Value>
void DeviceFrames::write(const Buffer& to, const std::vector<Value>& values) {
  require(cl_.EnqueueWriteBuffer(queue_.get(), to.get(), CL_TRUE, 0, values.size() * sizeof(Value),
                                 values.data(), 0, nullptr, nullptr),
          "clEnqueueWriteBuffer");
}

// All borders, and the columns right of the image, stay as they are filled here: holes.
void DeviceFrames::resize(const CameraIntrinsics& camera) {
  if (camera.width == width_ && camera.height == height_) return;
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  stride_ = (width + kGroup - 1) / kGroup * kGroup;
  const std::size_t pixels = stride_ * height, plane = (stride_ + 2 * kBorder) * (height + 2 * kBorder);
  depth_m_ = buffer(pixels * sizeof(double)), change_ = buffer(pixels * sizeof(float));
  raw_ = buffer(plane * sizeof(float)), smooth_ = buffer(plane * sizeof(float));
  ray_x_ = buffer((stride_ + 2 * kBorder) * sizeof(float));
  ray_y_ = buffer((height + 2 * kBorder) * sizeof(float));
  wide_ray_x_ = buffer(stride_ * sizeof(double)), wide_ray_y_ = buffer(height * sizeof(double));
  X_WC_ = buffer(12 * sizeof(double));
  points_ = buffer(3 * pixels * sizeof(double)), normals_ = buffer(3 * pixels * sizeof(double));
  write(depth_m_, std::vector<double>(pixels, 0.0));
  for (const Buffer* each : {&raw_, &smooth_}) write(*each, std::vector<float>(plane, kNowhere));
  width_ = camera.width, height_ = camera.height;
}

void DeviceFrames::upload(const DeviceFrame& frame) {
  const CameraIntrinsics& camera = frame.camera;
  std::vector<double> x = rays(stride_, camera.cx, camera.fx);
  std::vector<double> y = rays(static_cast<std::size_t>(camera.height), camera.cy, camera.fy);
  write(ray_x_, narrow(x)), write(ray_y_, narrow(y));
  const auto without_border = [](const std::vector<double>& all) {
    return std::vector<double>(all.begin() + kBorder, all.end() - kBorder);
  };
  write(wide_ray_x_, without_border(x)), write(wide_ray_y_, without_border(y));
  write(X_WC_, std::vector<double>(std::begin(frame.X_WC), std::end(frame.X_WC)));
  const std::size_t none[3] = {0, 0, 0}, row = static_cast<std::size_t>(width_) * sizeof(double);
  const std::size_t region[3] = {row, static_cast<std::size_t>(height_), 1};
  require(cl_.EnqueueWriteBufferRect(queue_.get(), depth_m_.get(), CL_FALSE, none, none, region,
                                     stride_ * sizeof(double), 0, row, 0, frame.depth_m.data(), 0, nullptr,
                                     nullptr),
          "clEnqueueWriteBufferRect");
}

template <class... Arguments>
void DeviceFrames::start(const Kernel& kernel, const Arguments&... arguments) {
  cl_uint index = 0;
  const auto set = [&](const auto& argument) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(argument)>, Buffer>) {
      const cl_mem memory = argument.get();
      require(cl_.SetKernelArg(kernel.get(), index++, sizeof(cl_mem), &memory), "clSetKernelArg");
    } else {
      require(cl_.SetKernelArg(kernel.get(), index++, sizeof argument, &argument), "clSetKernelArg");
    }
  };
  (set(arguments), ...);
  const std::size_t all[2] = {stride_, static_cast<std::size_t>(height_)}, group[2] = {kGroup, 1};
  require(cl_.EnqueueNDRangeKernel(queue_.get(), kernel.get(), 2, nullptr, all, group, 0, nullptr, nullptr),
          "clEnqueueNDRangeKernel");
}

void DeviceFrames::download(const Buffer& from, int column, std::vector<double>& to) {
  to.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  const auto rows = static_cast<std::size_t>(height_),
             row = static_cast<std::size_t>(width_) * sizeof(double);
  const std::size_t none[3] = {0, 0, 0}, region[3] = {row, rows, 1};
  const std::size_t first[3] = {0, static_cast<std::size_t>(column) * rows, 0};
  require(cl_.EnqueueReadBufferRect(queue_.get(), from.get(), CL_FALSE, first, none, region,
                                    stride_ * sizeof(double), 0, row, 0, to.data(), 0, nullptr, nullptr),
          "clEnqueueReadBufferRect");
}

void DeviceFrames::run(DeviceFrame& frame) {
  resize(frame.camera);
  upload(frame);
  const double filter_scale = std::sqrt(kFilterExponent / 2) / settings_.sigma_f_m;
  const double normal_scale = 1 / settings_.normal_radius_m, change_unit_m = 1 / filter_scale;
  const cl_int is_filtered = settings_.filter ? 1 : 0;
  start(to_plane_, depth_m_, settings_.filter ? filter_scale : normal_scale,
        settings_.filter ? raw_ : smooth_);
  if (settings_.filter)
    start(filter_, depth_m_, ray_x_, ray_y_, raw_, change_unit_m, normal_scale, change_, smooth_);
  start(normals_of_, ray_x_, ray_y_, smooth_, static_cast<float>(1 / frame.camera.fx),
        static_cast<float>(1 / frame.camera.fy), X_WC_, normals_);
  download(normals_, 0, frame.nx), download(normals_, 1, frame.ny), download(normals_, 2, frame.nz);
  if (!frame.keep_points) {
    start(place_, depth_m_, change_, is_filtered, change_unit_m, wide_ray_x_, wide_ray_y_, X_WC_, points_);
    download(points_, 0, frame.x), download(points_, 1, frame.y), download(points_, 2, frame.z);
  }
  require(cl_.Finish(queue_.get()), "clFinish");
}

}  // namespace remote_touch
