// A height field in its own frame S, with exact distances: the surface that a moving-shape scenario moves.
#pragma once

#include <array>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/synthetic/grid_scene.h"
#include "scenarios/synthetic/panel_scenes.h"

namespace remote_touch {

// y = height(x, z) in S, metres, y up. The top of a ridge, corner or sphere, the bottom of a valley and a
// zero of the ripple lie at the origin. Only sphere and corner vary along z. The surface extends from the
// first to the last point of a grid, with two exceptions: a sphere is the whole upper half of a ball, and the
// three faces of a corner are unbounded. Where a grid does not reach, both have a front but no back.
class Shape {
 public:
  enum class Kind { flat, ridge, valley, sphere, ripple, corner };
  struct Settings {
    Kind kind = Kind::flat;
    double slope_deg =
        30;  // slope of the flanks of a ridge or valley, which meet at x = 0, and of the faces of a corner
    double radius_m = 0.04;      // radius of the sphere
    double amplitude_m = 0.003;  // amplitude of the ripple amplitude_m sin(2 pi x / period_m)
    double period_m = 0.03;
  };

  Shape(const Settings& settings, const Grid& grid);

  // Height, continued beyond the border: flanks and waves by their own formula, a sphere by the plane through
  // its centre.
  double height(double x, double z) const;
  // Point that a sensor above measures at (x, z); NaN in all three coordinates beside a sphere.
  Vec3 point(double x, double z) const;
  // Unit normal, upwards; on a crease the normal of one of its sides.
  Vec3 normal(double x, double z) const;
  // Distance to the surface, positive above it. Beyond the border it is the distance to the border, positive
  // above the plane that ends there (sphere: the plane through its centre; ripple: the height at the border).
  // NaN below that plane if p is not below the surface and the border is the nearest part of it: p is then
  // neither in front of the surface nor behind it. Inside a corner or a sphere that is larger than the grid,
  // the distance is NaN if neither p nor the nearest point is within the grid. The distance is exact. For the
  // ripple it is found by a search along x, within 1e-6 m where the ripple's curvature is about that of a
  // circle around p.
  double signed_distance(const Vec3& p_S) const;

 private:
  void add_flank(double x0, double x1, double slope);
  struct Wave {
    double height_m, slope, bend_per_m;  // and its first and second derivative
  };
  struct DistanceSlope {
    double value, slope;
  };
  Wave wave(double x) const;
  DistanceSlope distance_along_wave(const Vec3& p_S, double x) const;
  double foot_on_wave(const Vec3& p_S, double low, double high) const;
  bool covers(const Vec3& p_S) const;  // p lies within the border along x and z
  double distance_to_flanks(const Vec3& p_S) const;
  double distance_to_dome(const Vec3& p_S) const;
  double distance_to_wave(const Vec3& p_S) const;
  double distance_to_corner(const Vec3& p_S) const;

  const Settings settings_;
  const Grid grid_;
  const double x0_, x1_, z0_, z1_;  // the border
  double slope_ = 0;                // rise of a flank along x, at x > 0
  std::vector<FlatPanel> flanks_;   // panels of flat, ridge and valley
  std::array<Vec3, 3> faces_;       // normals of the faces of a corner
};

Parameters parameters(Shape::Settings& s);

// The steepest slope of a height field, degrees from the horizontal; 0 for the sphere, whose rim is vertical.
double steepest_deg(const Shape::Settings& s);

}  // namespace remote_touch
