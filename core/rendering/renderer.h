// The interface of every haptic renderer: frames at the camera's rate, steps at the haptic rate. Beside it,
// what most renderers need: the order of frames, and data that is prepared from a frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"
#include "core/rendering/frame.h"

namespace remote_touch {

// Force on the hand, and torque about the device's position, as a renderer commands them and a device exerts
// them; world frame.
struct Wrench {
  Vec3 force_N = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();
};

enum class ContactState { free = 0, contact = 1, entrenched = 2 };

// The reason why an output is not an ordinary one. Only the most serious reason is reported.
// device_not_finite includes a HIP more than 1000 km away.
enum class RenderStatus {
  ok = 0,
  stale_frame_dropped = 1,
  degenerate_normal = 2,
  no_frame = 3,
  device_not_finite = 4
};

// The additional output of a renderer of a rigid tool, chapter 6. The tool frame has its origin in the centre
// of mass of the tool, which is RenderOutput::proxy_W.
struct ToolOutput {
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();  // rotates tool coordinates to the world
  Vec3 torque_Nm = Vec3::Zero();  // torque on the hand about the HIP, world frame
  // The contacts are those of the pose at the end of the tick. RenderOutput::contact_count is the number of
  // points that touch.
  int active_constraints = 0;     // rows of (6.5) that hold the tool; penalty methods: pushing points
  int contact_clusters = 0;       // groups of touching points, 10 mm cells of the tool frame
  double tool_penetration_m = 0;  // depth of the deepest point of the newest frame; 0 or more
  int detections = 0;             // collision detections made in this tick
  bool budget_exhausted = false;  // the tick ended before the tool had converged
  int disabled_points = 0;  // points of the newest frame without a normal; ContactRule::voxels ignores them
};

// The additional output of guidance, 7.3.2 and 7.4. Its wrench is part of RenderOutput::force_N and
// ToolOutput::torque_Nm.
struct GuidanceOutput {
  bool active = false;  // a guidance fixture pulls to a goal
  Vec3 force_N = Vec3::Zero(), torque_Nm = Vec3::Zero();
  // The goal pose, world frame; NaN while not active.
  Vec3 goal_W = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Quaterniond goal_orientation_W{Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN())};
  int sequence_step = 0;          // the task's current step, from 0; after the last, the number of steps
  bool sequence_running = false;  // the step has begun
  int sequence_missed = 0;        // number of steps that missed their deadline so far
  // Distance and angle from the tool to the goal of the first step that ended in this tick and had a goal to
  // reach; NaN if there was none.
  double sequence_distance_m = std::numeric_limits<double>::quiet_NaN();
  double sequence_angle_rad = std::numeric_limits<double>::quiet_NaN();
};

// Metres, newtons, world frame. force_N acts on the hand that holds the device.
struct RenderOutput {
  Vec3 proxy_W = Vec3::Zero();
  Vec3 force_N = Vec3::Zero();
  // The commanded position of the slave robot, 5.2. A proxy position inside a region is never commanded: the
  // last command is repeated until there is a valid one. NaN before the first. A slave robot with a tool also
  // follows the orientation of the commanded pose, which is that of the tool or of the device.
  Vec3 slave_W = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  ContactState state = ContactState::free;  // state of proxy_W
  Vec3 normal_W = Vec3::Zero();         // unit, out of the surface; zero before the first points came near
  double surface_velocity_m_per_s = 0;  // estimate along the normal, positive towards the proxy, (4.13)
  double nearest_distance_m = 0;        // distance of proxy_W to the nearest region, r_n of (5.5); infinite
                                        // beyond the renderer's reach
  Vec3 frame_correction_m = Vec3::Zero();  // proxy displacement by frame updates since the last tick, (4.3)
  int steps = 0;                           // proxy steps made in this tick
  bool converged = false;                  // (4.8)
  int contact_count = 0;                   // points within r2
  int frame_index = -1;                    // newest frame in use, -1 before the first
  RenderStatus status = RenderStatus::ok;
  std::optional<ToolOutput> tool;          // a 3-DOF renderer has none
  std::optional<GuidanceOutput> guidance;  // only in experiments with guidance or a sequence
};

