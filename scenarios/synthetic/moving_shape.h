// A surface of one of a few shapes that is lifted, slid, shaken or rocked, and may vanish. It serves to
// compare renderers on more motions than the lifts of 4.3.2.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "scenarios/synthetic/grid_scene.h"
#include "scenarios/synthetic/lifts.h"
#include "scenarios/synthetic/shape.h"

namespace remote_touch {

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
