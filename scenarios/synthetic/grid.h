// A rectangular grid of points in the x-z plane, and the noise that a scenario puts on its points.
#pragma once

#include <limits>
#include <memory>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/numeric/noise.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

// columns x rows points, spacing_m apart; point row * columns + column. The middle of the grid lies at the
// origin of x and z, moved by the phases in units of the spacing.
struct Grid {
  int columns = 100;
  int rows = 100;
  double spacing_m = 0.0015;
  double phase_x = 0;
  double phase_z = 0;

  int size() const { return columns * rows; }
  double x(int column) const { return (column - 0.5 * (columns - 1) + phase_x) * spacing_m; }
  double z(int row) const { return (row - 0.5 * (rows - 1) + phase_z) * spacing_m; }
  // True if a position in the plane lies between the first and the last points, border included, with a
  // tolerance for rounding. A surface that the grid samples ends there.
  bool covers(double px, double pz) const {
    constexpr double kSame_m = 1e-9;
    return px >= x(0) - kSame_m && px <= x(columns - 1) + kSame_m && pz >= z(0) - kSame_m &&
           pz <= z(rows - 1) + kSame_m;
  }
  // Signed distance to a level surface that the grid samples: the height over it, m. NaN for a position that
  // is below the surface and beyond the border, see Scenario::signed_distance().
  double signed_distance(const Vec3& p_W, double surface_y_m) const {
    const double height_m = p_W.y() - surface_y_m;
    return height_m < 0 && !covers(p_W.x(), p_W.z()) ? std::numeric_limits<double>::quiet_NaN() : height_m;
  }
};

Parameters parameters(Grid& grid);

// Adds zero-mean Gaussian noise of standard deviation sigma_m to x, y and z of every point.
void add_noise(PointCloud& cloud, double sigma_m, const NoiseStream& stream, const Kernels& kernels);

}  // namespace remote_touch
