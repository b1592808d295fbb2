// Renderers that are wrong in one way each, for tests of the checks that should find it: the proxy, and a
// tool.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/mesh_files/loaded_tool.h"

namespace remote_touch {

enum class Fault {
  none,
  silent,                  // never any force
  unknown_force,           // NaN in contact
  remembers_others,        // a second renderer differs from the first
  trusts_new_machines,     // differs with the instruction set
  looks_at_first_point,    // depends on the order in which a search returns points
  counts_points,           // size of the whole cloud matters, measured or not
  looks_far,               // points 1 km away matter
  fears_crowds,            // weaker where there are many points
  regions_of_nothing,      // a column of radii matters, whatever it holds
  mistrusts_stiff_points,  // a column of stiffness matters beyond its values
  adds_its_own,            // adds its own stiffness to that of the points
  leans_x,                 // a little force to one side of the world
  leans_y,
  leans_z,
  turns_about_x,  // always a little torque about an axis of the world
  turns_about_y,
  prefers_up,         // forces along y are stronger
  lies_flat,          // ignores how the device is turned
  fixed_gap,          // stays 0.1 mm (a tool: 2 mm) further off, whatever its size
  fixed_strength,     // no force above 3 N (a tool: 2 N), whatever the stiffness
  fixed_rate,         // uses the motion per tick as a velocity, as if ticks came at 1024 Hz
  reads_the_clock,    // weakens as time passes
  takes_every_frame,  // uses the newest frame to arrive, whenever it was captured
  drops_silently,     // does not report a dropped frame
  jolts_at_frames,    // every frame moves the proxy or tool a little further
  has_no_pose,        // an orientation that is not finite
};

template <Fault kFault, class Right, class SettingsOfRight>
class Spoiled final : public Renderer {
 public:
  using Settings = SettingsOfRight;
  Spoiled(const Settings& settings, double haptic_rate_hz, const Kernels& kernels)
      : settings_(settings), kernels_(kernels), right_(settings, haptic_rate_hz, kernels) {
    static int built = 0;
    ordinal_ = ++built;
  }

  void on_frame(const Frame& frame) override {
    ++frames_;
    Frame taken = frame;
    if (kFault == Fault::takes_every_frame) {
      newest_s_ = frames_ == 1 ? frame.captured_s : std::max(frame.captured_s, newest_s_ + 1e-6);
      taken.captured_s = newest_s_;
    }
    points_ = frame.points;
    found_.reserve(points_->size(), points_->has_fixture_radius(), points_->has_stiffness());
    right_.on_frame(taken);
  }

  RenderOutput step(const DeviceState& device, double time_s) override {
    DeviceState felt = device;
    if (kFault == Fault::lies_flat) felt.orientation_W.setIdentity();
    RenderOutput out = right_.step(felt, time_s);
    spoil(out, time_s);
    previous_W_ = out.proxy_W;
    return out;
  }

 private:
  static constexpr bool kIsTool = std::is_same_v<Right, LoadedTool>;

  std::size_t found_within(const Vec3& centre, double radius_m) {
    found_.clear();
    if (points_) points_->gather({centre, radius_m}, kernels_, found_);
    return found_.size();
  }
  double first_x() { return found_within(previous_W_, kIsTool ? 0.02 : 0.01) > 0 ? found_.view().x[0] : 0; }

