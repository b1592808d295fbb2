// A depth camera that looks down on a beating organ on a table, as in 5.3.3. The surface moves all the time
// and is known exactly at every instant.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "scenarios/camera/depth_camera.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// A solid ellipsoid with exact distance, ray cast and height.
class Ellipsoid {
 public:
  // semi_axes_m, all > 0, lie along the columns of axes, which is a rotation.
  Ellipsoid(const Vec3& centre_m, const Vec3& semi_axes_m,
            const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

  // Distance to the surface, negative inside; exact on both sides.
  double signed_distance(const Vec3& p) const;
  // Returns the point of the surface that is closest to p, or one of them if there are several.
  Vec3 closest(const Vec3& p) const;
  // Smallest t >= 0 at which origin + t direction enters the solid; infinite if it does not.
  double cast(const Vec3& origin, const Vec3& direction) const;
  // Height (y) of the top over (x, z); minus infinity beside the solid.
  double height(double x, double z) const;
  // (q_1/e_1)^2 + (q_2/e_2)^2 + (q_3/e_3)^2 along its axes: below 1 inside, 1 on the surface.
  double level(const Vec3& p) const { return (to_unit_ball_ * (p - centre_)).squaredNorm(); }

 private:
  // The part of a ray's line inside the solid: t from middle - half to middle + half. half is NaN if the line
  // misses the solid.
  struct Chord {
    double middle, half;
  };
  Chord chord(const Vec3& origin, const Vec3& direction) const;

  Vec3 centre_, semi_axes_;
  Eigen::Matrix3d axes_, to_unit_ball_;
};

// World frame: the table is y = 0, y up. The organ is the union of three ellipsoids, 95 mm long in x, 60 mm
// high over the origin at rest, convex and smooth within 20 mm of that top at every time. By default the
// top's radius of curvature in z falls to 29 mm: a device pressed deeper than that lies beyond the centre of
// curvature, and a proxy slides off. The semi-axes shrink and grow with the beat, all in the same proportion,
// about fixed centres; the atrium leads the ventricles. The motion is twice continuously differentiable in
// time and uses polynomials only: the same bits on every machine. Frame j shows the surface as it is at
// captured_s(j), all pixels at once.
class BeatingHeart final : public Scenario {
 public:
  struct Settings {
    double frame_rate_hz = 30;
    double rate_per_min = 75;
    double amplitude_m = 0.0065;
    DepthCameraSettings camera{.camera_position_m = {0, 0.55, 0}, .target_position_m = {0, 0, 0}};
  };

  BeatingHeart(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override;
  PointCloud cloud(int frame) const override;
  // Distance at exactly time_s, also between frames. It is exact outside organ and table. Inside, the depth
  // returned is a lower bound, because the nearest point of one lobe may lie inside another lobe or inside
  // the table.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  double surface_height(double x, double z, double time_s) const override;

  // Contraction of a ventricle: 0 at rest (full), 1 when fully contracted. beats: time since the start of a
  // contraction, in beats.
  static double contraction(double beats);

 private:
  struct Lobe {
    Ellipsoid solid;
    std::uint32_t colour;
  };
  std::array<Lobe, 3> lobes(double time_s) const;

  const Settings settings_;
  DepthCamera camera_;
};

Parameters parameters(BeatingHeart::Settings& s);
inline std::string validate(const BeatingHeart::Settings& s) {
  return validate(s.camera);
}

}  // namespace remote_touch
