// 3-DOF rendering of streaming point clouds with a spherical proxy: chapter 4, and with fixture radii in the
// cloud chapter 5. The predecessor [1] is this renderer with step_rule = fixed and velocity_estimate = false.
#pragma once

#include "core/neighbourhood.h"
#include "core/proxy_parameters.h"
#include "core/renderer.h"
#include "core/surface_velocity.h"
#include "core/virtual_coupling.h"

namespace remote_touch {

class ProxyRenderer final : public Renderer {
 public:
  // pre: conflict(parameters) is empty. haptic_rate_hz: how often step() is called.
  ProxyRenderer(const ProxyParameters& parameters, double haptic_rate_hz, const Kernels& kernels);

  void reserve(std::size_t points) override { near_.reserve(points, true, true); }
  void on_frame(const Frame& frame) override;
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  struct Look {  // what the proxy sees from where it is
    Survey survey;
    ContactState state;
    PointsView points;
  };
  const Look& look();
  int move(const Vec3& hip_W);
  int close(const Vec3& hip_W);
  Vec3 next_step(const Look& here, const Vec3& u);
  Vec3 render_force(const Vec3& hip_W, double time_s, const RenderOutput& out);
  void report(const Vec3& hip_W, RenderOutput& out);
  double stiffness(const Survey& survey) const;
  Survey survey(const PointsView& points, const Vec3& p_W) const;
  Vec3 slave_command(const Vec3& hip_W, double time_s);

  const ProxyParameters p_;
  const Kernels& kernels_;
  Neighbourhood near_;
  SurfaceVelocity velocity_;
  VirtualCoupling coupling_;

  Look look_;  // from looked_from_W_, while has_look_
  Vec3 looked_from_W_ = Vec3::Zero();
  bool has_look_ = false;

  Vec3 proxy_W_ = Vec3::Zero();
  Vec3 normal_W_ = Vec3::Zero();
  Vec3 clear_W_ = RenderOutput{}.slave_W;  // the latest proxy position outside all regions
  bool is_clear_ = false;                  // outside those of the newest frame
  Vec3 slave_W_ = RenderOutput{}.slave_W;  // the newest command
  bool placed_ = false;                    // the proxy starts at the first HIP
  bool in_contact_ = false;                // until the proxy is free and unhindered again
  Vec3 contact_proxy_W_ = Vec3::Zero();    // the latest proxy position in contact state
  double contact_stiffness_N_per_m_ = 0;
  double frame_captured_s_ = 0, frame_arrived_s_ = 0;
  int frame_index_ = -1;
  Vec3 carried_m_ = Vec3::Zero();  // by (4.3) since the last tick
  bool stale_frame_ = false;
};

}  // namespace remote_touch
