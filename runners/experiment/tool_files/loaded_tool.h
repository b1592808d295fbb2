// 6-DOF renderers for experiments: a tool made from a mesh, and one of four motions. These are the motion of
// chapter 6, the same on tracked sheets, and two motions for comparison, penalty and god-object.
#pragma once

#include <memory>
#include <string>

#include "core/beyond/tracked_surface/tracked_tool_renderer.h"
#include "core/dissertation/tool/motion/god_object_motion.h"
#include "core/dissertation/tool/motion/penalty_motion.h"
#include "core/dissertation/tool/motion/tool_renderer.h"
#include "runners/experiment/tool_files/tool_loading.h"

namespace remote_touch {

// MotionSettings: ToolParameters, TrackedToolParameters, ToolPenaltyParameters or ToolGodObjectParameters.
template <class MotionSettings>
class ToolFromMesh final : public Renderer {
 public:
  struct Settings {
    ToolSettings tool;
    MotionSettings motion;
  };

  // Throws InputError when the tool cannot be made.
  ToolFromMesh(const Settings& settings, double haptic_rate_hz, const Kernels& kernels);
  void prepare(Frame& frame) const override { renderer_->prepare(frame); }
  void reserve(std::size_t points) override { renderer_->reserve(points); }
  void on_frame(const Frame& frame) override { renderer_->on_frame(frame); }
  Parameters live_parameters() override { return renderer_->live_parameters(); }
  void parameters_changed() override { renderer_->parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override {
    return renderer_->step(device, time_s);
  }

 private:
  std::unique_ptr<Renderer> renderer_;
};

using LoadedTool = ToolFromMesh<ToolParameters>;
using LoadedTrackedTool = ToolFromMesh<TrackedToolParameters>;
using LoadedToolPenalty = ToolFromMesh<ToolPenaltyParameters>;
using LoadedToolGodObject = ToolFromMesh<ToolGodObjectParameters>;

Parameters parameters(LoadedTool::Settings& s);
Parameters parameters(LoadedTrackedTool::Settings& s);
Parameters parameters(LoadedToolPenalty::Settings& s);
Parameters parameters(LoadedToolGodObject::Settings& s);
std::string validate(const LoadedTool::Settings& s);
std::string validate(const LoadedTrackedTool::Settings& s);
std::string validate(const LoadedToolPenalty::Settings& s);
std::string validate(const LoadedToolGodObject::Settings& s);
std::vector<RecordingPart> input_files(const LoadedTool::Settings& s);
std::vector<RecordingPart> input_files(const LoadedTrackedTool::Settings& s);
std::vector<RecordingPart> input_files(const LoadedToolPenalty::Settings& s);
std::vector<RecordingPart> input_files(const LoadedToolGodObject::Settings& s);
inline double max_stiffness_N_per_m(const LoadedTool::Settings& s) {
  return max_stiffness_N_per_m(s.motion);
}
inline double max_stiffness_N_per_m(const LoadedTrackedTool::Settings& s) {
  return max_stiffness_N_per_m(s.motion);
}
inline double max_stiffness_N_per_m(const LoadedToolPenalty::Settings& s) {
  return max_stiffness_N_per_m(s.motion);
}
inline double max_stiffness_N_per_m(const LoadedToolGodObject::Settings& s) {
  return max_stiffness_N_per_m(s.motion);
}

}  // namespace remote_touch
