// The 6-DOF renderer for experiments, chapter 6: a tool made from a mesh, and its motion.
#pragma once

#include <string>

#include "core/tool/motion/tool_renderer.h"
#include "runners/tool_files/tool_loading.h"

namespace remote_touch {

class LoadedTool final : public Renderer {
 public:
  struct Settings {
    ToolSettings tool;
    ToolParameters motion;
  };

  // Throws InputError when the tool cannot be made.
  LoadedTool(const Settings& settings, double haptic_rate_hz, const Kernels& kernels);
  void prepare(Frame& frame) const override { renderer_.prepare(frame); }
  void reserve(std::size_t points) override { renderer_.reserve(points); }
  void on_frame(const Frame& frame) override { renderer_.on_frame(frame); }
  RenderOutput step(const DeviceState& device, double time_s) override {
    return renderer_.step(device, time_s);
  }

 private:
  ToolRenderer renderer_;
};

Parameters parameters(LoadedTool::Settings& s);
std::string validate(const LoadedTool::Settings& s);
std::vector<RecordingPart> input_files(const LoadedTool::Settings& s);
inline double max_stiffness_N_per_m(const LoadedTool::Settings& s) {
  return max_stiffness_N_per_m(s.motion);
}

}  // namespace remote_touch
