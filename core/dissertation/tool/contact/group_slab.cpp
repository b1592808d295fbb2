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

NormalCone normal_cone(std::span<const Vec3> normals_W) {
  constexpr double kSpare = 1e-9;  // more than the rounding of normals and their products
  NormalCone cone{Vec3::Zero(), 0};
  int count = 0;
  for (const Vec3& n_W : normals_W)
    if (n_W.allFinite()) cone.middle_W += n_W, ++count;
  if (count == 0) return cone;
  cone.middle_W /= count;
  for (const Vec3& n_W : normals_W)
    if (n_W.allFinite()) cone.deviation = std::max(cone.deviation, (n_W - cone.middle_W).norm() + kSpare);
  return cone;
}

}  // namespace remote_touch
