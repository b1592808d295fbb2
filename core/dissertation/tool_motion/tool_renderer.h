// 6-DOF rendering of streaming point clouds with a rigid tool, chapter 6. The motion of the tool towards the
// device in one tick is the algorithm of 6.2.5, in three variants ("rules").
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// Detects whether a tool still approaches its device within a tick. Steps that move back and forth forever
// count as rest, however long they are.
class MotionProgress {
 public:
  // min_m: an approach by this or less is no progress. patience: number of successive updates without
  // progress after which the progress has ended.
  MotionProgress(double min_m, int patience) : min_m_(min_m), patience_(patience) {}

  // remaining_m: remaining displacement to the device, as max_point_displacement_m() measures it.
  void update(double remaining_m) {
    without_ = remaining_m < nearest_distance_m_ - min_m_ ? 0 : without_ + 1;
    nearest_distance_m_ = std::min(nearest_distance_m_, remaining_m);
  }
  bool has_ended() const { return without_ >= patience_; }

 private:
  const double min_m_;
  const int patience_;
  double nearest_distance_m_ = std::numeric_limits<double>::infinity();
  int without_ = 0;  // updates since the last progress
};

struct ToolMotionReport {
  int steps = 0;
  int detections = 0;  // number of poses whose contacts were queried
  // The tool has converged. False: the budget was used up before, or the program of the last step failed.
  bool at_rest = false;
  int active_count = 0;         // contacts that pushed in the last step
  Vec3 push_W = Vec3::Zero();   // sum of their multipliers times normals: the direction of contact
  Vec3 touch_W = Vec3::Zero();  // sum of the normals of all touched contacts, pushing or not
  // Displacement from the start of the tick to the first change of state: the first step of (4.13).
  Vec3 first_step_m = Vec3::Zero();
  // Displacement, in world axes, that the constraints at the last pose would still allow. It causes no force:
  // the coupling pulls from the end of this displacement. Zero for rules whose coupling pulls from the tool.
  Vector6 allowed_W = Vector6::Zero();
};

// Writes the report of a motion into the output. normal_W: contact normal; it is not changed if the report
// has no direction.
void take_report(const ToolMotionReport& report, Vec3& normal_W, RenderOutput& out);

// Interface of the rules that move the tool.
class ToolMotion {
 public:
  virtual ~ToolMotion() = default;
  // prepared() returns the data of a frame that the rule needs in addition to the tiles of its points. It is
  // computed in advance, as by Renderer::prepare(); null if the rule needs no such data. on_frame() sets the
  // data that all later calls use.
  virtual std::shared_ptr<const FramePreparation> prepared(const PointCloud& /*cloud*/) const { return {}; }
  virtual void on_frame(const std::shared_ptr<const FramePreparation>& /*prepared*/) {}
  // Moves the pose towards the device. updated: a frame came in since the last tick. Does not allocate.
  virtual ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts,
                                bool updated) = 0;
};

// The tool has to outlive the result; for ContactRule::continuous it is made with outer_field.
std::unique_ptr<ToolMotion> make_tool_motion(const ToolParameters& parameters, const VoxelTool& tool);

// The motion of a surface from one frame to the next, as a motion of the tool: world axes, about its centre
// of mass.
struct ToolSurfaceMotion {
  Vector6 displacement = Vector6::Zero();  // displacement of the tool, m and rad
  Vector6 rate_per_s = Vector6::Zero();    // rate of the surface that holds the tool, m/s and rad/s
};

// The device holds the tool at its centre of mass. The printed rule ignores points without a normal. The
// look-ahead rule treats them as points instead of disks. ToolOutput::disabled_points is their number.
class ToolRenderer : public Renderer {
 public:
  ToolRenderer(const ToolParameters& parameters, const std::shared_ptr<const VoxelTool>& tool,
               const Kernels& kernels);
  // Moves the tool by `rule` instead of parameters.contact_rule, which then only defines how contacts are
  // counted.
  ToolRenderer(const ToolParameters& parameters, std::shared_ptr<const VoxelTool> tool,
               const Kernels& kernels, std::unique_ptr<ToolMotion> rule);

  void prepare(Frame& frame) const override;
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  // Adds a frame, with other points than its own, and with a motion that was measured by other means and
  // replaces (4.3) and (4.13).
  void on_frame(const Frame& frame, std::shared_ptr<const TiledCloud> points,
                const ToolSurfaceMotion& motion);
  // replace_points() replaces the points of the newest frame. displace() moves the tool.
  void replace_points(std::shared_ptr<const TiledCloud> points);
  void displace(const Vector6& by);
  bool is_newer(const Frame& frame) const { return order_.is_newer(frame); }
  const ToolPose& pose() const { return pose_; }
  // True if points pushed the tool in the last step of the last tick.
  bool is_held() const { return is_held_; }
  // Returns the contacts near the tool at its present pose. Valid until the next call of any function.
  NearContacts near() { return contacts_.near(pose_, 0); }
  Parameters live_parameters() override { return live_ones(parameters(p_)); }
  void parameters_changed() override;
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  void take_points(std::shared_ptr<const TiledCloud> points);
  void follow(const ToolPose& device, RenderOutput& out);
  ToolPose coupled_pose(double time_s) const;
  void measure(RenderOutput& out);

  ToolParameters p_;
  const std::shared_ptr<const VoxelTool> tool_;
  const Kernels& kernels_;
  ContactList contacts_;
  std::unique_ptr<ToolMotion> motion_;
  SurfaceVelocity velocity_;

  ToolPose pose_;
  Vec3 normal_W_ = Vec3::Zero();  // contact normal: direction in which the points push the tool
  bool placed_ = false;           // the tool starts at the first device pose
  bool updated_ = false;          // a frame came in since the last tick
  bool is_held_ = false;          // points pushed the tool in the last step of the tick
  double frame_arrived_s_ = 0;
  std::optional<Vector6> measured_rate_per_s_;  // replaces the estimate
  Vector6 allowed_W_ = Vector6::Zero();         // ToolMotionReport::allowed_W of the last tick
  SlavePosition slave_;
  FrameOrder order_;
  Vec3 frame_correction_m_ = Vec3::Zero();

  ToolPose measured_at_;  // pose of touched_, valid while is_measured_
  Touched touched_;
  bool is_measured_ = false;
};

}  // namespace remote_touch
