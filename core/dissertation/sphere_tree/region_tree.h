// The forbidden regions of a frame as a sphere tree, 7.3.2.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dissertation/sphere_tree/sphere_tree.h"
#include "core/geometry/point_cloud.h"

namespace remote_touch {

// Every measured point with r_f above 0 has a leaf of that radius, in the world frame. The points of a patch
// form a node of the lowest level. A patch is 16 x 16 pixels of an image, and patches follow each other in
// blocks of 4 x 4. If the cloud has no image, a patch is kPatchPoints such points along a space-filling
// curve.
class RegionTree {
 public:
  static constexpr int kPatchSide_px = 16;
  static constexpr std::size_t kPatchPoints = 256;

  void assign(const PointCloud& cloud);

  const SphereTree& spheres() const { return spheres_; }
  // Number in the cloud of the point of each leaf.
  const std::vector<std::uint32_t>& points() const { return points_; }
  // k_s of a leaf; NaN if its point has none.
  double stiffness_N_per_m(std::uint32_t leaf) const { return stiffness_N_per_m_[leaf]; }

 private:
  void add_patches_of_image(const PointCloud& cloud);
  void add_patches_along_curve(const PointCloud& cloud);
  void gather(const PointCloud& cloud, std::uint32_t first, std::uint32_t count);
  void close_patch();

  SphereTree spheres_;
  std::vector<std::uint32_t> points_;
  std::vector<double> stiffness_N_per_m_;
  std::vector<Sphere> patch_;
};

}  // namespace remote_touch
