// 3-DOF rendering of streaming point clouds with a spherical proxy: chapter 4, or chapter 5 if the cloud has
// fixture radii. The predecessor [1] is this renderer with step_rule = fixed and velocity_estimate = false.
#pragma once

#include <optional>

#include "core/dissertation/proxy/proxy_motion.h"
#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// Force rendering, 4.2.6: a spring and damper between the HIP and the contact point of the proxy.
class VirtualCoupling {
 public:
  // haptic_rate_hz is f_h of (4.16).
  VirtualCoupling(const ProxyParameters& parameters, double haptic_rate_hz)
      : velocity_force_(parameters.velocity_force),
        damping_sign_(parameters.damping_sign),
        damping_Ns_per_m_(parameters.damping_Ns_per_m),
        contact_radius_m_(parameters.contact_radius_m()),
        haptic_rate_hz_(haptic_rate_hz) {}

  // Returns the force on the hand by (4.15) and (4.16), N. It points towards the proxy, unless the damper
  // reverses it. It is zero while |u_hat| of (4.15) is at most r_c. u = HIP - P; since_frame_s = t - t_j;
  // velocity = v_hat as a vector; ticks = number of ticks since the last call, more than 1 after missed
  // ticks. The rate in the damper's term is the change of |u_hat| since the last call divided by the time of
  // these ticks.
  Vec3 force(const Vec3& u, double since_frame_s, const Vec3& velocity, double stiffness_N_per_m,
             double ticks = 1);
  // Ends a contact: the next force has a rate of zero, because there is no previous length to compare with.
  void release() { has_previous_ = false; }
  void set_contact_radius(double radius_m) { contact_radius_m_ = radius_m; }

 private:
  VelocityForce velocity_force_;
  DampingSign damping_sign_;
  double damping_Ns_per_m_, contact_radius_m_, haptic_rate_hz_;
  double previous_length_ = 0;
  bool has_previous_ = false;
};

// The motion of a surface from one frame to the next.
struct SurfaceMotion {
  Vec3 displacement_m = Vec3::Zero();  // displacement of the proxy
  double velocity_m_per_s = 0;         // along the normal, positive towards the proxy
  Vec3 normal_W = Vec3::Zero();
};

class ProxyRenderer final : public Renderer {
 public:
  // haptic_rate_hz: how often step() is called.
  ProxyRenderer(const ProxyParameters& parameters, double haptic_rate_hz, const Kernels& kernels);

  void reserve(std::size_t points) override { near_.reserve(points, true, true); }
  void on_frame(const Frame& frame) override;
  // Adds a frame with a motion that was measured by other means and replaces (4.3) and (4.13).
  void on_frame(const Frame& frame, const SurfaceMotion& motion);
  // Replaces the newest frame's points.
  void replace_points(std::shared_ptr<const NeighbourSearch> points);
  // Moves the proxy with a surface, world frame.
  void displace(const Vec3& displacement_m);
  // Selects whether a tick also ends when the proxy in contact has converged (4.8). A tick always ends when a
  // step changes nothing or after steps_per_tick steps.
  void stop_at_convergence(bool stop) { stops_at_convergence_ = stop; }
  // Sets r1, r2 and r3 of Table 4.2, for methods that adapt them to the points. They are valid, as parameters
  // are.
  void set_radii(double r1_m, double r2_m, double r3_m);
  Parameters live_parameters() override { return live_ones(parameters(p_)); }
  void parameters_changed() override;
  bool is_newer(const Frame& frame) const { return order_.is_newer(frame); }
  const Vec3& proxy_W() const { return proxy_W_; }
  bool in_contact() const { return in_contact_; }
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  bool take(const Frame& frame);
  std::optional<double> felt_radius_m();
  struct LocalQuery {  // state, normal and neighbours at a proxy position
    ContactQuery query;
    ContactState state;
    PointsView points;
  };
  const LocalQuery& local_query();
  KnownStep state_at_proxy();
  void note_state(const KnownStep& here);
  void find_motion(KnownStep& here, const Vec3& u);
  int move(const Vec3& hip_W);
  int leave_regions(const Vec3& hip_W);
  bool update_region_rule(const LocalQuery& here);
  Vec3 next_step(const LocalQuery& here, const Vec3& u);
  Vec3 render_force(const Vec3& hip_W, double time_s, const RenderOutput& out);
  void report(const Vec3& hip_W, RenderOutput& out);
  double stiffness(const ContactQuery& query) const;
  ContactQuery query(const PointsView& points, const Vec3& p_W) const;
  Vec3 slave_command(const Vec3& hip_W, double time_s);

  ProxyParameters p_;
  const Kernels& kernels_;
  const double haptic_rate_hz_;
  Neighbourhood near_;
  SurfaceVelocity velocity_;
  VirtualCoupling coupling_;

  LocalQuery local_query_;  // query at query_position_W_; valid while has_local_query_
  Vec3 query_position_W_ = Vec3::Zero();
  bool has_local_query_ = false;

  KnownSteps known_steps_;

  Vec3 proxy_W_ = Vec3::Zero();
  Vec3 normal_W_ = Vec3::Zero();
  Vec3 clear_W_ = RenderOutput{}.slave_W;  // the latest proxy position outside all regions
  bool is_clear_ = false;                  // clear_W_ is outside all regions of the newest frame
  Vec3 slave_W_ = RenderOutput{}.slave_W;  // the newest command
  bool placed_ = false;                    // the proxy was placed at the first HIP
  bool in_contact_ = false;                // stays true until a free tick, or until free at the HIP
  bool in_crease_ = false;                 // last result of update_region_rule() under ContactMotion::creases
  Vec3 contact_proxy_W_ = Vec3::Zero();    // the latest proxy position in contact state
  double contact_stiffness_N_per_m_ = 0;   // k_s there, see stiffness(); 0 before the first contact
  FrameOrder order_;
  double frame_arrived_s_ = 0;
  double force_time_s_ = 0;                 // time of the tick whose force was computed last
  Vec3 frame_correction_m_ = Vec3::Zero();  // displacement by frames since the last tick, (4.3)
  bool stops_at_convergence_ = false;
};

}  // namespace remote_touch
