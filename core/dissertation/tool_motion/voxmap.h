// The points of a frame as voxels: the voxmap of McNeely, Puterbaugh and Troy 1999, for a scene of which only
// points are known. A voxel with a point in it is a surface voxel. All others are free, because points do not
// show what is behind them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/points/point_cloud.h"

namespace remote_touch {

class Voxmap {
 public:
  // Voxel (i, j, k) spans voxel_m (i .. i + 1, j .. j + 1, k .. k + 1) of the world. Points that are not
  // finite, or more than 2^20 voxels from the origin along an axis, are left out. Allocates.
  Voxmap(const PointCloud& cloud, double voxel_m);

  double voxel_m() const { return voxel_m_; }
  // Returns the middle of the surface voxel that holds a position; none if its voxel is free. Does not
  // allocate.
  std::optional<Vec3> surface_middle_W(const Vec3& p_W) const;

 private:
  std::optional<std::uint64_t> key_of(const Vec3& p_W) const;
  std::size_t slot_of(std::uint64_t key) const;

  double voxel_m_;
  std::vector<std::uint64_t> slots_;  // open addressing: keys, or kFree; a power of two, half or more free
};

}  // namespace remote_touch
