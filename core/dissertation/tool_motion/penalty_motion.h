// Penalty methods for comparison: points push the tool, and no constraint limits its motion. Each of N points
// that touch pushes with the force
//
//   f_i = k_p d_i n_i at r_i,
//
// where r_i is the point, d_i its depth and n_i a normal. If N > 10, all f_i are multiplied by 10 / N, as in
// the source. The virtual coupling (6.9) pulls the tool to the device. Each step moves the tool towards the
// pose at which the wrench of the points and the wrench of the coupling balance, linearised at the present
// pose, by half a voxel at most. There are two force laws:
//
// Voxmap and pointshell (`voxmap`): W. McNeely, K. Puterbaugh and J. Troy, "Six degree-of-freedom haptic
// rendering using voxel sampling", SIGGRAPH 1999. The tool consists of points with normals into it
// (voxel_tool.h). The scene consists of voxels (voxmap.h), which prepare() makes from each frame. The depth
// of a tool point in a surface voxel is its depth below the tangent plane: the plane through the middle of
// the voxel, perpendicular to the normal of the point.
//
// Distance field (`distance-field`): J. Barbic and D. James, "Six-DoF haptic rendering of contact between
// geometrically complex reduced deformable models", IEEE Transactions on Haptics 2008, compute the depth from
// a distance field. Here the roles are exchanged: the field belongs to the tool, and the points to the cloud.
// n_i is the normal of the cloud; if there is none, it is the direction in which the tool leaves the point
// soonest.
//
// Differences from the sources. The tool has no mass, but rests where the wrenches balance, as in M. Wan and
// W. McNeely, "Quasi-static approximation for 6 degrees-of-freedom haptic rendering", IEEE Visualization
// 2003. So there is no velocity that the proximity layers of the 1999 paper could brake before contact.
// Instead, no step is longer than half a voxel, so that points do not jump over a layer of voxels. The points
// of the pointshell lie on the surface and not in the middle of voxels. A cloud has no interior voxels.
//
// Known limits, which the comparison should show. The depth of the points in the tool is proportional to the
// force. The tool passes through points that are deeper in it than its middle, or, with a voxmap, through a
// layer of voxels that yields. If walls are close together, the points of all walls push at once. The surface
// of a voxmap is where the middles of its voxels are: up to half a voxel beside its points, and in steps if
// it is not parallel to an axis.
#pragma once

#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/dissertation/tool_motion/tool_motion.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/voxmap.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

enum class PenaltyLaw { distance_field, voxmap };

struct ToolPenaltyParameters {
  PenaltyLaw force_law = PenaltyLaw::distance_field;
  double voxmap_voxel_m = 0.003;
  double point_stiffness_N_per_m = 2400;  // k_p
  int steps_per_tick = 200;
  double rest_threshold_m = 1e-6;
  EvenCoupling coupling;
};

Parameters parameters(ToolPenaltyParameters& p);
inline std::string validate(const ToolPenaltyParameters&) {
  return {};
}
// Returns the settings that ToolRenderer reads: the spring, its limits, and how contacts are counted.
ToolParameters tool_parameters(const ToolPenaltyParameters& p);

// The part that both force laws share.
class PenaltyMotion : public ToolMotion {
 public:
  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) final;

 protected:
  // max_step_m: maximum displacement of any point of the tool in a step.
  PenaltyMotion(const ToolPenaltyParameters& parameters, const VoxelTool& tool, double max_step_m)
      : p_(parameters), reach_m_(tool.reach_m), max_step_m_(max_step_m) {}

  // Effect of the points on the tool: in tool axes, about its centre of mass.
  struct Push {
    int points = 0;
    Vector6 wrench_T = Vector6::Zero();  // N, N m
    Eigen::Matrix<double, 6, 6> stiffness_T =
        decltype(stiffness_T)::Zero();  // decrease of the wrench per displacement of the tool

    // Adds a point at r_T, depth_m deep along the unit vector n_T, that pushes with k_p.
    void add(const Vec3& r_T, const Vec3& n_T, double depth_m, double k_p_N_per_m);
  };
  virtual Push push(const ToolPose& pose, const ContactList& contacts) const = 0;

  const ToolPenaltyParameters p_;
  const double reach_m_;

 private:
  Vector6 balancing_step(const ToolPose& pose, const ToolPose& device, const Push& push) const;

  const double max_step_m_;
};

class FieldPenalty final : public PenaltyMotion {
 public:
  FieldPenalty(const ToolPenaltyParameters& parameters, const VoxelTool& tool)
      : PenaltyMotion(parameters, tool, 0.5 * tool.grid.size_m) {}

 private:
  Push push(const ToolPose& pose, const ContactList& contacts) const override;
};

class VoxmapPenalty final : public PenaltyMotion {
 public:
  VoxmapPenalty(const ToolPenaltyParameters& parameters, const VoxelTool& tool)
      : PenaltyMotion(parameters, tool, 0.5 * parameters.voxmap_voxel_m),
        shell_(make_pointshell(tool, parameters.voxmap_voxel_m)) {}
  std::shared_ptr<const FramePreparation> prepared(const PointCloud& cloud) const override;
  void on_frame(const std::shared_ptr<const FramePreparation>& prepared) override;

 private:
  Push push(const ToolPose& pose, const ContactList& contacts) const override;

  const Pointshell shell_;
  std::shared_ptr<const Voxmap> map_;  // voxmap of the newest frame
};

// The tool has to outlive the result.
std::unique_ptr<ToolMotion> make_penalty_motion(const ToolPenaltyParameters& parameters,
                                                const VoxelTool& tool);

}  // namespace remote_touch
