#include "runners/experiment/opencl/depth_device.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

constexpr const char* kExpected = "expected auto, cpu, opencl or opencl:PLATFORM:DEVICE";

struct Address {
  int platform = -1, number = -1;  // -1: any
};

// Parses "opencl" or "opencl:0:1"; returns none for other texts.
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

std::string inexact_reason(const OpenClDevice& device, const DepthTrial& trial) {
  if (!device.inexact_because.empty()) return device.inexact_because;
  return trial.failure.empty() && !trial.same_bits ? "gave other bits than the CPU in a trial frame" : "";
}

[[noreturn]] void refuse(const DepthDeviceSettings& settings, const std::string& why) {
  throw InputError("depth_pipeline.device = " + settings.device, why);
}

// True if the kernels can compute these normals.
bool is_for_devices(const DepthPipelineSettings& s) {
  return s.normal_step == 1 && s.normal_fit == NormalFit::total_least_squares;
}

std::vector<OpenClDevice> devices_or_none(std::string& why_none) {
  try {
    std::vector<OpenClDevice> devices = listed_devices();
    if (devices.empty())
      why_none = "no OpenCL driver is installed (Debian: pocl-opencl-icd for the processor)";
    return devices;
  } catch (const std::exception& error) {
    why_none = error.what();
    return {};
  }
}

// Returns the fastest device that gives the same bits as the CPU and is faster than the CPU. If there is no
// such device, why_none is the reason.
std::optional<OpenClDevice> faster_device(const DepthDeviceSettings& settings, const Kernels& kernels,
                                          std::string& why_none) {
  std::optional<OpenClDevice> best;
  double best_ms = std::numeric_limits<double>::infinity();
  for (const OpenClDevice& device : devices_or_none(why_none)) {
    DepthTrial trial;
    if (device.inexact_because.empty()) trial = trial_of(device, settings, kernels);
    std::string problem = trial.failure.empty() ? inexact_reason(device, trial) : trial.failure;
    if (problem.empty() && trial.device_ms >= trial.cpu_ms) problem = "is not faster than the CPU";
    if (!problem.empty())
      why_none += (why_none.empty() ? "" : "; ") + device.full_name() + " " + problem;
    else if (trial.device_ms < best_ms)
      best_ms = trial.device_ms, best = device;
  }
  return best;
}

// Reports why the CPU processes the frames with device = auto, each reason once in a process.
void report_cpu(const std::string& why, const DepthReport& report) {
  static std::mutex mutex;
  static std::set<std::string> reported;
  if (!report) return;
  {
    const std::lock_guard lock(mutex);
    if (!reported.insert(why).second) return;
  }
  report("depth_pipeline.device = auto: the CPU processes the frames: " + why);
}

OpenClDevice requested_device(const DepthDeviceSettings& settings, const Kernels& kernels) {
  const Address address = address_of(settings.device).value_or(Address{});
  std::string why;
  std::vector<OpenClDevice> devices = devices_or_none(why);
  std::stable_sort(devices.begin(), devices.end(),
                   [](const OpenClDevice& a, const OpenClDevice& b) { return a.is_gpu > b.is_gpu; });
  for (const OpenClDevice& device : devices) {
    if (address.platform >= 0 && (device.platform != address.platform || device.number != address.number))
      continue;
    const DepthTrial trial = trial_of(device, settings, kernels);
    std::string problem = trial.failure;
    if (problem.empty() && settings.exact) problem = inexact_reason(device, trial);
    if (problem.empty()) return device;
    why += (why.empty() ? "" : "; ") + device.full_name() + " " + problem;
    if (trial.failure.empty()) why += "; depth_pipeline.exact = false allows it";
  }
  refuse(settings, why.empty() ? "there is no such device: `remote-touch devices` lists them" : why);
}

// The devices that depth_device_of() reports, by settings.
struct Choices {
  std::mutex mutex;
  std::vector<std::pair<DepthDeviceSettings, std::string>> all;

  std::string& name_of(const DepthDeviceSettings& settings) {
    for (auto& [of, name] : all)
      if (of == settings) return name;
    return all.emplace_back(settings, "").second;
  }
};
Choices& choices() {
  static Choices one;
  return one;
}

void note_choice(const DepthDeviceSettings& settings, const std::string& name) {
  const std::lock_guard lock(choices().mutex);
  choices().name_of(settings) = name;
}

std::unique_ptr<DepthProcessor> open_pipeline(const OpenClDevice& device, const DepthDeviceSettings& settings,
                                              const Kernels& kernels, const DepthReport& report) {
  const std::string name = device.full_name();
  auto made = std::make_unique<DevicePipeline>(device, settings, kernels, [=](const std::string& why) {
    note_choice(settings, name + ", which failed: then the CPU");
    if (report)
      report("depth_pipeline.device = " + name + " failed: " + why +
             "; the CPU processes this frame and all later ones");
  });
  note_choice(settings, name);
  return made;
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
                                                     const Kernels& kernels, const DepthReport& report) {
  std::optional<OpenClDevice> device;
  std::string why_cpu;
  if (settings.device == "auto") {
    if (is_for_devices(settings))
      device = faster_device(settings, kernels, why_cpu);
    else
      why_cpu = "no device has kernels for normal_step > 1 or normal_fit = inverse-depth";
  }
  if (address_of(settings.device)) device = requested_device(settings, kernels);
  try {
    if (device) return open_pipeline(*device, settings, kernels, report);
  } catch (const OpenClError& error) {
    why_cpu = device->full_name() + " " + error.what();
    if (settings.device != "auto") refuse(settings, why_cpu);
  }
  if (settings.device == "auto") report_cpu(why_cpu, report);
  note_choice(settings, "");
  return std::make_unique<DepthPipeline>(settings, kernels);
}

std::string depth_device_of(const DepthDeviceSettings& settings) {
  const std::lock_guard lock(choices().mutex);
  return choices().name_of(settings);
}

std::vector<FoundDepthDevice> try_depth_devices(const Kernels& kernels, std::string& why_none) {
  std::vector<FoundDepthDevice> found;
  for (const OpenClDevice& device : devices_or_none(why_none)) {
    const DepthTrial trial = trial_of(device, {}, kernels);
    found.push_back({device.address(), device.name, inexact_reason(device, trial), trial});
  }
  return found;
}

}  // namespace remote_touch
