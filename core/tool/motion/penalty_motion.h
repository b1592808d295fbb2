// A rule for comparison: the point shell and the voxmap of McNeely, Puterbaugh and Troy, "Six
// degree-of-freedom haptic rendering using voxel sampling", 1999. Nothing constrains the tool. Every point of
// the cloud in it pushes, and the tool follows the device on the spring of (6.9):
//
//   f_i = k_p d_i n_i at r_i,   d_i the depth of point i below the tool's surface, n_i its normal
//
// (without one: the direction in which the tool leaves it soonest), and where N > 10 points touch, all f_i
// are multiplied by 10 / N, as there. In each step the tool moves towards the pose at which both wrenches
// balance, linearised at the present one, by half a voxel at most.
//
// Where it differs from its source: the roles are exchanged (there the environment is voxels and the tool is
// points); d_i is of the distance field and not of a plane through the middle of a voxel, so it is exact and
// goes on growing inside; the tool has no mass, but rests where the wrenches balance, as in Wan and McNeely,
// "Quasi-static approximation for 6 degrees-of-freedom haptic rendering", 2003; nothing brakes it before
// contact.
//
// Known limits, which the comparison is to show: the tool sinks in proportion to the force, passes points
// whose depth is beyond its middle, and is pushed out by all points at once where walls are close.
#pragma once

#include "core/parameters/parameter.h"
#include "core/tool/motion/tool_motion.h"

namespace remote_touch {

struct ToolPenaltyParameters {
  double point_stiffness_N_per_m = 2400;  // k_p
  int steps_per_tick = 200;
  double rest_threshold_m = 1e-6;
  // As of ToolParameters.
  double stiffness_N_per_m = 600, gyration_radius_m = 0.03;
  double max_force_N = 20, max_torque_Nm = 1;
};

Parameters parameters(ToolPenaltyParameters& p);
inline std::string validate(const ToolPenaltyParameters&) {
  return {};
}
// Upper bound, over all poses, of how fast |force| grows with the displacement of the HIP.
inline double max_stiffness_N_per_m(const ToolPenaltyParameters& p) {
  return p.stiffness_N_per_m;
}
// The spring, its limits and how contacts are counted, as ToolRenderer takes them.
ToolParameters tool_parameters(const ToolPenaltyParameters& p);

class PenaltyMotion final : public ToolMotion {
 public:
  PenaltyMotion(const ToolPenaltyParameters& parameters, const VoxelTool& tool)
      : p_(parameters), reach_m_(tool.reach_m), max_step_m_(0.5 * tool.grid.size_m) {}
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) override;

 private:
  // What the points do to the tool: tool axes, about its centre of mass.
  struct Push {
    int points = 0;
    Vector6 wrench_T = Vector6::Zero();  // N, N m
    Eigen::Matrix<double, 6, 6> stiffness_T =
        decltype(stiffness_T)::Zero();  // of the wrench, by displacement
  };
  Push push(const ToolPose& pose, const ContactList& contacts) const;
  Vector6 balancing_step(const ToolPose& pose, const ToolPose& device, const Push& push) const;

  const ToolPenaltyParameters p_;
  const double reach_m_, max_step_m_;
};

}  // namespace remote_touch
