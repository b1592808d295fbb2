#include "core/dissertation/sphere_tree/region_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/search/morton_order.h"

namespace remote_touch {

// Adds the regions of points first .. first + count - 1 to the present patch. The radius is tested first,
// because most points of most frames have no region.
void RegionTree::gather(const PointCloud& cloud, std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t point = first; point < first + count; ++point) {
    const double radius_m = cloud.fixture_radius_m[point];
    if (!(radius_m > 0)) continue;
    if (!std::isfinite(radius_m) || !cloud.is_measured(point)) continue;
    patch_.push_back({cloud.point(point), radius_m});
    points_.push_back(point);
    stiffness_N_per_m_.push_back(cloud.stiffness_N_per_m.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                                 : cloud.stiffness_N_per_m[point]);
  }
}

void RegionTree::close_patch() {
  spheres_.add(patch_);
  patch_.clear();
}

void RegionTree::add_patches_of_image(const PointCloud& cloud) {
  constexpr std::uint32_t kPatch = kPatchSide_px, kBlock = 4 * kPatch;
  const auto width = static_cast<std::uint32_t>(cloud.image->camera.width),
             height = static_cast<std::uint32_t>(cloud.image->camera.height);
  for (std::uint32_t v0 = 0; v0 < height; v0 += kBlock)
    for (std::uint32_t u0 = 0; u0 < width; u0 += kBlock)
      for (std::uint32_t v = v0; v < std::min(v0 + kBlock, height); v += kPatch)
        for (std::uint32_t u = u0; u < std::min(u0 + kBlock, width); u += kPatch) {
          for (std::uint32_t row = v; row < std::min(v + kPatch, height); ++row)
            gather(cloud, row * width + u, std::min(kPatch, width - u));
          close_patch();
        }
}

void RegionTree::add_patches_along_curve(const PointCloud& cloud) {
  for (const std::uint32_t point : morton_order(cloud)) {
    gather(cloud, point, 1);
    if (patch_.size() == kPatchPoints) close_patch();
  }
  close_patch();
}

void RegionTree::assign(const PointCloud& cloud) {
  spheres_.clear();
  points_.clear();
  stiffness_N_per_m_.clear();
  if (cloud.fixture_radius_m.empty()) return;
  if (cloud.image)
    add_patches_of_image(cloud);
  else
    add_patches_along_curve(cloud);
  spheres_.finish();
}

}  // namespace remote_touch
