// The inputs and outputs of a renderer: frames of a sensor, with the targets of guidance in them, 7.3.2; the
// state of a device; the output of a tick, and the contact point that it states.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/points/neighbour_search.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// The target of one guidance virtual fixture in one frame, 7.3.2: the mean position of the points of a class,
// and the plane that they lie in; world frame.
struct GuidanceTarget {
  std::size_t points = 0;      // number of points that the rule selects; 0: no target in the frame
  Vec3 mean_W = Vec3::Zero();  // weighted mean of their positions
  // Unit normal of the plane that fits them by weighted total least squares, towards the sensor. It is zero
  // for fewer than three points. It is also zero if they do not form a plane: if their standard deviation
  // along the normal is above kFlat times that along the plane's shorter axis, or if the latter is at most
  // kLine times that along the longer axis.
  Vec3 normal_W = Vec3::Zero();
  double strength = 1;  // strength of its rule when the frame was captured, 0 to 1
  static constexpr double kFlat = 0.25, kLine = 1e-3;

  bool operator==(const GuidanceTarget&) const = default;
  bool is_visible() const { return points > 0; }
  bool is_flat() const { return !normal_W.isZero(0); }
};

// Returns the target. weights: weight of each point, 0 to 1, as FixtureRule::weights() returns it. Points
// that are not finite are ignored. The sensor is assumed at the camera of the cloud's image; at the origin if
// the cloud has no image.
GuidanceTarget guidance_target(const PointCloud& cloud, const std::vector<double>& weights);

// The properties that a renderer can require of the points of its frames. A run is refused if its frames lack
// one of them, because there would be no force, or a wrong one.
enum class FrameNeed {
  normals,    // points with normals
  organised,  // rows and columns, so that the neighbours of a point are known
  regions,    // forbidden regions around points, or a target of guidance
  view        // viewing direction of the sensor: an image, or a setting `view`
};

// Data that a renderer computes from a frame in advance, see Renderer::prepare().
class FramePreparation {
 public:
  virtual ~FramePreparation() = default;
};

// The true surface at the time of a frame, which only a simulation knows; a frame of a sensor has none. It is
// only for oracles: renderers that show what a better estimate could reach.
class TrueSurface {
 public:
  virtual ~TrueSurface() = default;
  // Returns the distance to the surface at a time, m, positive on the side that the sensor sees. NaN if it is
  // not known, and beside a surface with a border, where there is no back.
  virtual double signed_distance(const Vec3& p_W, double time_s) const = 0;
};

// One point cloud of the stream. Latency is part of the data: the renderer receives the frame at arrives_s.
struct Frame {
  int index = 0;
  double captured_s = 0;
  double arrives_s = 0;
  std::shared_ptr<const NeighbourSearch> points;
  std::vector<GuidanceTarget> guidance = {};  // one for every guidance fixture, in their order
  std::shared_ptr<const FramePreparation> prepared = nullptr;
  std::shared_ptr<const TrueSurface> truth = nullptr;  // simulations only
};

// The position of the haptic interface point (HIP) in the world frame; the orientation, which rotates the
// axes of the handle to the world; and the pressed buttons of the handle, one bit each.
struct DeviceState {
  Vec3 position_W = Vec3::Zero();
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  std::uint32_t buttons = 0;
};

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

}  // namespace remote_touch
