#include "runners/libraries/device_frames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "core/kernels/depth_kernels.h"

namespace remote_touch {
namespace {

std::string options(const OpenClDevice& device, const DepthPipelineSettings& settings) {
  std::string text = "-cl-std=CL1.2 -D FILTER_HALF=" + std::to_string(settings.filter_window / 2) +
                     " -D NORMAL_HALF=" + std::to_string(settings.normal_window / 2);
  text += device.rounds_division ? " -cl-fp32-correctly-rounded-divide-sqrt" : " -D DIVIDE_IN_DOUBLE";
  return text;
}

// `mutex` is not locked while kernels are built or released. The kernels of one platform are built one after
// another, by threads with a deadline: not all compilers in drivers are safe in two threads, and the second
// thread may find its kernels already built. A driver that hangs does not delay other platforms.
struct Cache {
  using Key = std::pair<cl_device_id, std::string>;
  std::mutex mutex;
  std::map<Key, std::shared_ptr<const BuiltKernels>> built;
  std::map<int, std::mutex> one_at_a_time;  // one mutex for each platform

  std::mutex& turn_of(int platform) {
    const std::lock_guard lock(mutex);
    return one_at_a_time[platform];
  }
};

Cache& cache() {
  // The cache is never freed, because the driver may be unloaded earlier at the end of the process.
  static Cache& one = *new Cache;
  return one;
}

constexpr std::size_t kBorder = 7, kGroup = 64;  // BORDER of the kernels; pixels of a row in a work group
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

BuiltKernels::BuiltKernels(const OpenClLibrary& library, const OpenClDevice& device,
                           const DepthPipelineSettings& settings)
    : cl_(library), device_(device.id) {
  cl_int code = CL_SUCCESS;
  context_ = {cl_.CreateContext(nullptr, 1, &device_, nullptr, nullptr, &code), cl_.ReleaseContext};
  require(code, "clCreateContext");
  const char* source = kDepthKernelSource;
  program_ = {cl_.CreateProgramWithSource(context_.get(), 1, &source, nullptr, &code), cl_.ReleaseProgram};
  require(code, "clCreateProgramWithSource");
  code = cl_.BuildProgram(program_.get(), 1, &device_, options(device, settings).c_str(), nullptr, nullptr);
  if (code != CL_BUILD_PROGRAM_FAILURE) {
    require(code, "clBuildProgram");
    return;
  }
  std::string log(4096, '\0');
  std::size_t bytes = 0;
  cl_.GetProgramBuildInfo(program_.get(), device_, CL_PROGRAM_BUILD_LOG, log.size(), log.data(), &bytes);
  throw OpenClError("clBuildProgram: " + log.substr(0, log.find_first_of(std::string("\n\0", 2))));
}

BuiltKernels::Kernel BuiltKernels::kernel(const char* name) const {
  cl_int code = CL_SUCCESS;
  Kernel made{cl_.CreateKernel(program_.get(), name, &code), cl_.ReleaseKernel};
  require(code, "clCreateKernel");
  return made;
}

std::shared_ptr<const BuiltKernels> built_kernels(const OpenClLibrary& library, const OpenClDevice& device,
                                                  const DepthPipelineSettings& settings) {
  Cache& all = cache();
  const Cache::Key key{device.id, options(device, settings)};
  const std::lock_guard alone(all.turn_of(device.platform));
  {
    const std::lock_guard lock(all.mutex);
    if (const auto known = all.built.find(key); known != all.built.end()) return known->second;
  }
  auto made = std::make_shared<const BuiltKernels>(library, device, settings);
  const std::lock_guard lock(all.mutex);
  return all.built.emplace(key, std::move(made)).first->second;
}

std::vector<std::shared_ptr<const BuiltKernels>> forget_kernels(cl_device_id device) {
  std::vector<std::shared_ptr<const BuiltKernels>> forgotten;
  const std::lock_guard lock(cache().mutex);
  for (auto& [key, built] : cache().built)
    if (key.first == device) forgotten.push_back(std::move(built));
  std::erase_if(cache().built, [&](const auto& entry) { return entry.first.first == device; });
  return forgotten;
}

DeviceFrames::DeviceFrames(std::shared_ptr<const BuiltKernels> kernels, const DepthPipelineSettings& settings)
    : kernels_(std::move(kernels)), cl_(kernels_->library()), settings_(settings) {
  cl_int code = CL_SUCCESS;
  queue_ = {cl_.CreateCommandQueue(kernels_->context(), kernels_->device(), 0, &code),
            cl_.ReleaseCommandQueue};
  require(code, "clCreateCommandQueue");
  to_depths_ = kernels_->kernel("units_to_depths"), fixtures_ = kernels_->kernel("fixture_columns");
  to_plane_ = kernels_->kernel("depths_to_plane"), filter_ = kernels_->kernel("filter_depths");
  normals_of_ = kernels_->kernel("plane_normals"), place_ = kernels_->kernel("place_points");
}

DeviceFrames::Buffer DeviceFrames::buffer(std::size_t bytes, cl_mem_flags flags) const {
  cl_int code = CL_SUCCESS;
  Buffer made{cl_.CreateBuffer(kernels_->context(), flags, bytes, nullptr, &code), cl_.ReleaseMemObject};
  require(code, "clCreateBuffer");
  return made;
}

template <class Value>
void DeviceFrames::write(const Buffer& to, const std::vector<Value>& values) {
  require(cl_.EnqueueWriteBuffer(queue_.get(), to.get(), CL_TRUE, 0, values.size() * sizeof(Value),
                                 values.data(), 0, nullptr, nullptr),
          "clEnqueueWriteBuffer");
}

// Allocates the buffers for images of this size. All borders, and the columns right of the image, are filled
// with holes here and never change.
void DeviceFrames::resize(const CameraIntrinsics& camera) {
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  stride_ = (width + kGroup - 1) / kGroup * kGroup;
  const std::size_t pixels = stride_ * height, plane = (stride_ + 2 * kBorder) * (height + 2 * kBorder);
  units_ = buffer(width * height * sizeof(cl_ushort)), rgb_ = buffer(width * height * sizeof(cl_uint));
  depth_m_ = buffer(pixels * sizeof(double)), change_ = buffer(pixels * sizeof(float));
  raw_ = buffer(plane * sizeof(float)), smooth_ = buffer(plane * sizeof(float));
  ray_x_ = buffer((stride_ + 2 * kBorder) * sizeof(float));
  ray_y_ = buffer((height + 2 * kBorder) * sizeof(float));
  wide_ray_x_ = buffer(stride_ * sizeof(double)), wide_ray_y_ = buffer(height * sizeof(double));
  centre_and_focal_ = buffer(4 * sizeof(double)), X_ = buffer(16 * sizeof(double));
  // The columns lie in memory that the host reads without a copy by the driver, if there is such memory.
  columns_ = buffer(DeviceFrame::kColumns * width * height * sizeof(double),
                    CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR);
  write(depth_m_, std::vector<double>(pixels, 0.0));
  for (const Buffer* each : {&raw_, &smooth_}) write(*each, std::vector<float>(plane, kNowhere));
}

// Writes the data that change only with the camera.
void DeviceFrames::aim(const CameraIntrinsics& camera) {
  const bool same_size = camera.width == camera_.width && camera.height == camera_.height;
  if (same_size && camera.fx == camera_.fx && camera.fy == camera_.fy && camera.cx == camera_.cx &&
      camera.cy == camera_.cy)
    return;
  camera_ = {};  // stays empty if one of the calls throws
  if (!same_size) resize(camera);
  const std::vector<double> x = rays(stride_, camera.cx, camera.fx);
  const std::vector<double> y = rays(static_cast<std::size_t>(camera.height), camera.cy, camera.fy);
  write(ray_x_, narrow(x)), write(ray_y_, narrow(y));
  const auto without_border = [](const std::vector<double>& all) {
    return std::vector<double>(all.begin() + kBorder, all.end() - kBorder);
  };
  write(wide_ray_x_, without_border(x)), write(wide_ray_y_, without_border(y));
  write(centre_and_focal_, std::vector{camera.cx, camera.cy, camera.fx, camera.fy});
  camera_ = camera;
}

void DeviceFrames::upload_steps(const DeviceFrame& frame) {
  std::vector<double> numbers;
  for (const auto& [range, strength, first_stiffness] : frame.steps)
    for (const double each :
         {range.from_deg, range.to_deg, range.min_saturation, range.min_lightness, range.max_lightness,
          range.values.radius_m, range.values.stiffness_N_per_m, strength, first_stiffness})
      numbers.push_back(each);
  if (numbers.size() > most_step_numbers_ || most_step_numbers_ == 0) {
    most_step_numbers_ = std::max<std::size_t>(numbers.size(), 1);
    steps_ = buffer(most_step_numbers_ * sizeof(double));
  }
  if (!numbers.empty()) write(steps_, numbers);
}

void DeviceFrames::upload(const DeviceFrame& frame) {
  std::vector<double> X(std::begin(frame.X_WC), std::end(frame.X_WC));
  X.insert(X.end(), std::begin(frame.X_CW_z), std::end(frame.X_CW_z));
  write(X_, X);
  if (!frame.colour.empty()) write(rgb_, frame.colour), upload_steps(frame);
  if (frame.depth_m.empty()) return write(units_, frame.units);
  const std::size_t none[3] = {0, 0, 0}, row = static_cast<std::size_t>(camera_.width) * sizeof(double);
  const std::size_t region[3] = {row, static_cast<std::size_t>(camera_.height), 1};
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
  const std::size_t all[2] = {stride_, static_cast<std::size_t>(camera_.height)}, group[2] = {kGroup, 1};
  require(cl_.EnqueueNDRangeKernel(queue_.get(), kernel.get(), 2, nullptr, all, group, 0, nullptr, nullptr),
          "clEnqueueNDRangeKernel");
}

void DeviceFrames::fill_columns(const DeviceFrame& frame) {
  const double filter_scale = std::sqrt(kFilterExponent / 2) / settings_.sigma_f_m;
  const double normal_scale = 1 / settings_.normal_radius_m, change_unit_m = 1 / filter_scale;
  const cl_int is_filtered = settings_.filter ? 1 : 0, width = camera_.width;
  if (frame.depth_m.empty())
    start(to_depths_, units_, frame.metres_per_unit, width, centre_and_focal_, X_, depth_m_);
  start(to_plane_, depth_m_, settings_.filter ? filter_scale : normal_scale,
        settings_.filter ? raw_ : smooth_);
  if (settings_.filter)
    start(filter_, depth_m_, ray_x_, ray_y_, raw_, change_unit_m, normal_scale, change_, smooth_);
  start(normals_of_, ray_x_, ray_y_, smooth_, static_cast<float>(1 / camera_.fx),
        static_cast<float>(1 / camera_.fy), X_, width, columns_);
  if (!frame.has_points)
    start(place_, depth_m_, change_, is_filtered, change_unit_m, wide_ray_x_, wide_ray_y_, X_, width,
          columns_);
  if (!frame.colour.empty()) assign_fixtures(frame);
}

void DeviceFrames::assign_fixtures(const DeviceFrame& frame) {
  const cl_int keeps_points = frame.has_points ? 1 : 0, width = camera_.width;
  start(fixtures_, rgb_, depth_m_, keeps_points, steps_, static_cast<cl_int>(frame.steps.size()), width,
        columns_);
}

void DeviceFrames::download(DeviceFrame& frame) {
  const std::size_t pixels = camera_.pixels();
  const int first = frame.has_points ? DeviceFrame::nx : DeviceFrame::x;
  int end = DeviceFrame::fixture_radius;
  if (!frame.colour.empty()) end = frame.has_stiffness() ? DeviceFrame::kColumns : DeviceFrame::stiffness;
  cl_int code = CL_SUCCESS;
  const std::size_t bytes = pixels * sizeof(double);
  void* const mapped = cl_.EnqueueMapBuffer(
      queue_.get(), columns_.get(), CL_TRUE, CL_MAP_READ, static_cast<std::size_t>(first) * bytes,
      static_cast<std::size_t>(end - first) * bytes, 0, nullptr, nullptr, &code);
  require(code, "clEnqueueMapBuffer");
  const auto* from = static_cast<const double*>(mapped);
  for (int column = first; column < end; ++column, from += pixels)
    frame.columns[column].assign(from, from + pixels);
  require(cl_.EnqueueUnmapMemObject(queue_.get(), columns_.get(), mapped, 0, nullptr, nullptr),
          "clEnqueueUnmapMemObject");
}

void DeviceFrames::run(DeviceFrame& frame) {
  aim(frame.camera);
  upload(frame);
  fill_columns(frame);
  download(frame);
  require(cl_.Finish(queue_.get()), "clFinish");
}

void DeviceFrames::drain() noexcept {
  cl_.Finish(queue_.get());
}

bool DeviceFrame::has_stiffness() const {
  return std::any_of(steps.begin(), steps.end(),
                     [](const HueStep& step) { return step.range.values.stiffness_N_per_m >= 0; });
}

}  // namespace remote_touch