// Receives the frames of a stream.
class FrameReceiver {
 public:
  virtual ~FrameReceiver() = default;
  virtual void on_frame(const Frame& frame) = 0;
};

class Renderer : public FrameReceiver {
 public:
  // Does the slow part of processing a frame, so that on_frame() is short. Sets frame.prepared for renderers
  // of the same kind and settings. May run in parallel to on_frame() and step(), so it reads no live
  // parameter. The results of the renderer do not depend on it.
  virtual void prepare(Frame& /*frame*/) const {}
  // Reserves memory for frames of `points` points. An image counts with its number of pixels, both sides
  // rounded up to multiples of 16. Afterwards on_frame() of a prepared frame allocates nothing. on_frame()
  // releases the previous frame: the caller keeps a reference to that one if memory must not be freed there
  // either.
  virtual void reserve(std::size_t /*points*/) {}
  // Adds a new frame, prepared or not. A frame that is not newer than the last one is dropped, and the status
  // of the next output reports it.
  void on_frame(const Frame& frame) override = 0;
  // Returns the settings that are marked live, with pointers to the renderer's own values. The thread of
  // step() may set these values between two steps, to others that validate() allows. parameters_changed()
  // then applies them, without an allocation.
  virtual Parameters live_parameters() { return {}; }
  virtual void parameters_changed() {}
  // Computes one haptic tick at time_s, which must not decrease. It does not allocate, lock or throw: errors
  // are reported as a status.
  virtual RenderOutput step(const DeviceState& device, double time_s) = 0;
};

// Returns the wrench that the renderer commands. Without a tool it has no torque.
inline Wrench rendered_wrench(const RenderOutput& out) {
  return {out.force_N, out.tool ? out.tool->torque_Nm : Vec3(Vec3::Zero())};
}

// The contact point of a renderer, and its height above the true surface: the quantity by which a ball, a
// point and a spring without a proxy are compared.
//
// The centre of a ball in contact is r_c above the surface, and a point proxy is on it. The height of the
// contact point is therefore
//
//   height = d(x) - rest distance,
//
// where x is the renderer's position and d the signed distance to the true surface, positive outside. For a
// ball it is the height of the point that faces the surface, because d is measured along the outward normal
// of the surface. The height is 0 where the rendered surface is the true one, positive where it floats above
// it and negative where it has sunk below it.
//
// A renderer with a proxy has x = RenderOutput::proxy_W, and a spring pulls the hand towards it. The depth of
// the hand does not matter. A penalty force has no proxy: the hand sinks until the spring holds it, as the
// hand of the other methods sinks below the proxy. This depth must not count either. x is therefore the
// position at which the force would end: x = HIP + F / k, with the force F of this tick and its stiffness k.
// The penalty force of the dissertation over a plane is F = k (r_c - d(HIP)) n, so d(x) = r_c and the height
// is 0, however deep the press is. Once the HIP has passed the points, F pushes it further, x is below the
// surface too, and the height is negative. Dampers are not considered, because no method of the scorecard has
// one.
struct RenderedContact {
  // The contact of a tool, which has a shape and not a radius.
  static RenderedContact unknown() { return {std::numeric_limits<double>::quiet_NaN()}; }

  double rest_distance_m = 0;  // distance of x from a flat, noise-free surface in contact; NaN: not known
  double spring_N_per_m = 0;   // above 0: there is no proxy, and x = HIP + F / k with this k
  // Above 0: the proxy is a ball of this radius that single points hold, as in chapter 4, so that it falls
  // through between points that are too far apart. 0: something else holds the proxy, such as a mesh, or
  // there is no proxy.
  double ball_radius_m = 0;
};

