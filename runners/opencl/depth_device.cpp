#include "runners/opencl/depth_device.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "core/parameters/input_error.h"
#include "runners/opencl/opencl_devices.h"

namespace remote_touch {

namespace {

constexpr const char* kExpected = "expected auto, cpu, opencl or opencl:PLATFORM:DEVICE";

struct Address {
  int platform = -1, number = -1;  // -1: any
};

// Of "opencl" or "opencl:0:1"; none for other texts.
std::optional<Address> address_of(const std::string& text) {
  if (text == "opencl") return Address{};
  if (text.rfind("opencl:", 0) != 0) return std::nullopt;
  Address address;
  const char* const end = text.data() + text.size();
  auto [colon, bad] = std::from_chars(text.data() + 7, end, address.platform);
  if (bad != std::errc{} || colon == end || *colon != ':') return std::nullopt;
  auto [rest, worse] = std::from_chars(colon + 1, end, address.number);
  if (worse != std::errc{} || rest != end || address.platform < 0 || address.number < 0) return std::nullopt;
  return address;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

bool same_bits(const PointCloud& a, const PointCloud& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z) && same_bits(a.nx, b.nx) &&
         same_bits(a.ny, b.ny) && same_bits(a.nz, b.nz);
}

constexpr CameraIntrinsics kTrialCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

// Two walls, rough by up to 2 mm, with a hole in each 31st pixel.
DepthImage trial_image() {
  DepthImage image{kTrialCamera.width, kTrialCamera.height, {}};
  std::uint32_t random = 1;
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      random = random * 1664525u + 1013904223u;
      const double rough_m = 2e-3 * static_cast<double>(random >> 8) / (1 << 24);
      const bool is_hole = (v * image.width + u) % 31 == 0;
      image.z_m.push_back(is_hole ? std::numeric_limits<double>::quiet_NaN()
                                  : (u < 150 ? 0.8 + 1e-3 * u : 1.1 + 5e-4 * v) + rough_m);
    }
  return image;
}

double min_ms(DepthProcessor& processor, const DepthImage& image, PointCloud& cloud) {
  double min = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    processor.process(image, kTrialCamera, RigidTransform::Identity(), cloud);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    min = std::min(min, took.count());
  }
  return min;
}

struct Tried {
  DepthTrial trial;
  std::unique_ptr<DevicePipeline> pipeline;  // null if it failed
};

Tried try_device(const OpenClDevice& device, const DepthPipelineSettings& settings, const Kernels& kernels,
                 const DepthReport& report) {
  Tried tried;
  tried.trial.failure = device.unfit_because;
  if (!tried.trial.failure.empty()) return tried;
  try {
    const auto failure = std::make_shared<std::string>();
    const auto told = std::make_shared<DepthReport>([failure](const std::string& line) { *failure = line; });
    tried.pipeline = std::make_unique<DevicePipeline>(device, settings, kernels,
                                                      [told](const std::string& line) { (*told)(line); });
    DepthPipeline cpu(settings, kernels);
    const DepthImage image = trial_image();
    PointCloud on_device, on_cpu;
    tried.trial.device_ms = min_ms(*tried.pipeline, image, on_device);
    tried.trial.cpu_ms = min_ms(cpu, image, on_cpu);
    tried.trial.same_bits = same_bits(on_device, on_cpu);
    tried.trial.failure = *failure;
    *told = report ? report : [](const std::string&) {};
  } catch (const std::exception& error) {
    tried.trial.failure = error.what();
  }
  if (!tried.trial.failure.empty()) tried.pipeline.reset();
  return tried;
}

std::string inexact(const OpenClDevice& device, const DepthTrial& trial) {
  if (!device.inexact_because.empty()) return device.inexact_because;
  return trial.failure.empty() && !trial.same_bits ? "gave other bits than the CPU in a trial frame" : "";
}

[[noreturn]] void refuse(const DepthDeviceSettings& settings, const std::string& why) {
  throw InputError("depth_pipeline.device = " + settings.device, why);
}

// Whether the kernels of a device know how to compute these normals.
bool is_for_devices(const DepthPipelineSettings& s) {
  return s.normal_step == 1 && s.normal_fit == NormalFit::total_least_squares;
}

