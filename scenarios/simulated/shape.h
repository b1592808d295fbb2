// A height field in its own frame S, with exact distances: the surface that a moving-shape scenario moves.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "scenarios/simulated/grid_scenes.h"
#include "scenarios/simulated/panel_scenes.h"

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

// A surface of one of a few shapes that is lifted, slid, shaken or rocked, and may vanish. It serves to
// compare renderers on more motions than the lifts of 4.3.2.

// Motion of a shape: a lift, 4.3.2, and added to it a slide, a shake and a rotation back and forth.

// The pose of a shape's frame S in the world: origin at (x, y, 0), rotated about z (from x to y).
struct ShapePose {
  double x_m = 0, y_m = 0;
  double sine = 0, cosine = 1;

  Vec3 to_W(const Vec3& p_S) const {
    return {cosine * p_S.x() - sine * p_S.y() + x_m, sine * p_S.x() + cosine * p_S.y() + y_m, p_S.z()};
  }
  Vec3 direction_to_W(const Vec3& direction_S) const {
    return {cosine * direction_S.x() - sine * direction_S.y(),
            sine * direction_S.x() + cosine * direction_S.y(), direction_S.z()};
  }
  Vec3 to_S(const Vec3& p_W) const {
    const double x = p_W.x() - x_m, y = p_W.y() - y_m;
    return {cosine * x + sine * y, cosine * y - sine * x, p_W.z()};
  }
};

class ShapeMotion {
 public:
  struct Settings {
    double tilt_deg = 0;
    LiftMotion::Settings lift;
    // Sines begin with phase 0.
    double slide_velocity_m_per_s = 0;
    double shake_amplitude_m = 0, shake_hz = 5;
    double rock_deg = 0, rock_hz = 1;
    double motion_from_s = 0;
  };

  ShapeMotion(const Settings& settings, double frame_rate_hz);

  ShapePose of_frame(int frame) const;
  ShapePose at(double time_s) const;

  // Number of frames up to and including the first one at rest after the lift.
  int lift_frames() const { return lift_.frame_count(frame_rate_hz_); }
  // The phases of the lift, then one phase for all other motion, which never ends.
  std::vector<Phase> phases() const;
  bool ever_rests() const;
  bool moves_vertically_only() const;  // neither rotated nor moved along x

 private:
  ShapePose moved(double lift_m, double time_s) const;

  const Settings settings_;
  const double frame_rate_hz_;
  const LiftMotion lift_;
};

Parameters parameters(ShapeMotion::Settings& s);

// The points are the grid's nodes on the shape, row by row and layer by layer, moved by the motion. Noise is
// added in the world frame, to the points and not to their normals. A small grid makes a patch, whose border
// is an edge to slide over. A flat lift has the same bits as a moving-lift of the same settings.
class MovingShape final : public GridScene {
 public:
  struct Settings {
    Grid grid{80, 80, 0.0015, 0, 0};
    double frame_rate_hz = 30;
    Shape::Settings shape;
    ShapeMotion::Settings motion;
    int layers = 1;
    double layer_spacing_m = 0.015;
    bool normals = false;
    double noise_sigma_m = 0;
    bool redraw_noise = true;
    double vanish_at_s = -1;
    double empty_frame_at_s = -1;
    SurfaceTime truth = SurfaceTime::newest_frame;
  };

  MovingShape(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  // Number of frames up to the last one that differs from its predecessor. With noise that is drawn anew in
  // each frame, they end only if the surface vanishes.
  int frame_count() const override;
  // Returns the loss of the points and the empty frame, then the motion. The motion is last because a press
  // may come after it.
  std::vector<Phase> phases() const override;
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  // Empty if the frame is empty.
  PointCloud cloud(int frame) const override;
  // Distance to the first layer, positive above it, see Shape::signed_distance(). The layer is where the
  // newest frame shows it. If that frame is empty, the layer is where the frame would have shown it. With
  // SurfaceTime::moving the layer is where it is at time_s, also between frames. NaN once the layer has
  // vanished.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // Returns the normal of the flat shape until it vanishes. Empty for other shapes.
  std::optional<Vec3> plane_normal(double time_s) const override;
  // Height of the first layer as it moves, continued beyond its border, so that a scripted hand always has a
  // surface to press. After the layer has vanished, it is the height at that time.
  double surface_height(double x, double z, double time_s) const override;

 private:
  bool has_vanished(int frame) const { return vanish_frame_ >= 0 && frame >= vanish_frame_; }
  bool is_empty(int frame) const { return has_vanished(frame) || frame == empty_frame_; }
  int noise_frame(int frame) const { return settings_.redraw_noise ? frame : 0; }
  ShapePose true_pose(double time_s) const;
  bool is_a_level_grid() const;

  const Settings settings_;
  const Shape shape_;
  const ShapeMotion motion_;
  const int vanish_frame_, empty_frame_;   // -1: none
  std::vector<Vec3> nodes_S_, normals_S_;  // one entry for each node of the first layer
};

Parameters parameters(MovingShape::Settings& s);
std::string validate(const MovingShape::Settings& s);

}  // namespace remote_touch
