// Common base of the 3-DOF methods for comparison: renderers written from other papers, which are compared
// with the proxy of chapter 4 in the same scenes with the same noise. This class handles what is not part of
// any method: the order of frames, a lost device, and the output before the first frame. Beside it, the
// penalty method.
#pragma once

#include <memory>
#include <string>

#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

class RivalRenderer : public Renderer {
 public:
  void reserve(std::size_t points) override { near_.reserve(points, true, true); }
  void on_frame(const Frame& frame) final;
  RenderOutput step(const DeviceState& device, double time_s) final;

 protected:
  // reach_m: largest distance at which a point affects the method.
  RivalRenderer(double reach_m, double stiffness_N_per_m, const Kernels& kernels)
      : near_(reach_m, kernels), kernels_(kernels), stiffness_N_per_m_(stiffness_N_per_m) {}

  // Returns the points that the method renders for a new frame. The default is the frame's own points.
  virtual std::shared_ptr<const NeighbourSearch> shown(const Frame& frame) { return frame.points; }
  // Starts to use these points. Returns false if the method cannot use them. The outputs are then those
  // without a frame until the next frame.
  virtual bool set_points(const NeighbourSearch& /*points*/) { return true; }
  // Computes one tick. pre: the HIP is finite and the method can use the frame. The proxy starts at the first
  // HIP. The function fills in force_N, state, nearest_distance_m, steps, converged, contact_count and
  // status, and leaves the proxy and the normal in the members below.
  virtual void touch(const Vec3& hip_W, RenderOutput& out) = 0;
  // Resets the state that assumes a continuous motion, because the HIP is lost or there is no frame.
  virtual void reset_motion() {}

  // Queries the points within reach of the proxy, without their r_f. Writes the nearest distance to the
  // output; infinite beyond the reach. sum_grid: M of core/kernels/kernels.h for the list of points.
  ContactQuery query_near_proxy(PointsView points, double sum_grid, double reach_m, RenderOutput& out) const;
  // Returns the stiffness (5.8) if the points have one, else the renderer's own.
  double stiffness_of(const ContactQuery& query) const {
    return query.weight_sum > 0 ? query.stiffness_sum / query.weight_sum : stiffness_N_per_m_;
  }

  Neighbourhood near_;
  const Kernels& kernels_;
  double stiffness_N_per_m_;
  Vec3 proxy_W_ = Vec3::Zero();
  Vec3 normal_W_ = Vec3::Zero();
  double time_s_ = 0;  // time of the current tick

 private:
  FrameOrder order_;
  bool usable_ = false;  // the method can use the newest frame
  bool placed_ = false;  // the proxy has a position
};

// A method with these settings, whose stiffness is a live one.
template <class Settings>
class RivalOf : public RivalRenderer {
 public:
  Parameters live_parameters() override { return live_ones(parameters(p_)); }
  void parameters_changed() override { stiffness_N_per_m_ = p_.stiffness_N_per_m; }

 protected:
  RivalOf(const Settings& settings, double reach_m, const Kernels& kernels)
      : RivalRenderer(reach_m, settings.stiffness_N_per_m, kernels), p_(settings) {}

  Settings p_;
};

// Returns an upper bound, over all poses, of the increase of |force| per displacement of the HIP, N/m, for
// the settings of a method with one spring. It covers neither a damper nor points that have a stiffness of
// their own.
template <class Settings>
requires requires(const Settings& s) {
  s.stiffness_N_per_m;
}
double max_stiffness_N_per_m(const Settings& s) {
  return s.stiffness_N_per_m;
}

// The penalty method (direct rendering), 2.1.1 of the dissertation, the oldest of the methods with which the
// proxy is compared. It has no proxy: the HIP is the centre of a ball of radius r_c, and a spring pushes it
// out in proportion to the depth of the nearest point in the ball,
//
//   F = k_s (r_c - r_n) n,    r_n = |HIP - x| - r_f of the nearest region (5.5),
//
// along the unit normal n (4.1) of the points within r_3 of the HIP, with the weights of (4.2), r_1 = r_c.
// Damping subtracts k_d times the HIP's velocity along n; the force never pulls.
//
// Known limits, which the comparison should show: n reverses when the HIP passes the points, so that the
// force then pushes to the far side (pop-through). The force is at most k_s r_c. The pattern of the points
// can be felt. dF/dx is k_s only along n, because n itself turns fast when the HIP is near the points.
//
// Outputs: the proxy is the HIP; contact_count is the number of points within r_c; the state is contact if
// r_n < r_c.

struct PenaltyParameters {
  double contact_radius_m = 0.005;
  double r3_m = 0.01;
  double stiffness_N_per_m = 600;
  double damping_Ns_per_m = 0;
};

Parameters parameters(PenaltyParameters& p);
std::string validate(const PenaltyParameters& p);
inline RenderedContact rendered_contact(const PenaltyParameters& p) {
  return {p.contact_radius_m, p.stiffness_N_per_m};
}

class PenaltyRenderer final : public RivalOf<PenaltyParameters> {
 public:
  // haptic_rate_hz: the rate at which step() is called.
  PenaltyRenderer(const PenaltyParameters& parameters, double haptic_rate_hz, const Kernels& kernels);

 private:
  void touch(const Vec3& hip_W, RenderOutput& out) override;
  void reset_motion() override { has_previous_ = false; }

  double haptic_rate_hz_;
  Vec3 previous_hip_W_ = Vec3::Zero();
  double previous_time_s_ = 0;
  bool has_previous_ = false;
};

}  // namespace remote_touch
