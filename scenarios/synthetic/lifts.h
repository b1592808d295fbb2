// Flat clouds that are lifted, 4.3.2, and their motion.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {

// Motion of a surface that is lifted, 4.3.2: it waits, rises at constant velocity, accelerates and rests. It
// is a function of time, which a camera samples at its frames. 4.3.2 gives the heights at the frames: v_j =
// v_{j-1} + a / f_c and y_j = y_{j-1} + v_j / f_c. This class uses them as the heights at the updates of the
// motion, which have a rate of their own. The motion between two updates is linear, or it follows the
// parabola with the acceleration a. With the time t since the end of the rise and the height y_0 there, the
// parabola is
//   y = y_0 + v_0 t + a t (t + 1 / update_rate_hz) / 2.
// The displacement from frame to frame then grows by a / f_c^2 with each frame, for any frame rate f_c. The
// parabola begins one update before the end of the rise. The velocity drops there by a / (2 update_rate_hz).
class LiftMotion {
 public:
  enum class BetweenUpdates { parabola, line };
  struct Settings {
    double wait_s = 0;
    double start_depth_m = 0;
    double start_velocity_m_per_s = 0;
    double rise_s = 0;
    double acceleration_m_per_s2 = 0;
    double acceleration_s = 0;
    double update_rate_hz = 30;
    BetweenUpdates between_updates = BetweenUpdates::parabola;
  };

  explicit LiftMotion(const Settings& settings);

  double height_m(double time_s) const { return height_at_update(time_s * settings_.update_rate_hz); }
  // Height at the time of a frame. It is exactly the height of an update if both rates are equal.
  double height_of_frame_m(int frame, double frame_rate_hz) const {
    return height_at_update(frame * (settings_.update_rate_hz / frame_rate_hz));
  }
  // Number of frames up to and including the first one at rest after the motion.
  int frame_count(double frame_rate_hz) const;

  // Returns the rise and the acceleration, if the motion has them.
  std::vector<Phase> phases() const;

 private:
  // Times are in updates: 2.5 is in the middle between updates 2 and 3.
  double height_at_update(double time) const;
  double on_lines_m(double time) const;
  double risen_m(double updates) const;  // height at this time after the beginning of the rise

  const Settings settings_;
  const double rise_begin_, rise_end_, end_;
  std::vector<double> accelerated_m_;  // heights at the updates from the end of the rise on
};

Parameters parameters(LiftMotion::Settings& s);

// A flat cloud that rises from below at constant velocity and then accelerates, 4.3.2: the experiment of
// Figs 4.12 and 4.13. Noise is drawn anew for every point of every frame.
class MovingLift final : public GridScene {
 public:
  struct Settings {
    Grid grid{200, 200, 0.0015, 0, 0};
    double frame_rate_hz = 30;
    double noise_sigma_m = 0.003;
    LiftMotion::Settings lift{.start_depth_m = 0.05,
                              .start_velocity_m_per_s = 0.1,
                              .rise_s = 0.5,
                              .acceleration_m_per_s2 = 3,
                              .acceleration_s = 1.0 / 3};
    SurfaceTime truth = SurfaceTime::newest_frame;
  };

  MovingLift(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  int frame_count() const override { return frames_of(lift_.frame_count(frame_rate_hz())); }
  std::vector<Phase> phases() const override { return lift_.phases(); }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  PointCloud cloud(int frame) const override;
  // Height over the plane of the newest frame, because pop-through is judged against what the camera has
  // seen. With SurfaceTime::moving it is the height over the plane as it moves. NaN for a position that
  // is below the plane and beyond the grid.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // Height of the plane as it moves, also between frames.
  double surface_height(double, double, double time_s) const override { return lift_.height_m(time_s); }
  std::optional<Vec3> plane_normal(double) const override { return Vec3::UnitY(); }

 private:
  double height_m(int frame) const { return lift_.height_of_frame_m(frame, frame_rate_hz()); }

  const LiftMotion lift_;
};

Parameters parameters(MovingLift::Settings& s);
inline std::string validate(const MovingLift::Settings&) {
  return {};
}

// A flat cloud with normals that waits and then rises: a plane that lifts a tool.
class MovingPlane final : public GridScene {
 public:
  struct Settings {
    Grid grid{100, 100, 0.002, 0, 0};
    double frame_rate_hz = 30;
    double start_height_m = -0.06;
    double wait_s = 1;
    double speed_m_per_s = 0.1;
    double acceleration_m_per_s2 = 0;
    double rise_height_m = 0.1;
    double noise_sigma_m = 0;
  };

  MovingPlane(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  // Number of frames up to and including the first one in which the plane has come to rest for good, limited
  // to the largest int. With noise the frames never end.
  int frame_count() const override { return frames_of(moving_frames_); }
  std::vector<Phase> phases() const override {
    if (settings_.rise_height_m == 0) return {};
    return {{"the rise of the plane", settings_.wait_s, settings_.wait_s + rising_s_}};
  }
  PointCloud cloud(int frame) const override;
  // Height over the plane at time_s, also between frames. NaN for a position that is below the plane and
  // beyond the grid.
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return grid_.signed_distance(p_W, height(time_s));
  }
  std::optional<Vec3> plane_normal(double) const override { return Vec3::UnitY(); }
  double surface_height(double, double, double time_s) const override { return height(time_s); }

 private:
  double height(double time_s) const;

  const Settings settings_;
  double rising_s_ = 0;  // duration of the rise
  int moving_frames_ = 1;
};

Parameters parameters(MovingPlane::Settings& s);
std::string validate(const MovingPlane::Settings& s);

}  // namespace remote_touch
