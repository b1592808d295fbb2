// A volumetric penalty method for comparison: a tool filled with inner spheres is pushed out of the points of
// a frame. Force and torque are proportional to the penetration volume (sphere_penetration.h). R. Weller and
// G. Zachmann, "A unified approach for physically-based simulations and haptic rendering", ACM SIGGRAPH
// Symposium on Video Games 2009, introduced them for two bodies of inner spheres; M. Kaluschke, R. Weller, G.
// Zachmann and others, World Haptics 2017, for one body and the point cloud of a depth camera.
//
//   f_i = k_V V_i n_i at x_i,
//
// where V_i is the volume of sphere i in the scene, n_i is the normal of the scene there, and x_i is the
// centroid of that part. The virtual coupling (6.9) pulls the tool to the device. Each step moves the tool
// towards the pose at which the wrench of the spheres and the wrench of the coupling balance, linearised at
// the present pose, by half a voxel at most, and by less and less if steps turn back.
//
// Not from the sources: the coupling and the steps. But for the shorter steps they are those of the penalty
// methods (penalty_motion.h), so that the methods differ in the force of the points only.
//
// Known limits, which the comparison should show. The force grows with the square of the depth at first, so
// the surface feels soft. The part of the tool behind the surface is inside, however thin the object is. So a
// tool that touches a surface from its back is pushed through it to the side of the sensor. A tool that is
// entirely behind the points feels nothing.
#pragma once

#include <memory>

#include "core/dissertation/tool/dynamics/tool_parameters.h"
#include "core/dissertation/tool/motion/tool_motion.h"
#include "core/parameters/parameter.h"
#include "core/rivals/sphere_penetration.h"

namespace remote_touch {

// The default k_V is this project's choice: a contact of 240 mm^2 is then as stiff as ten points of the
// penalty methods, 24 kN/m.
struct InnerSphereParameters {
  int inner_spheres = 1000;                // largest number of spheres
  double volume_stiffness_N_per_m3 = 1e8;  // k_V
  int steps_per_tick = 200;
  double rest_threshold_m = 1e-6;
  EvenCoupling coupling;
};

Parameters parameters(InnerSphereParameters& p);
inline std::string validate(const InnerSphereParameters&) {
  return {};
}
// Returns the settings that ToolRenderer reads: the spring, its limits, and how contacts are counted.
ToolParameters tool_parameters(const InnerSphereParameters& p);

class InnerSphereMotion final : public ToolMotion {
 public:
  // Packs the spheres, which takes long for a large tool. tool: made without outer_field. Throws InputError
  // as make_inner_spheres() does.
  InnerSphereMotion(const InnerSphereParameters& parameters, const VoxelTool& tool);
  // The same with spheres that were made before.
  InnerSphereMotion(const InnerSphereParameters& parameters, const VoxelTool& tool,
                    std::shared_ptr<const InnerSpheres> spheres);

  ToolMotionReport move(ToolPose& pose, const ToolPose& device, ContactList& contacts, bool updated) override;

 private:
  Vector6 balancing_step(const ToolPose& pose, const ToolPose& device, const SpherePenetration& in) const;
  bool turns_back(const Vector6& step, const Vector6& trend) const;

  const InnerSphereParameters p_;
  const double reach_m_, max_step_m_;
  PenetrationQuery query_;
};

}  // namespace remote_touch
