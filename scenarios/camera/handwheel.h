// A valve's handwheel: a ring on three round spokes, with a hub, and a stem back to the wall behind it.
#pragma once

#include "core/geometry/vector.h"

namespace remote_touch {

// The axis is along z and the wheel lies in the plane z = centre.z; the stem ends at the wall z = 0. One
// spoke points up, +y. Metres.
class Handwheel {
 public:
  // Dimensions other than the constructor's. The ring's radius is that of the centre line of its tube.
  static constexpr double kTubeRadius_m = 0.007, kSpokeRadius_m = 0.0045;
  static constexpr double kHubRadius_m = 0.011, kHubHalfLength_m = 0.010, kStemRadius_m = 0.008;

  // pre: ring_radius_m > kTubeRadius_m and centre_m.z > kHubHalfLength_m.
  Handwheel(const Vec3& centre_m, double ring_radius_m);

  // Distance to the surface of the union, negative inside. Exact outside. Inside, the depth returned is a
  // lower bound, because the nearest point of one part may lie inside another part.
  double signed_distance(const Vec3& p) const;
  // Returns the smallest t >= 0 at which origin + t direction is inside, or at most 1e-9 m outside. Returns
  // infinity if the ray misses, or if it passes so close that the search needs too many steps.
  double cast(const Vec3& origin, const Vec3& direction) const;
  // Returns the outward unit normal at a position on the surface, or a blend of both normals where two parts
  // meet.
  Vec3 normal(const Vec3& p) const;

 private:
  Vec3 centre_;
  double ring_radius_;
  // Ball that encloses the wheel and its stem.
  Vec3 ball_centre_;
  double ball_radius_;
};

}  // namespace remote_touch
