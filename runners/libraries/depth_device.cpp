#include "runners/libraries/depth_device.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "runners/libraries/opencl_devices.h"

namespace remote_touch {
namespace {

// Swaps the columns that the device has computed with those of the cloud.
void exchange(DeviceFrame& frame, PointCloud& cloud) {
  const auto swap = [&](DeviceFrame::Column made, std::vector<double>& old) {
    old.swap(frame.columns[made]);
  };
  swap(DeviceFrame::nx, cloud.nx), swap(DeviceFrame::ny, cloud.ny), swap(DeviceFrame::nz, cloud.nz);
  if (!frame.has_points)
    swap(DeviceFrame::x, cloud.x), swap(DeviceFrame::y, cloud.y), swap(DeviceFrame::z, cloud.z);
  if (frame.colour.empty()) return;
  swap(DeviceFrame::fixture_radius, cloud.fixture_radius_m);
  if (frame.has_stiffness()) swap(DeviceFrame::stiffness, cloud.stiffness_N_per_m);
}

std::string seconds_text(std::chrono::milliseconds time) {
  return formatted("%g s", static_cast<double>(time.count()) / 1000);
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

bool same_bits(const PointCloud& a, const PointCloud& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z) && same_bits(a.nx, b.nx) &&
         same_bits(a.ny, b.ny) && same_bits(a.nz, b.nz) &&
         same_bits(a.fixture_radius_m, b.fixture_radius_m) &&
         same_bits(a.stiffness_N_per_m, b.stiffness_N_per_m);
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

FixtureAssignment trial_rules() {
  HueRange::Settings red, half_blue;
  half_blue.from_deg = 200, half_blue.to_deg = 280;
  half_blue.values.stiffness_N_per_m = 500, half_blue.values.schedule = {0, 0.5};
  std::vector<std::unique_ptr<const FixtureRule>> rules;
  rules.push_back(std::make_unique<HueRange>(red)), rules.push_back(std::make_unique<HueRange>(half_blue));
  return FixtureAssignment(std::move(rules), nullptr, 600);
}

// Compares process_all() on the device with the CPU: for the same image as a sensor sends it, with all
// colours, two rules and a rotated camera. Returns true also if the device does not process such frames,
// because the CPU then does.
bool same_bits_at_once(DevicePipeline& on_device, DepthPipeline& on_cpu, DepthImage image) {
  constexpr double kUnit_m = 0.001;
  const RigidTransform X_WC(Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(0.7, Vec3::UnitX()));
  std::vector<std::uint16_t> units;
  for (double& z_m : image.z_m) {
    units.push_back(z_m > 0 ? static_cast<std::uint16_t>(z_m / kUnit_m) : 0);
    z_m = units.back() == 0 ? std::numeric_limits<double>::quiet_NaN() : units.back() * kUnit_m;
  }
  PointCloud expected = cloud_from_depth(image, kTrialCamera, X_WC), cloud = expected, from_sensor;
  for (std::uint32_t i = 0; i < expected.size(); ++i) expected.colour.push_back(i * 2654435761u >> 8);
  cloud.colour = expected.colour;
  const FixtureAssignment rules = trial_rules();
  const HueSteps steps = rules.hue_steps(0, 0).value_or(HueSteps{});
  on_cpu.process(expected);
  rules.assign(expected, 0);
  return (!on_device.process_all(cloud, steps) || same_bits(cloud, expected)) &&
         (!on_device.process_all({units.data(), kUnit_m, kTrialCamera, X_WC, expected.colour}, from_sensor,
                                 &steps) ||
          same_bits(from_sensor, expected));
}

DepthTrial try_now(const OpenClDevice& device, const DepthPipelineSettings& settings,
                   const Kernels& kernels) {
  DepthTrial trial;
  // The frame limit here is that of the build. Only frames of a run have to be in time, so a device does not
  // fail because the machine is busy at the start.
  DevicePipeline on_device(
      device, settings, kernels, [&trial](const std::string& why) { trial.failure = "failed: " + why; },
      DevicePipeline::kBuildLimit);
  DepthPipeline on_cpu(settings, kernels);
  const DepthImage image = trial_image();
  PointCloud a, b;
  trial.device_ms = min_ms(on_device, image, a);
  trial.cpu_ms = min_ms(on_cpu, image, b);
  trial.same_bits = same_bits(a, b) && same_bits_at_once(on_device, on_cpu, image);
  return trial;
}

struct Known {
  struct Entry {
    cl_device_id device;
    const Kernels* cpu;
    DepthPipelineSettings settings;
    DepthTrial trial;
  };
  std::mutex mutex;
  std::vector<Entry> trials;
};
Known& known() {
  static Known one;
  return one;
}

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

DevicePipeline::DevicePipeline(const OpenClDevice& device, const DepthPipelineSettings& settings,
                               const Kernels& kernels, std::function<void(const std::string&)> report,
                               std::chrono::milliseconds frame_limit)
    : DepthProcessor(settings),
      device_(device),
      report_(std::move(report)),
      frame_limit_(frame_limit),
      cpu_(settings, kernels),
      frame_(std::make_shared<DeviceFrame>()),
      thread_(std::make_unique<LastingThread>()) {
  struct Opened {
    std::shared_ptr<DeviceFrames> frames;
    DeviceFrame first{{8, 8, 10, 10, 4, 4},
                      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                      {0, 0, 1, 0},
                      std::vector<double>(64, 1.0)};
  };
  const auto opened = std::make_shared<Opened>();
  const bool in_time = thread_->run(
      [opened, device, settings] {
        opened->frames =
            std::make_shared<DeviceFrames>(built_kernels(opencl_library(), device, settings), settings);
        opened->frames->run(opened->first);
      },
      kBuildLimit);
  if (!in_time) throw OpenClTimeout("the kernels were not ready in " + seconds_text(kBuildLimit));
  frames_ = opened->frames;
}

void DevicePipeline::process_frame(const DepthFrame& frame, PointCloud& cloud) {
  if (frames_ == nullptr || !process_depths(frame, nullptr, cloud)) cpu_.process_frame(frame, cloud);
}

bool DevicePipeline::process_all(PointCloud& cloud, const HueSteps& steps) {
  const bool has_columns = !cloud.fixture_radius_m.empty() || !cloud.stiffness_N_per_m.empty();
  if (frames_ == nullptr || has_columns || cloud.size() == 0 || cloud.colour.size() != cloud.size())
    return false;
  return process_depths(frame_of(cloud), &steps, cloud);
}

// Returns false without the filter, because points that are not filtered must be those of cloud_from_depth()
// on the CPU.
bool DevicePipeline::process_all(const RawDepth& raw, PointCloud& cloud, const HueSteps* steps) {
  const DepthFrame size{nullptr, raw.camera, raw.X_WC};
  const bool fits = raw.colour.size() == size.pixels() || (raw.colour.empty() && steps == nullptr);
  if (frames_ == nullptr || !settings_.filter || !fits) return false;
  start(size, steps, raw.colour);
  frame_->units.assign(raw.units, raw.units + size.pixels());
  frame_->metres_per_unit = raw.metres_per_unit;
  if (!process_on_device()) return false;
  become_image(cloud, raw.camera, raw.X_WC);
  cloud.colour.assign(raw.colour.begin(), raw.colour.end());
  exchange(*frame_, cloud);
  return true;
}

bool DevicePipeline::process_depths(const DepthFrame& frame, const HueSteps* steps, PointCloud& cloud) {
  start(frame, steps, cloud.colour);
  frame_->depth_m.assign(frame.depth_m, frame.depth_m + frame.pixels());
  if (!process_on_device()) return false;
  exchange(*frame_, cloud);
  return true;
}

// Prepares frame_, except for its depths. steps: null if the columns of fixtures are not needed.
void DevicePipeline::start(const DepthFrame& frame, const HueSteps* steps,
                           std::span<const std::uint32_t> colour) {
  frame_->camera = frame.camera, frame_->has_points = frame.has_points;
  const RigidTransform X_CW = frame.X_WC.inverse();
  for (int i = 0; i < 12; ++i) frame_->X_WC[i] = frame.X_WC.matrix()(i / 4, i % 4);
  for (int i = 0; i < 4; ++i) frame_->X_CW_z[i] = X_CW.matrix()(2, i);
  frame_->depth_m.clear(), frame_->units.clear(), frame_->colour.clear(), frame_->steps.clear();
  if (steps != nullptr) frame_->colour.assign(colour.begin(), colour.end()), frame_->steps = *steps;
}

bool DevicePipeline::process_on_device() {
  bool in_time = false;
  try {
    in_time = thread_->run([frames = frames_, job = frame_] { frames->run(*job); }, frame_limit_);
  } catch (const std::exception& error) {
    give_up(error.what());
    return false;
  }
  if (!in_time) give_up("no answer within " + seconds_text(frame_limit_));
  return in_time;
}

// The thread that hangs owns all objects that it still uses. The release of objects of a device that failed
// may hang too, so a separate thread does it, and nothing waits for that thread.
void DevicePipeline::give_up(const std::string& why) {
  forget_trials(device_);
  struct Last {
    std::shared_ptr<DeviceFrame> frame;  // the device may still read it
    std::shared_ptr<DeviceFrames> frames;
    std::vector<std::shared_ptr<const BuiltKernels>> kernels;
  };
  const auto last =
      std::make_shared<Last>(Last{std::move(frame_), std::move(frames_), forget_kernels(device_.id)});
  LastingThread().run(
      [last] {
        last->frames->drain();
        last->frames.reset(), last->kernels.clear();
      },
      std::chrono::milliseconds(0));
  frame_.reset(), frames_.reset(), thread_.reset();
  if (report_) report_(why);
}

DepthTrial trial_of(const OpenClDevice& device, const DepthPipelineSettings& settings,
                    const Kernels& kernels) {
  DepthTrial trial;
  trial.failure = device.unfit_because;
  if (!trial.failure.empty()) return trial;
  // Trials run one after another, so that each is timed alone, and threads that start together share one
  // result. The mutex is never freed, because a thread may be waiting for it when the process ends.
  static std::mutex& one_at_a_time = *new std::mutex;
  const std::lock_guard alone(one_at_a_time);
  {
    const std::lock_guard lock(known().mutex);
    for (const Known::Entry& entry : known().trials)
      if (entry.device == device.id && entry.cpu == &kernels && entry.settings == settings)
        return entry.trial;
  }
  bool is_lasting = true;
  try {
    trial = try_now(device, settings, kernels);
    is_lasting = trial.failure.empty();
  } catch (const OpenClTimeout& error) {
    trial.failure = error.what();
  } catch (const std::exception& error) {
    trial.failure = error.what(), is_lasting = false;
  }
  const std::lock_guard lock(known().mutex);
  if (is_lasting) known().trials.push_back({device.id, &kernels, settings, trial});
  return trial;
}

void forget_trials(const OpenClDevice& device) {
  const std::lock_guard lock(known().mutex);
  std::erase_if(known().trials, [&](const auto& entry) { return entry.device == device.id; });
}

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
