// Renderers that are wrong in one way each, for tests of the checks that should find it.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/kernels/isa.h"
#include "runners/experiment/catalog/factory.h"
#include "runners/experiment/catalog/renderer_contacts.h"

namespace remote_touch {

enum class Fault {
  none,
  silent,                  // never any force
  remembers_others,        // a second renderer differs from the first
  trusts_new_machines,     // differs with the instruction set
  looks_at_first_point,    // depends on the order in which a search returns points
  counts_points,           // size of the whole cloud matters, measured or not
  looks_far,               // points 1 km away matter
  regions_of_nothing,      // a column of radii matters, whatever it holds
  mistrusts_stiff_points,  // a column of stiffness matters beyond its values
  adds_its_own,            // adds its own stiffness to that of the points
  leans_x,                 // a little force to one side of the world
  leans_y,
  leans_z,
  prefers_up,         // forces along y are stronger
  fixed_gap,          // stays 0.1 mm further off, whatever its size
  fixed_strength,     // no force above 3 N, whatever the stiffness
  fixed_rate,         // uses the motion per tick as a velocity, as if ticks came at 1024 Hz
  reads_the_clock,    // weakens as time passes
  takes_every_frame,  // uses the newest frame to arrive, whenever it was captured
  drops_silently,     // does not report a dropped frame
  jolts_at_frames,    // every frame moves the proxy a little further
};

template <Fault kFault>
class WrongRenderer final : public Renderer {
 public:
  WrongRenderer(const ProxyParameters& parameters, double haptic_rate_hz, const Kernels& kernels)
      : parameters_(parameters), kernels_(kernels), right_(parameters, haptic_rate_hz, kernels) {
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
    RenderOutput out = right_.step(device, time_s);
    spoil(out, time_s);
    previous_W_ = out.proxy_W;
    return out;
  }

 private:
  std::size_t found_within(const Vec3& centre, double radius_m) {
    found_.clear();
    if (points_) points_->gather({centre, radius_m}, kernels_, found_);
    return found_.size();
  }
  double first_x() { return found_within(previous_W_, 0.01) > 0 ? found_.view().x[0] : 0; }

  void spoil(RenderOutput& out, double time_s) {
    const double strength = out.force_N.norm();
    switch (kFault) {
      case Fault::none:
        break;
      case Fault::silent:
        out.force_N.setZero();
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
      case Fault::regions_of_nothing:
        if (points_ && points_->has_fixture_radius()) out.nearest_distance_m += 1e-9;
        break;
      case Fault::mistrusts_stiff_points:
        if (points_ && points_->has_stiffness()) out.force_N *= 1 + 1e-5;
        break;
      case Fault::adds_its_own:
        if (points_ && points_->has_stiffness()) out.force_N *= 1 + 1e-6 * parameters_.stiffness_N_per_m;
        break;
      case Fault::leans_x:
      case Fault::leans_y:
      case Fault::leans_z:
        out.force_N[static_cast<int>(kFault) - static_cast<int>(Fault::leans_x)] += 1e-12 * strength;
        break;
      case Fault::prefers_up:
        out.force_N.y() *= 1.001;
        break;
      case Fault::fixed_gap:
        out.proxy_W += 1e-4 * out.normal_W;
        break;
      case Fault::fixed_strength:
        out.force_N *= strength > 3 ? 3 / strength : 1;
        break;
      case Fault::fixed_rate:
        out.surface_velocity_m_per_s += 1e-9 * 1024 * (out.proxy_W - previous_W_).norm();
        break;
      case Fault::reads_the_clock:
        out.force_N *= 1 - 1e-9 * time_s;
        break;
      case Fault::takes_every_frame:
        break;
      case Fault::drops_silently:
        if (out.status == RenderStatus::stale_frame_dropped) out.status = RenderStatus::ok;
        break;
      case Fault::jolts_at_frames:
        out.proxy_W += 1e-9 * frames_ * out.normal_W;
        break;
    }
  }

  const ProxyParameters parameters_;
  const Kernels& kernels_;
  ProxyRenderer right_;
  std::shared_ptr<const NeighbourSearch> points_;
  GatheredPoints found_;
  Vec3 previous_W_ = Vec3::Zero();
  double newest_s_ = 0;
  int frames_ = 0, ordinal_ = 0;
};

// Returns an entry as a line of the catalog makes it.
template <Fault kFault>
RendererEntry wrong_renderer(const char* name) {
  return {{name, "wrong in one way", []() -> std::unique_ptr<Factory<Renderer, double, const Kernels&>> {
             return std::make_unique<
                 FactoryFor<WrongRenderer<kFault>, ProxyParameters, Renderer, double, const Kernels&>>();
           }}};
}

}  // namespace remote_touch
