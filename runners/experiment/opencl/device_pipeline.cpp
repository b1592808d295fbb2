#include "runners/experiment/opencl/device_pipeline.h"

#include <cstdio>
#include <utility>

#include "runners/experiment/opencl/device_frames.h"
#include "runners/experiment/opencl/device_trial.h"

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
  char text[32];
  std::snprintf(text, sizeof text, "%g s", static_cast<double>(time.count()) / 1000);
  return text;
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
      thread_(std::make_unique<DeadlineThread>()) {
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
  DeadlineThread().run(
      [last] {
        last->frames->drain();
        last->frames.reset(), last->kernels.clear();
      },
      std::chrono::milliseconds(0));
  frame_.reset(), frames_.reset(), thread_.reset();
  if (report_) report_(why);
}

}  // namespace remote_touch
