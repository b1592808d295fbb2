// A flat rectangle, sampled as a grid, from which the scenes of chapter 6 are built.
#pragma once

#include <span>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"

namespace remote_touch {

// u, v and the normal are unit vectors at right angles; the normal points to the free side.
struct FlatPanel {
  Vec3 centre = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();
  Vec3 u = Vec3::UnitX();
  double half_u_m = 0.05, half_v_m = 0.05;

  Vec3 v() const { return normal.cross(u); }
  // Returns the point of the rectangle nearest to p.
  Vec3 nearest(const Vec3& p) const;
};

// The points' coordinates along u and v, from the centre, are whole multiples of the spacing plus the phase.
struct PanelGrid {
  double spacing_m = 0.003;
  double phase_u_m = 0, phase_v_m = 0;
};

// Adds, row after row, the points of the grid that lie on the panel, its border included, with the panel's
// normal.
void append(PointCloud& cloud, const FlatPanel& panel, const PanelGrid& grid);
// Number of points in such a row.
int columns(const FlatPanel& panel, const PanelGrid& grid);

// Returns the distance to the nearest of the panels, m, positive on the side that its normal points to. If
// several panels are equally near, the panel whose plane is farthest from p determines the side. Infinite
// without panels. A border that no other panel continues has no back side: beyond it, the distance to the
// border is positive in front of the plane that ends there, and the result is NaN behind that plane.
double signed_distance(std::span<const FlatPanel> panels, const Vec3& p);

}  // namespace remote_touch
