#include "core/dissertation/tool/contact/group_slab.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/bounding_box.h"

namespace remote_touch {

namespace {

constexpr double kWider = 1 + 1e-12;
constexpr double kMinArea_m2 = 1e-18;  // a smaller triangle shows no plane

}  // namespace

// The plane contains the directions to the farthest point and to the point that is farthest from the line to
// it.
GroupSlab group_slab(std::span<const Vec3> points) {
  BoundingBox box;
  for (const Vec3& p : points) box.extend(p);
  GroupSlab slab{0.5 * (box.min() + box.max()), Vec3::Zero(), 0, 0};
  Vec3 farthest = Vec3::Zero(), across = Vec3::Zero();
  for (const Vec3& p : points)
    if ((p - slab.centre_W).norm() > farthest.norm()) farthest = p - slab.centre_W;
  for (const Vec3& p : points) {
    const Vec3 cross = farthest.cross(p - slab.centre_W);
    if (cross.norm() > across.norm()) across = cross;
  }
  slab.radius_m = kWider * farthest.norm();
  if (!(across.norm() > kMinArea_m2)) return slab;
  slab.n_W = across.normalized();
  for (const Vec3& p : points)
    slab.half_m = std::max(slab.half_m, kWider * std::abs(slab.n_W.dot(p - slab.centre_W)));
  return slab;
}

}  // namespace remote_touch
