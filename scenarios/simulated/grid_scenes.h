// Scenes whose points are at the nodes of a rectangular grid, with noise that is computed where it is needed:
// clouds at rest, and flat clouds that are lifted, 4.3.2.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// A rectangular grid in the x-z plane: columns x rows points, spacing_m apart; point row * columns + column.
// The middle of the grid lies at the origin of x and z, moved by the phases in units of the spacing.
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

// A flat grid whose noise is computed only where a query needs it. Points (x, height, z) of the grid, each
// coordinate plus sigma times a standard normal. The result is bit-identical to computing every point. A
// normal has a hard bound (kMaxNormal), so a grid point that is too far away cannot move near. Of the other
// points, only those are computed whose random words allow a displacement that is large enough. The points
// around the last query are cached, and those nearest to it once more, so a search serves one reader at a
// time.
class NoisyGridSearch final : public NeighbourSearch {
 public:
  NoisyGridSearch(const Grid& grid, double height_m, double sigma_m, const NoiseStream& stream);
  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  std::size_t size() const override { return static_cast<std::size_t>(grid_.size()); }
  int organised_columns() const override { return grid_.columns; }

 private:
  // Points at any height whose x and z lie within radius_m of the axis.
  struct Cylinder {
    double x = 0, z = 0, radius_m = -1;
    // Distance of p from the border, along x and z; negative outside.
    double margin_m(const Vec3& p) const;
  };
  struct Range {
    int first, last;
  };
  static Range within(double centre, double reach, double start, double spacing, int count);
  void make(const Cylinder& cylinder, const Kernels& kernels) const;
  void make_points(std::size_t candidates, const Cylinder& cylinder, const Kernels& kernels) const;
  PointRun run(std::size_t first, std::size_t count) const;
  PointRun near(const Ball& ball, const Kernels& kernels) const;

  const Grid grid_;
  const double height_m_, sigma_m_;
  const NoiseStream stream_;
  // Allocated for all points, so that a query never allocates.
  mutable Cylinder cached_cylinder_;
  mutable Ball near_ball_{Vec3::Zero(), -1};
  mutable std::size_t count_ = 0, near_count_ = 0;  // the near points are stored behind the others
  mutable Buffer<std::uint32_t> index_;
  mutable Buffer<std::uint64_t> x_bounds_, z_bounds_;
  mutable Buffer<double> x_, y_, z_;
};

// A scene whose points are at the nodes of a grid, with noise.
class GridScene : public Scenario {
 public:
  double frame_rate_hz() const override { return frame_rate_hz_; }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override {
    return make_search(cloud(frame), 2.5 * grid_.spacing_m);
  }
  double truth_time_s(double time_s) const override {
    return has_moving_truth_ ? time_s : captured_s(newest_frame(time_s));
  }

 protected:
  // settings: those of the scene, with grid, frame_rate_hz and noise_sigma_m. has_moving_truth: the truth is
  // the surface as it moves between frames; otherwise it is as in the newest frame.
  template <class Settings>
  GridScene(const Settings& settings, const NoiseKey& key, const Kernels& kernels,
            bool has_moving_truth = true)
      : grid_(settings.grid),
        noise_sigma_m_(settings.noise_sigma_m),
        has_moving_truth_(has_moving_truth),
        frame_rate_hz_(settings.frame_rate_hz),
        key_(key),
        kernels_(kernels) {}

  // Returns the number of frames of a scene whose surface moves in the first `moving` frames only. Frames
  // never end if noise is drawn anew in each, because each then differs from the one before.
  int frames_of(int moving, bool redraws_noise = true) const {
    return noise_sigma_m_ > 0 && redraws_noise ? std::numeric_limits<int>::max() : moving;
  }
  NoiseStream noise(int frame) const {
    return noise_stream(key_, NoiseUse::point_position, static_cast<std::uint32_t>(frame));
  }
  PointCloud with_noise(PointCloud cloud, int frame) const {
    add_noise(cloud, noise_sigma_m_, noise(frame), kernels_);
    return cloud;
  }
  // Returns the points at(x, z) of all nodes, row by row, with the noise of the frame.
  template <class At>
  PointCloud sampled(int frame, const At& at) const {
    PointCloud cloud;
    cloud.grid_columns = grid_.columns;
    for (int row = 0; row < grid_.rows; ++row)
      for (int column = 0; column < grid_.columns; ++column) cloud.append(at(grid_.x(column), grid_.z(row)));
    return with_noise(std::move(cloud), frame);
  }

  const Grid grid_;
  const double noise_sigma_m_;
  const bool has_moving_truth_;

 private:
  const double frame_rate_hz_;
  const NoiseKey key_;
  const Kernels& kernels_;
};

// Clouds at rest: a flat one, 4.3.1, a triangle wave, 4.3.3, and listed points.

// A flat point cloud at rest at y = 0, see 4.3.1.
class FlatGrid final : public GridScene {
 public:
  struct Settings {
    Grid grid;
    double frame_rate_hz = 30;
    double noise_sigma_m = 0;
    bool redraw_noise = true;
  };

  FlatGrid(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : GridScene(settings, key, kernels), redraw_noise_(settings.redraw_noise) {}

  int frame_count() const override { return frames_of(1, redraw_noise_); }
  PointCloud cloud(int frame) const override;
  // Height over the plane; NaN for a position that is below the plane and beyond the grid.
  double signed_distance(const Vec3& p_W, double) const override { return grid_.signed_distance(p_W, 0); }
  std::optional<Vec3> plane_normal(double) const override { return Vec3::UnitY(); }
  double surface_height(double, double, double) const override { return 0; }

 private:
  const bool redraw_noise_;
};

Parameters parameters(FlatGrid::Settings& s);
inline std::string validate(const FlatGrid::Settings&) {
  return {};
}

// A few points given in the settings, such as the single point of 5.3.1.
class ListedPoints final : public Scenario {
 public:
  struct Settings {
    std::vector<double> points{0, 0, 0};  // rows of x, y, z in metres, world frame
    double frame_rate_hz = 30;
  };

  ListedPoints(const Settings& settings, const NoiseKey&, const Kernels&) : settings_(settings) {}

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int frame) const override;
  // NaN: single points are no surface and have no sides.
  double signed_distance(const Vec3&, double) const override {
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  const Settings settings_;
};

Parameters parameters(ListedPoints::Settings& s);
std::string validate(const ListedPoints::Settings& s);

// A triangle wave of growing amplitude, 4.3.3: sharp convex and concave edges, Fig 4.14. The wave runs along
// x. Its corners lie half a period apart, alternately below and above y = 0 by an amplitude that grows
// linearly along the grid; the flanks between them are straight.
class TriangleWave final : public GridScene {
 public:
  struct Settings {
    Grid grid{300, 100, 0.0015, 0, 0};
    double frame_rate_hz = 30;
    double period_m = 0.06;
    double max_height_m = 0.03;
    double noise_sigma_m = 0;
  };

  TriangleWave(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : GridScene(settings, key, kernels), settings_(settings) {}

  int frame_count() const override { return 1; }
  PointCloud cloud(int frame) const override;
  // Distance to the wave, positive above it; the wave is continued along z. NaN below the wave if p lies
  // beyond the border along z, or beyond an end along x that is the nearest part of the wave.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  double surface_height(double x, double z, double time_s) const override;

 private:
  const Settings settings_;
};

Parameters parameters(TriangleWave::Settings& s);
std::string validate(const TriangleWave::Settings& s);

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