std::vector<OpenClDevice> devices_or_none(std::string& why_none) {
  try {
    std::vector<OpenClDevice> devices = opencl_devices(opencl_library());
    if (devices.empty())
      why_none = "no OpenCL driver is installed (Debian: pocl-opencl-icd for the processor)";
    return devices;
  } catch (const std::exception& error) {
    why_none = error.what();
    return {};
  }
}

// The fastest one that keeps the bits and is faster than the CPU, or null.
std::unique_ptr<DepthProcessor> faster_device(const DepthDeviceSettings& settings, const Kernels& kernels,
                                              const DepthReport& report) {
  std::string why_none;
  std::unique_ptr<DepthProcessor> best;
  double best_ms = std::numeric_limits<double>::infinity();
  for (const OpenClDevice& device : devices_or_none(why_none)) {
    if (!device.inexact_because.empty()) continue;
    Tried tried = try_device(device, settings, kernels, report);
    const DepthTrial& trial = tried.trial;
    if (!tried.pipeline || !trial.same_bits || trial.device_ms >= std::min(trial.cpu_ms, best_ms)) continue;
    best_ms = trial.device_ms, best = std::move(tried.pipeline);
  }
  return best;
}

std::unique_ptr<DepthProcessor> asked_device(const DepthDeviceSettings& settings, const Kernels& kernels,
                                             const DepthReport& report) {
  const Address address = address_of(settings.device).value_or(Address{});
  std::string why;
  std::vector<OpenClDevice> devices = devices_or_none(why);
  std::stable_sort(devices.begin(), devices.end(),
                   [](const OpenClDevice& a, const OpenClDevice& b) { return a.is_gpu > b.is_gpu; });
  for (const OpenClDevice& device : devices) {
    if (address.platform >= 0 && (device.platform != address.platform || device.number != address.number))
      continue;
    Tried tried = try_device(device, settings, kernels, report);
    std::string problem = tried.trial.failure;
    if (problem.empty() && settings.exact) problem = inexact(device, tried.trial);
    if (problem.empty()) return std::move(tried.pipeline);
    why += (why.empty() ? "" : "; ") + device.address() + " (" + device.name + ") " + problem;
    if (tried.trial.failure.empty()) why += "; depth_pipeline.exact = false allows it";
  }
  refuse(settings, why.empty() ? "there is no such device: `remote-touch devices` lists them" : why);
}

}  // namespace

Parameters parameters(DepthDeviceSettings& s) {
  Parameters all = parameters(static_cast<DepthPipelineSettings&>(s));
  all.push_back({"device", &s.device, 0, 0,
                 "what computes it: cpu, opencl, opencl:PLATFORM:DEVICE, or auto, an OpenCL device where one "
                 "is faster in a trial frame"});
  all.push_back({"exact", &s.exact, 0, 1,
                 "refuse an OpenCL device whose results have other bits than those of the CPU"});
  return all;
}

std::string validate(const DepthDeviceSettings& s) {
  if (s.device != "auto" && s.device != "cpu" && !address_of(s.device))
    return "device = " + s.device + ": " + kExpected;
  if (address_of(s.device) && !is_for_devices(s))
    return "device = " + s.device + ": expected cpu with normal_step > 1 or normal_fit = inverse-depth";
  return validate(static_cast<const DepthPipelineSettings&>(s));
}

std::unique_ptr<DepthProcessor> make_depth_processor(const DepthDeviceSettings& settings,
                                                     const Kernels& kernels, DepthReport report) {
  std::unique_ptr<DepthProcessor> made;
  if (settings.device == "auto" && is_for_devices(settings)) made = faster_device(settings, kernels, report);
  if (address_of(settings.device)) made = asked_device(settings, kernels, report);
  return made ? std::move(made) : std::make_unique<DepthPipeline>(settings, kernels);
}

std::vector<FoundDepthDevice> try_depth_devices(const Kernels& kernels, std::string& why_none) {
  std::vector<FoundDepthDevice> found;
  for (const OpenClDevice& device : devices_or_none(why_none)) {
    const DepthTrial trial = try_device(device, {}, kernels, nullptr).trial;
    found.push_back({device.address(), device.name, inexact(device, trial), trial});
  }
  return found;
}

}  // namespace remote_touch
