// A depth camera that looks down on a beating organ on a table, as in 5.3.3. The surface moves all the time
// and is known exactly at every instant.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "core/parameters/parameter.h"
#include "scenarios/camera/depth_camera.h"
#include "scenarios/camera/ellipsoid.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

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
