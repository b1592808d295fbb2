// A colour and depth camera looks at two handwheel valves in a tank of turbid water: the scene of 7.5.1
// without a recording, with known classes for every pixel.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/camera/depth_camera.h"
#include "scenarios/camera/handwheel.h"
#include "scenarios/camera/water.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

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

  // Distance to one valve alone, without the wall; used for the clearance of a tool. pre: valve is not none.
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
