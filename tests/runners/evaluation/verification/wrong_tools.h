// Renderers of a tool that are wrong in one way each, for tests of the checks that should find it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/kernels/isa.h"
#include "runners/experiment/catalog/factory.h"
#include "runners/experiment/tool_files/loaded_tool.h"

namespace remote_touch {

enum class ToolFault {
  none,
  silent,               // never any force
  remembers_others,     // a second renderer differs from the first
  trusts_new_machines,  // differs with the instruction set
  sees_first_point,     // depends on the order in which a search returns points
  counts_points,        // size of the whole cloud matters, measured or not
  fears_crowds,         // weaker where there are many points
  sees_radii,           // a column of radii matters, whatever it holds
  turns_about_x,        // always a little torque about an axis of the world
  turns_about_y,
  lies_flat,        // ignores how the device is turned
  fixed_gap,        // stays 2 mm further off, whatever its size
  fixed_strength,   // no force above 2 N, whatever the stiffness
  fixed_rate,       // uses the motion per tick as a velocity, as if ticks came at 1024 Hz
  reads_the_clock,  // weakens as time passes
  drops_silently,   // does not report a dropped frame
  jolts_at_frames,  // every frame moves the tool further
  has_no_pose,      // an orientation that is not finite
};

template <ToolFault kFault>
class WrongTool final : public Renderer {
 public:
  WrongTool(const LoadedTool::Settings& settings, double haptic_rate_hz, const Kernels& kernels)
      : kernels_(kernels), right_(settings, haptic_rate_hz, kernels) {
    static int built = 0;
    ordinal_ = ++built;
  }

  void on_frame(const Frame& frame) override {
    ++frames_;
    points_ = frame.points;
    right_.on_frame(frame);
  }

  RenderOutput step(const DeviceState& device, double time_s) override {
    DeviceState felt = device;
    if (kFault == ToolFault::lies_flat) felt.orientation_W.setIdentity();
    RenderOutput out = right_.step(felt, time_s);
    spoil(out, time_s);
    previous_W_ = out.proxy_W;
    return out;
  }

 private:
  double first_x() const {
    GatheredPoints found;
    if (!points_) return 0;
    found.reserve(points_->size(), points_->has_fixture_radius(), points_->has_stiffness());
    points_->gather({previous_W_, 0.02}, kernels_, found);
    return found.size() > 0 ? found.view().x[0] : 0;
  }

  void spoil(RenderOutput& out, double time_s) const {
    const double strength = out.force_N.norm();
    switch (kFault) {
      case ToolFault::none:
      case ToolFault::lies_flat:
        break;
      case ToolFault::has_no_pose:
        out.tool->orientation_W.coeffs().setConstant(std::nan(""));
        break;
      case ToolFault::silent:
        out.force_N.setZero();
        break;
      case ToolFault::remembers_others:
        out.force_N *= ordinal_;
        break;
      case ToolFault::trusts_new_machines:
        if (kernels_.isa != std::string(kernels_for(Isa::x86_64).isa)) out.force_N *= 1 + 1e-12;
        break;
      case ToolFault::sees_first_point:
        out.force_N *= 1 + first_x();
        break;
      case ToolFault::counts_points:
        out.force_N *= points_ ? 1 + 1e-9 * static_cast<double>(points_->size()) : 1;
        break;
      case ToolFault::fears_crowds:
        if (points_ && points_->size() > 3500) out.force_N *= 0.5;
        break;
      case ToolFault::sees_radii:
        if (points_ && points_->has_fixture_radius()) out.force_N *= 1 + 1e-9;
        break;
      case ToolFault::turns_about_x:
      case ToolFault::turns_about_y:
        out.tool->torque_Nm[kFault == ToolFault::turns_about_x ? 0 : 1] += 0.1;
        break;
      case ToolFault::fixed_gap:
        out.proxy_W += 2e-3 * out.normal_W;
        break;
      case ToolFault::fixed_strength:
        out.force_N *= strength > 2 ? 2 / strength : 1;
        break;
      case ToolFault::fixed_rate:
        out.surface_velocity_m_per_s += 1e-9 * 1024 * (out.proxy_W - previous_W_).norm();
        break;
      case ToolFault::reads_the_clock:
        out.tool->torque_Nm *= 1 - 1e-9 * time_s;
        break;
      case ToolFault::drops_silently:
        if (out.status == RenderStatus::stale_frame_dropped) out.status = RenderStatus::ok;
        break;
      case ToolFault::jolts_at_frames:
        out.proxy_W += 1e-3 * frames_ * out.normal_W;
        break;
    }
  }

  const Kernels& kernels_;
  LoadedTool right_;
  std::shared_ptr<const NeighbourSearch> points_;
  Vec3 previous_W_ = Vec3::Zero();
  int frames_ = 0, ordinal_ = 0;
};

// Returns an entry as a line of the catalog makes it.
template <ToolFault kFault>
RendererEntry wrong_tool(const char* name) {
  return {{name, "wrong in one way",
           []() -> std::unique_ptr<Factory<Renderer, double, const Kernels&>> {
             return std::make_unique<
                 FactoryFor<WrongTool<kFault>, LoadedTool::Settings, Renderer, double, const Kernels&>>();
           }},
          DegreesOfFreedom::six};
}

}  // namespace remote_touch
