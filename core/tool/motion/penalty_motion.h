// A penalty method for comparison: the voxmap and pointshell of W. McNeely, K. Puterbaugh and J. Troy, "Six
// degree-of-freedom haptic rendering using voxel sampling", SIGGRAPH 1999. There are no constraints. Every
// point of the cloud that is inside the tool pushes it with the force
//
//   f_i = k_p d_i n_i at r_i,
//
// where r_i is the point, d_i its depth below the tool's surface and n_i its normal (without a normal: the
// direction in which the tool leaves the point soonest). Where N > 10 points touch, all f_i are multiplied by
// 10 / N, as in the source. The virtual coupling (6.9) pulls the tool to the device. In each step the tool
// moves towards the pose at which the wrench of the points and that of the coupling balance, linearised at
// the present pose, by half a voxel at most.
//
// Differences from the source: the roles are exchanged (there the environment is voxels and the tool is
// points); d_i is taken from the distance field, not from a plane through the middle of a voxel, so it is
// exact and continues to grow inside; the tool has no mass, but rests where the wrenches balance, as in M.
// Wan and W. McNeely, "Quasi-static approximation for 6 degrees-of-freedom haptic rendering", IEEE
// Visualization 2003; nothing brakes the tool before contact.
//
// Known limits, which the comparison should show: the depth of the points in the tool is proportional to the
// force; the tool passes through points that are deeper in it than its middle; where walls are close, the
// points of all walls push at once.
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
  // Effect of the points on the tool: in tool axes, about its centre of mass.
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
