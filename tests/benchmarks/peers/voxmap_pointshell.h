// The collision detection of McNeely, Puterbaugh and Troy (1999), written from the paper. The environment,
// here a cloud, is a map of voxels, and the tool is a shell of points with inward normals, one for each voxel
// of its surface. It is for the comparison only.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dissertation/tool/dynamics/tool_pose.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/geometry/point_cloud.h"

namespace remote_touch::benchmarks {

class VoxmapPointshell {
 public:
  // Surface voxels are those that a disk around a point meets, so that the map has no holes. The disk is
  // sampled at half voxels, up to disk_m around the point in the plane of its normal. One layer of proximity
  // is around them, as in the paper.
  VoxmapPointshell(const VoxelTool& tool, const PointCloud& cloud, double voxel_m, double disk_m);

  // The number of shell points in surface voxels, the sum of the tangent-plane forces for a stiffness of 1
  // N/m, and their torque about the tool's origin. A point pushes back along its inward normal by the depth
  // of its voxel's centre behind it.
  struct Touch {
    std::size_t points = 0;
    Vec3 force_W = Vec3::Zero(), torque_W = Vec3::Zero();
  };
  Touch touch(const ToolPose& pose);
  // Finds the same plainly, from the list of surface voxels.
  Touch plain_touch(const ToolPose& pose) const;

  std::size_t shell_size() const { return count_; }
  // Returns the largest distance of a shell point to the tool's surface, by the tool's distance field.
  double shell_error_m() const { return shell_error_m_; }

 private:
  enum Type : std::uint8_t { kFree = 0, kProximity = 1, kSurface = 2 };
  using Voxel = std::array<std::int32_t, 3>;

  Voxel voxel_of(const Vec3& p_W) const;
  Vec3 centre_W(const Voxel& voxel) const;
  void add_force(std::size_t point, const Eigen::Matrix3d& R_WT, const Vec3& at_W, const Voxel& voxel,
                 const Vec3& origin_W, Touch& all) const;
  void make_map(const PointCloud& cloud, double disk_m);
  void make_shell(const VoxelTool& tool);

  const double voxel_m_;
  Vec3 origin_W_ = Vec3::Zero();
  Voxel size_{};
  std::vector<std::uint8_t> type_;
  std::vector<Voxel> surface_;
  std::size_t count_ = 0;
  double shell_error_m_ = 0;
  std::vector<double> x_, y_, z_, nx_, ny_, nz_;  // shell points and normals, tool frame
  std::vector<std::int32_t> cell_;                // scratch
};

}  // namespace remote_touch::benchmarks
