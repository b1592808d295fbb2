// Penalty methods for comparison: points push the tool, and nothing constrains it. Each of N points that
// touch pushes with the force
//
//   f_i = k_p d_i n_i at r_i,
//
// where r_i is the point, d_i its depth and n_i a normal. If N > 10, all f_i are multiplied by 10 / N, as in
// the source. The virtual coupling (6.9) pulls the tool to the device. In each step the tool moves towards
// the pose at which the wrench of the points and that of the coupling balance, linearised at the present
// pose, by half a voxel at most. Two force laws:
//
// Voxmap and pointshell (`voxmap`): W. McNeely, K. Puterbaugh and J. Troy, "Six degree-of-freedom haptic
// rendering using voxel sampling", SIGGRAPH 1999. The tool is points with normals into it (pointshell.h), the
// scene is voxels (voxmap.h), made anew from each frame in prepare(). A point of the tool in a surface voxel
// is as deep as it is below its tangent plane: the plane through the middle of the voxel, across the normal
// of the point.
//
// Distance field (`distance-field`): as J. Barbic and D. James, "Six-DoF haptic rendering of contact between
// geometrically complex reduced deformable models", IEEE Transactions on Haptics 2008, take the depth from a
// distance field. Here the roles are exchanged: the field is the tool's, the points are the cloud's, and n_i
// is the normal of the cloud; without one, the direction in which the tool leaves the point soonest.
//
// Differences from the sources: the tool has no mass, but rests where the wrenches balance, as in M. Wan and
// W. McNeely, "Quasi-static approximation for 6 degrees-of-freedom haptic rendering", IEEE Visualization
// 2003. So there is no velocity that the proximity layers of the 1999 paper could brake before contact; that
// no step is longer than half a voxel keeps points from jumping over a layer of voxels, which braking is for.
// The points of the pointshell lie on the surface and not in the middle of voxels. A cloud has no interior
// voxels.
//
// Known limits, which the comparison should show: the depth of the points in the tool is proportional to the
// force; the tool passes through points that are deeper in it than its middle, or, with a voxmap, through a
// layer of voxels that gives way; where walls are close, the points of all walls push at once. With a voxmap
// a surface is where the middles of its voxels are, up to half a voxel beside its points and in steps where
// it is not along an axis.
#pragma once

#include "core/dissertation/tool/contact/voxmap.h"
#include "core/dissertation/tool/dynamics/even_coupling.h"
#include "core/dissertation/tool/motion/tool_motion.h"
#include "core/dissertation/tool/shape/pointshell.h"
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
// Upper bound, over all poses, of how fast |force| grows with the displacement of the HIP.
inline double max_stiffness_N_per_m(const ToolPenaltyParameters& p) {
  return p.coupling.stiffness_N_per_m;
}
// Returns the spring, its limits and the way in which contacts are counted, for ToolRenderer.
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
        decltype(stiffness_T)::Zero();  // decrease of the wrench by displacement

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
