// Scenes before a simulated camera that are known exactly at every instant: a beating organ on a table, as in
// 5.3.3, and two handwheel valves in a tank of turbid water, the scene of 7.5.1.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "scenarios/simulated/depth_camera.h"
#include "scenarios/simulated/scenario.h"

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

// A valve's handwheel: a ring on three round spokes, with a hub, and a stem back to the wall behind it. The
// axis is along z and the wheel lies in the plane z = centre.z; the stem ends at the wall z = 0. One spoke
// points up, +y. Metres.
class Handwheel {
 public:
  // Dimensions other than the constructor's. The ring's radius is that of the centre line of its tube.
  static constexpr double kTubeRadius_m = 0.007, kSpokeRadius_m = 0.0045;
  static constexpr double kHubRadius_m = 0.011, kHubHalfLength_m = 0.010, kStemRadius_m = 0.008;

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

// exp(-x) for x >= 0, with a relative error below 1e-12; 0 from 64 on. Computed by products, so that the bits
// do not depend on which exponential the C library picks for a machine.
double decay(double x);

// Model of a colour and depth camera in turbid water: colours fade into a veil of scattered light, and depth
// becomes noisier or is lost. The rates describe the trend, not one particular water.
//
// Distances are metres of water between the camera and the object; infinite if the pixel shows no object. The
// model neglects blur and the path of the light to the objects.
class Water {
 public:
  // Attenuation beta per metre, 0 for clear water. Red is lost fastest, blue slowest.
  explicit Water(double turbidity_per_m) : turbidity_per_m_(turbidity_per_m) {}

  static constexpr double kAttenuation[3] = {1.3, 0.95, 0.8};  // factors on beta for red, green and blue
  static constexpr double kVeil[3] = {13, 31, 28};             // a dark bluish green; 0 to 255

  // Colour through the water, as channels from 0 to 255. A channel c of rgb, 0xRRGGBB, becomes
  // c exp(-beta_c d) + veil_c (1 - exp(-beta_c d)).
  std::array<double, 3> seen(std::uint32_t rgb, double distance_m) const;

  // Probability that a pixel has no depth, 1 - (1 - dropout) exp(-beta d / 4), with dropout the probability
  // in clear water.
  double lost(double dropout_probability, double distance_m) const;
  // Factor on the standard deviation of depth, 1 + beta d, because the sensor's light pattern returns
  // fainter.
  double depth_noise_factor(double distance_m) const;

 private:
  const double turbidity_per_m_;
};

// The class of a pixel, and the valve that a query is about.
enum class Valve : std::uint8_t { none, left, right };

// World frame: the robot's base frame, y up. The tank's wall is the plane z = 0 and the valves are in front
// of it. X_WC, in the image layout of every cloud, is the registration of the camera. The scene does not
// move. The noise of colour and depth and the pixels without depth change with each frame, as pure functions
// of the noise key and the frame's number. The scene is lit from the camera by Lambert's law, with some
// ambient light.
class ValveTank final : public Scenario {
 public:
  struct Settings {
    double frame_rate_hz = 30;
    Vec3 left_valve_position_m{-0.11, 0, 0.06};
    Vec3 right_valve_position_m{0.11, 0, 0.06};
    double ring_radius_m = 0.045;
    double left_hue_deg = 0;
    double right_hue_deg = 46;
    double turbidity_per_m = 0.6;
    double colour_noise = 3;
    double dropout_probability = 0.02;
    DepthCameraSettings camera{
        .camera_position_m = {0, 0.3, 0.9}, .target_position_m = {0, 0, 0.04}, .hole_px = 1};
  };

  ValveTank(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override;
  PointCloud cloud(int frame) const override;
  // Distance to the union of wall and valves; exact outside.
  double signed_distance(const Vec3& p_W, double time_s) const override;

  // Distance to one valve alone, without the wall; used for the clearance of a tool.
  double distance_to_valve(Valve valve, const Vec3& p_W) const;
  // Returns the true class of each pixel as an ideal camera sees it, also for pixels without depth.
  std::vector<Valve> truth() const;

 private:
  struct ClassifiedHit {
    double t;
    Valve valve;
  };
  ClassifiedHit first_hit(const Vec3& origin_W, const Vec3& ray_W) const;
  RayHit shaded(const Vec3& origin_W, const Vec3& ray_W) const;
  void fill_with_water();
  void apply_water(int frame, int row, PointCloud& cloud) const;

  const Settings settings_;
  const NoiseKey key_;
  const Kernels& kernels_;
  std::array<Handwheel, 2> wheels_;
  std::array<std::uint32_t, 3> paint_;  // indexed by Valve; none is the wall
  DepthCamera camera_;
  IdealView view_;
  // Colour of each pixel, and probability that it has no depth; both through the water and without noise.
  std::vector<std::array<double, 3>> colour_;
  std::vector<double> lost_;
};

Parameters parameters(ValveTank::Settings& s);
std::string validate(const ValveTank::Settings& s);

}  // namespace remote_touch
