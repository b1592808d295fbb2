// Moves the tool towards the device in one tick: the algorithm of 6.2.5, in three variants ("rules").
#pragma once

#include <algorithm>
#include <limits>
#include <memory>

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/motion_program.h"
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

}  // namespace remote_touch