  void spoil(RenderOutput& out, double time_s) {
    const double strength = out.force_N.norm();
    const bool has_radii = points_ && points_->has_fixture_radius(),
               has_stiffness = points_ && points_->has_stiffness();
    switch (kFault) {
      case Fault::none:
      case Fault::lies_flat:
      case Fault::takes_every_frame:
        break;
      case Fault::silent:
        out.force_N.setZero();
        break;
      case Fault::unknown_force:
        if (strength > 0) out.force_N.setConstant(std::nan(""));
        break;
      case Fault::remembers_others:
        out.force_N *= ordinal_;
        break;
      case Fault::trusts_new_machines:
        if (kernels_.isa != std::string(kernels_for(Isa::x86_64).isa)) out.force_N *= 1 + 1e-12;
        break;
      case Fault::looks_at_first_point:
        out.force_N *= 1 + first_x();
        break;
      case Fault::counts_points:
        out.force_N *= points_ ? 1 + 1e-9 * static_cast<double>(points_->size()) : 1;
        break;
      case Fault::looks_far:
        out.force_N *= 1 + 1e-9 * static_cast<double>(found_within(out.proxy_W, 1000));
        break;
      case Fault::fears_crowds:
        if (points_ && points_->size() > 3500) out.force_N *= 0.5;
        break;
      case Fault::regions_of_nothing:
        if (has_radii && kIsTool) out.force_N *= 1 + 1e-9;
        if (has_radii && !kIsTool) out.nearest_distance_m += 1e-9;
        break;
      case Fault::mistrusts_stiff_points:
        if (has_stiffness) out.force_N *= 1 + 1e-5;
        break;
      case Fault::adds_its_own:
        if constexpr (!kIsTool)
          if (has_stiffness) out.force_N *= 1 + 1e-6 * settings_.stiffness_N_per_m;
        break;
      case Fault::leans_x:
      case Fault::leans_y:
      case Fault::leans_z:
        out.force_N[static_cast<int>(kFault) - static_cast<int>(Fault::leans_x)] += 1e-12 * strength;
        break;
      case Fault::turns_about_x:
      case Fault::turns_about_y:
        out.tool->torque_Nm[kFault == Fault::turns_about_x ? 0 : 1] += 0.1;
        break;
      case Fault::prefers_up:
        out.force_N.y() *= 1.001;
        break;
      case Fault::fixed_gap:
        out.proxy_W += (kIsTool ? 2e-3 : 1e-4) * out.normal_W;
        break;
      case Fault::fixed_strength:
        out.force_N *= strength > kMaxForce_N ? kMaxForce_N / strength : 1;
        break;
      case Fault::fixed_rate:
        out.surface_velocity_m_per_s += 1e-9 * 1024 * (out.proxy_W - previous_W_).norm();
        break;
      case Fault::reads_the_clock:
        (kIsTool ? out.tool->torque_Nm : out.force_N) *= 1 - 1e-9 * time_s;
        break;
      case Fault::drops_silently:
        if (out.status == RenderStatus::stale_frame_dropped) out.status = RenderStatus::ok;
        break;
      case Fault::jolts_at_frames:
        out.proxy_W += (kIsTool ? 1e-3 : 1e-9) * frames_ * out.normal_W;
        break;
      case Fault::has_no_pose:
        out.tool->orientation_W.coeffs().setConstant(std::nan(""));
        break;
    }
  }

  static constexpr double kMaxForce_N = kIsTool ? 2 : 3;
  const Settings settings_;
  const Kernels& kernels_;
  Right right_;
  std::shared_ptr<const NeighbourSearch> points_;
  GatheredPoints found_;
  Vec3 previous_W_ = Vec3::Zero();
  double newest_s_ = 0;
  int frames_ = 0, ordinal_ = 0;
};

template <Fault kFault>
using WrongRenderer = Spoiled<kFault, ProxyRenderer, ProxyParameters>;

// Returns an entry as a line of the catalog makes it.
template <Fault kFault>
RendererEntry wrong_renderer(const char* name) {
  return renderer_entry<WrongRenderer<kFault>>(name, DegreesOfFreedom::three, "wrong in one way");
}
template <Fault kFault>
RendererEntry wrong_tool(const char* name) {
  return renderer_entry<Spoiled<kFault, LoadedTool, LoadedTool::Settings>>(name, DegreesOfFreedom::six,
                                                                           "wrong in one way");
}

}  // namespace remote_touch
