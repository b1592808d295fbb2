// Detects near pairs of a leaf of a tool's sphere tree and a forbidden region, 7.4.1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dissertation/sphere_tree/sphere_tree.h"
#include "core/dissertation/tool/dynamics/tool_pose.h"
#include "core/kernels/kernels.h"

namespace remote_touch {

// A leaf of the tool at a pose, world frame, and the patches of regions near the node that it belongs to.
struct CloseLeaf {
  std::uint32_t number;
  std::uint32_t first_patch, patch_count;  // range in the list of TreeCollision
  Sphere sphere_W;
};

// Allocates in the constructor and in reserve(), and in on_frame() if reserve() was not called.
class TreeCollision {
 public:
  // tool: in the tool frame. Keeps references to tool and regions.
  TreeCollision(const SphereTree& tool, const Kernels& kernels);
  void on_frame(const SphereTree& regions);
  void reserve(std::size_t leaves, std::size_t patches);  // numbers of leaves and patches of the regions

  // Returns every leaf of the tool that has a pair within margin_m, and some others, in the order of their
  // numbers. Valid until the next call. The search first descends the tool's tree, depth first, against the
  // top level of the regions' tree. Then it descends the regions' tree against every node of the tool's
  // lowest level, so that the leaves of a node share this search.
  std::span<const CloseLeaf> close_leaves(const ToolPose& pose, double margin_m);

  // Returns all regions with gaps of margin_m or less to one of these leaves, in the order of their numbers;
  // margin_m is at most that of close_leaves(). The columns may be changed, and are valid until the next
  // call.
  struct Found {
    NearRegions regions;  // normals in the world
    std::size_t count;
  };
  Found regions_near(const CloseLeaf& leaf, double margin_m);

 private:
  void meet_tool(std::size_t level, std::uint32_t number, std::uint32_t tops);
  // Returns the nodes of the regions' top level, among those in the bits of `among`, that are near a sphere
  // of the tool.
  std::uint32_t tops_near(const Sphere& sphere_W, std::uint32_t among) const;
  Sphere placed(const Sphere& sphere_T) const;
  void meet_regions(std::size_t level, std::uint32_t number, const Sphere& node_W);

  const SphereTree& tool_;
  const SphereTree* regions_ = nullptr;
  const Kernels& kernels_;
  Vec3 p_W_ = Vec3::Zero();
  Eigen::Matrix3d R_WT_ = Eigen::Matrix3d::Identity();
  double margin_m_ = 0;
  std::vector<CloseLeaf> close_;
  std::vector<std::uint32_t> patches_;  // near patches of each node of the tool, one node after the other
  std::vector<double> gap_, nx_, ny_, nz_;
  std::vector<std::uint32_t> number_;
};

}  // namespace remote_touch
