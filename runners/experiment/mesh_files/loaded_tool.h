// 6-DOF renderers for experiments: a tool made from a mesh, and one of five motions. These are the motion of
// chapter 6, the same on tracked sheets, and three motions for comparison: penalty, god-object and inner
// spheres.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/beyond/tracked_surface/tracked_renderers.h"
#include "core/dissertation/tool/motion/god_object_motion.h"
#include "core/dissertation/tool/motion/penalty_motion.h"
#include "core/dissertation/tool/motion/tool_renderer.h"
#include "core/rivals/inner_sphere_motion.h"
#include "runners/experiment/mesh_files/tool_loading.h"

namespace remote_touch {

// MotionSettings: ToolParameters, TrackedToolParameters, ToolPenaltyParameters, ToolGodObjectParameters or
// InnerSphereParameters.
template <class MotionSettings>
struct MovedToolSettings {
  ToolSettings tool;
  MotionSettings motion;
};

// Passes every call on to a renderer of another class.
class LoadedRenderer : public Renderer {
 public:
  void prepare(Frame& frame) const override { renderer_->prepare(frame); }
  void reserve(std::size_t points) override { renderer_->reserve(points); }
  void on_frame(const Frame& frame) override { renderer_->on_frame(frame); }
  Parameters live_parameters() override { return renderer_->live_parameters(); }
  void parameters_changed() override { renderer_->parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override {
    return renderer_->step(device, time_s);
  }

 protected:
  explicit LoadedRenderer(std::unique_ptr<Renderer> renderer) : renderer_(std::move(renderer)) {}

 private:
  std::unique_ptr<Renderer> renderer_;
};

template <class MotionSettings>
class ToolFromMesh final : public LoadedRenderer {
 public:
  using Settings = MovedToolSettings<MotionSettings>;

  // Throws InputError when the tool cannot be made.
  ToolFromMesh(const Settings& settings, double haptic_rate_hz, const Kernels& kernels);
};

using LoadedTool = ToolFromMesh<ToolParameters>;
using LoadedTrackedTool = ToolFromMesh<TrackedToolParameters>;
using LoadedToolPenalty = ToolFromMesh<ToolPenaltyParameters>;
using LoadedToolGodObject = ToolFromMesh<ToolGodObjectParameters>;
using LoadedToolInnerSpheres = ToolFromMesh<InnerSphereParameters>;

template <class MotionSettings>
Parameters parameters(MovedToolSettings<MotionSettings>& s) {
  return appended(parameters(s.tool), parameters(s.motion));
}
template <class MotionSettings>
std::string validate(const MovedToolSettings<MotionSettings>& s) {
  const std::string tool = validate(s.tool);
  return tool.empty() ? validate(s.motion) : tool;
}
template <class MotionSettings>
std::vector<InputPart> input_files(const MovedToolSettings<MotionSettings>& s) {
  return input_files(s.tool);
}
template <class MotionSettings>
double max_stiffness_N_per_m(const MovedToolSettings<MotionSettings>& s) {
  return max_stiffness_N_per_m(s.motion);
}
template <class MotionSettings>
RenderedContact rendered_contact(const MovedToolSettings<MotionSettings>&) {
  return RenderedContact::unknown();
}

// The 6-DOF fixture renderer for experiments, chapter 7: a tool of spheres made from a mesh, and its motion.
class LoadedSpheres final : public LoadedRenderer {
 public:
  struct Settings {
    ToolSettings tool{.mesh = "key"};
    int leaves = 112;
    // Regions are round, so each step of the motion covers only a fraction of the way to its end. A tick ends
    // when a step is shorter than a hundredth of a millimetre, which is less than a hand can feel. When a
    // frame has enclosed the tool, about ten detections lead out. Ticks that need many more slide along
    // creases, and the motion can continue in the next tick.
    ToolParameters motion{.detections_per_tick = 30, .rest_threshold_m = 1e-5};
  };

  // Throws InputError when the tool cannot be made.
  LoadedSpheres(const Settings& settings, double haptic_rate_hz, const Kernels& kernels);
};

Parameters parameters(LoadedSpheres::Settings& s);
std::string validate(const LoadedSpheres::Settings& s);
std::vector<InputPart> input_files(const LoadedSpheres::Settings& s);
inline double max_stiffness_N_per_m(const LoadedSpheres::Settings& s) {
  return max_stiffness_N_per_m(s.motion);
}
inline RenderedContact rendered_contact(const LoadedSpheres::Settings&) {
  return RenderedContact::unknown();
}

}  // namespace remote_touch
