#include "runners/opencl/device_pipeline.h"

#include <utility>

#include "runners/opencl/device_frames.h"
#include "runners/opencl/device_trial.h"

namespace remote_touch {

namespace {

using Column = std::vector<double>;

// Columns that the cloud and the frame exchange.
template <class Visit>
void exchanged(DeviceFrame& frame, PointCloud& cloud, const Visit& visit) {
  visit(frame.nx, cloud.nx), visit(frame.ny, cloud.ny), visit(frame.nz, cloud.nz);
  if (frame.keep_points) return;
  visit(frame.x, cloud.x), visit(frame.y, cloud.y), visit(frame.z, cloud.z);
}

}  // namespace

DevicePipeline::DevicePipeline(const OpenClDevice& device, const DepthPipelineSettings& settings,
                               const Kernels& kernels, std::function<void(const std::string&)> report)
    : DepthProcessor(settings),
      device_(device),
      report_(std::move(report)),
      cpu_(settings, kernels),
      frame_(std::make_shared<DeviceFrame>()),
      thread_(std::make_unique<DeadlineThread>()) {
  struct Opened {
    std::shared_ptr<DeviceFrames> frames;
    DeviceFrame first{
        std::vector<double>(64, 1.0), {8, 8, 10, 10, 4, 4}, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
  };
  const auto opened = std::make_shared<Opened>();
  const bool in_time = thread_->run(
      [opened, device, settings] {
        opened->frames =
            std::make_shared<DeviceFrames>(built_kernels(opencl_library(), device, settings), settings);
        opened->frames->run(opened->first);
      },
      kBuildLimit);
  if (!in_time) throw OpenClTimeout("the kernels were not ready in 120 s");
  frames_ = opened->frames;
}

void DevicePipeline::process_frame(const DepthFrame& frame, PointCloud& cloud) {
  if (frames_ == nullptr || !on_device(frame, cloud)) cpu_.process_frame(frame, cloud);
}

bool DevicePipeline::on_device(const DepthFrame& frame, PointCloud& cloud) {
  frame_->depth_m.assign(frame.depth_m, frame.depth_m + frame.pixels());
  frame_->camera = frame.camera, frame_->keep_points = frame.keep_points;
  for (int i = 0; i < 12; ++i) frame_->X_WC[i] = frame.X_WC.matrix()(i / 4, i % 4);
  bool in_time = false;
  try {
    in_time = thread_->run([frames = frames_, job = frame_] { frames->run(*job); }, kFrameLimit);
  } catch (const std::exception& error) {
    give_up(error.what());
    return false;
  }
  if (!in_time) {
    give_up("no answer within 2 s");
    return false;
  }
  exchanged(*frame_, cloud, [](Column& made, Column& old) { made.swap(old); });
  return true;
}

// What the hanging thread still uses is its own. To release objects of a device that failed may hang too: a
// thread of its own does it, and nobody waits for it.
void DevicePipeline::give_up(const std::string& why) {
  forget_trials(device_);
  const auto last = std::make_shared<std::shared_ptr<DeviceFrames>>(std::move(frames_));
  DeadlineThread().run(
      [last, id = device_.id] {
        forget_kernels(id);
        last->reset();
      },
      std::chrono::milliseconds(0));
  frames_.reset(), frame_.reset(), thread_.reset();
  if (report_)
    report_("depth_pipeline.device = " + device_.full_name() + " failed: " + why +
            "; the CPU processes this frame and all later ones");
}

}  // namespace remote_touch
