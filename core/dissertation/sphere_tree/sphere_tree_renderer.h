// 6-DOF forbidden-region virtual fixtures, chapter 7: a tool of spheres is kept out of the regions around the
// points of a stream.
#pragma once

#include <memory>

#include "core/dissertation/sphere_tree/region_contacts.h"
#include "core/dissertation/tool/dynamics/tool_parameters.h"
#include "core/dissertation/tool/dynamics/wrench_coupling.h"
#include "core/dissertation/tool/motion/look_ahead_motion.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/rendering/frame_order.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// The device holds the tool by its centre of mass. Only points with r_f above 0 have a region. If a point has
// a k_s, it is the stiffness of the coupling while the tool touches its region, (5.3).
//
// Outputs: `nearest_distance_m` is the smallest gap between a leaf of the tool and a region; infinite beyond
// the look-ahead. `contact_count` is the number of touching pairs of leaves. `contact_clusters` is the number
// of the tool's leaves in these pairs. `tool_penetration_m` is the depth of the deepest leaf in a region.
class SphereTreeRenderer final : public Renderer {
 public:
  // Uses only the parameters that region_parameters() lists. spheres: leaves of the tool, in its frame. pre:
  // validate(parameters) is empty.
  SphereTreeRenderer(const ToolParameters& parameters, std::shared_ptr<const VoxelTool> tool,
                     const std::shared_ptr<const SphereTree>& spheres, const Kernels& kernels);

  void prepare(Frame& frame) const override;
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override;
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  void follow(const ToolPose& device, RenderOutput& out);

  ToolParameters p_;
  const std::shared_ptr<const VoxelTool> tool_;
  const Kernels& kernels_;
  RegionContacts contacts_;
  LookAheadMotion motion_;

  ToolPose pose_;
  Vec3 normal_W_ = Vec3::Zero();  // contact normal: direction in which the regions push the tool
  bool placed_ = false;           // the tool starts at the first device pose
  bool updated_ = false;          // a frame came in since the last tick
  SlavePosition slave_;
  FrameOrder order_;
};

// Returns the parameters of a tool that have an effect on the motion among regions.
Parameters region_parameters(ToolParameters& p);

}  // namespace remote_touch
