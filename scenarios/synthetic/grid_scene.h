// A scene whose points are at the nodes of a grid, with noise.
#pragma once

#include <limits>

#include "scenarios/interface/scenario.h"
#include "scenarios/synthetic/grid.h"

namespace remote_touch {

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
