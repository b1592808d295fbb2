#include "scenarios/synthetic/panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

// Tolerance for a border that falls on a point of the grid, and for distances that differ only by rounding.
constexpr double kSame_m = 1e-9;
// Normals whose directions differ by less than this belong to parallel planes.
constexpr double kParallel = 1e-6;

int first_index(double half_m, double phase_m, double spacing_m) {
  return static_cast<int>(std::ceil((-half_m - phase_m - kSame_m) / spacing_m));
}
int last_index(double half_m, double phase_m, double spacing_m) {
  return static_cast<int>(std::floor((half_m - phase_m + kSame_m) / spacing_m));
}

// Returns true if the vector from the nearest point q on the panels to p is a combination of the normals of
// the panels that contain q: p lies over the inside of a panel, or over an edge or corner at which panels
// meet. Returns false if p lies beyond a border that no other panel continues.
bool faces_the_inside(std::span<const FlatPanel> panels, const Vec3& p, const Vec3& q) {
  Vec3 rest = p - q;  // p - q without its components along those normals
  std::array<Vec3, 3> axes;
  std::size_t count = 0;
  for (const FlatPanel& panel : panels) {
    if (count == axes.size()) break;
    if ((panel.nearest(q) - q).norm() > kSame_m) continue;
    Vec3 axis = panel.normal;
    for (std::size_t i = 0; i < count; ++i) axis -= axis.dot(axes[i]) * axes[i];
    if (axis.norm() < kParallel) continue;
    axes[count] = axis.normalized();
    rest -= rest.dot(axes[count]) * axes[count];
    ++count;
  }
  return rest.norm() <= kSame_m;
}

}  // namespace

Vec3 FlatPanel::nearest(const Vec3& p) const {
  const Vec3 from_centre = p - centre;
  return centre + std::clamp(from_centre.dot(u), -half_u_m, half_u_m) * u +
         std::clamp(from_centre.dot(v()), -half_v_m, half_v_m) * v();
}

void append(PointCloud& cloud, const FlatPanel& panel, const PanelGrid& grid) {
  const double s = grid.spacing_m;
  const Vec3 v = panel.v();
  const int last_u = last_index(panel.half_u_m, grid.phase_u_m, s);
  const int last_v = last_index(panel.half_v_m, grid.phase_v_m, s);
  for (int j = first_index(panel.half_v_m, grid.phase_v_m, s); j <= last_v; ++j)
    for (int i = first_index(panel.half_u_m, grid.phase_u_m, s); i <= last_u; ++i)
      cloud.append(panel.centre + (i * s + grid.phase_u_m) * panel.u + (j * s + grid.phase_v_m) * v,
                   panel.normal);
}

int columns(const FlatPanel& panel, const PanelGrid& grid) {
  return last_index(panel.half_u_m, grid.phase_u_m, grid.spacing_m) -
         first_index(panel.half_u_m, grid.phase_u_m, grid.spacing_m) + 1;
}

double signed_distance(std::span<const FlatPanel> panels, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity(), over = 0;
  Vec3 foot = p;
  for (const FlatPanel& panel : panels) {
    const Vec3 on_panel = panel.nearest(p);
    const double distance = (p - on_panel).norm();
    const double height = panel.normal.dot(p - panel.centre);
    if (distance > nearest + kSame_m) continue;
    if (distance < nearest - kSame_m || std::abs(height) > std::abs(over)) over = height;
    if (distance < nearest) nearest = distance, foot = on_panel;
  }
  if (over >= 0) return nearest;
  return faces_the_inside(panels, p, foot) ? -nearest : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace remote_touch
