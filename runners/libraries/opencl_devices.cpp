#include "runners/libraries/opencl_devices.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "core/kernels/depth_kernels.h"
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