// A contact point that has sunk less than this below the true surface has not passed through it, m: half the
// contact radius of 4.3. Noise tilts and shifts the surface that a renderer estimates, and moves it to both
// sides alike. A plane through the points within 10 mm at the spacing of most scenes, 1.5 mm, has 140 points,
// so that even noise of r_c = 5 mm shifts it by 0.42 mm (standard deviation), a sixth of this.
inline constexpr double kMinSink_m = 0.0025;

// Returns the distance, m, by which x may lie behind the true surface and still count as held in front of it.
// A ball counts as held until its centre is behind the surface: it has then sunk by its rest distance. A
// position that rests on the surface, or nearly, would be behind it by rounding alone, so it may sink by
// kMinSink_m. Returns 0 if the rest distance is not known.
inline double held_depth_m(const RenderedContact& contact) {
  return std::isnan(contact.rest_distance_m) ? 0 : std::max(0.0, kMinSink_m - contact.rest_distance_m);
}

// Choices that the proxy and the tool share: the velocity term of the force, and the command of the slave
// robot.

enum class VelocityForce { minus, plus, none };  // sign of the velocity term of (4.15); plus is printed
// Pose that the slave robot follows, 5.2. rendered: that of the proxy or tool, a hard constraint. hip: that
// of the device, a soft constraint.
enum class SlaveCommand { rendered, hip };

// Returns the number of ticks between two calls of a renderer or of a simulated hand: from before_s to now_s,
// rounded, and at least 1. It is also 1 if the time does not advance, decreases or is NaN.
inline double elapsed_ticks(double before_s, double now_s, double haptic_rate_hz) {
  return std::max(1.0, std::floor((now_s - before_s) * haptic_rate_hz + 0.5));
}

// The newest frame of a stream. A frame that was captured no later than the newest one is dropped, and the
// drop is reported once.
class FrameOrder {
 public:
  // Returns true if the frame was captured after the newest one, or is the first.
  bool is_newer(const Frame& frame) const;
  // Same as is_newer(). A newer frame becomes the newest one; any other frame counts as dropped.
  bool accept_if_newer(const Frame& frame);
  int newest() const { return index_; }  // index of the newest frame; -1 before the first
  double captured_s() const { return captured_s_; }

  // Returns the status of a tick: stale_frame_dropped if `otherwise` is ok and a frame was dropped since the
  // last tick, else `otherwise`.
  RenderStatus status(RenderStatus otherwise) {
    const bool dropped = std::exchange(dropped_, false);
    return dropped && otherwise == RenderStatus::ok ? RenderStatus::stale_frame_dropped : otherwise;
  }

 private:
  int index_ = -1;
  double captured_s_ = 0;
  bool dropped_ = false;
};

// The data structure that a renderer reads in place of a cloud's columns, such as a tree. It is built once
// per frame, in advance by prepare() or in on_frame(). Form: any class with assign(const PointCloud&,
// settings...).
template <class Form>
struct PreparedForm final : FramePreparation {
  Form form;
};

template <class Form, class... Settings>
std::shared_ptr<const PreparedForm<Form>> prepared_form(const NeighbourSearch& points, const Kernels& kernels,
                                                        const Settings&... settings) {
  const auto made = std::make_shared<PreparedForm<Form>>();
  PointCloud buffer;
  made->form.assign(points.every_point(kernels, buffer), settings...);
  return made;
}

// Returns the form of the frame. Builds it now unless it was prepared; only this case allocates.
template <class Form, class... Settings>
std::shared_ptr<const Form> form_of(const Frame& frame, const Kernels& kernels, const Settings&... settings) {
  auto prepared = std::dynamic_pointer_cast<const PreparedForm<Form>>(frame.prepared);
  if (!prepared) prepared = prepared_form<Form>(*frame.points, kernels, settings...);
  return {prepared, &prepared->form};
}

}  // namespace remote_touch
