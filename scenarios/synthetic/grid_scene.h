// Scenes whose points are at the nodes of a rectangular grid, with noise that is computed where it is needed.
#pragma once

#include <limits>
#include <memory>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// A rectangular grid of points in the x-z plane, and the noise that a scenario puts on its points.

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

}  // namespace remote_touch
