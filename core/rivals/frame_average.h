// Averages of each point over the last frames: a simple way to reduce noise that sensors and programs offer.
// A point is identified by its index: the pixel of an image, or the node of a simulated grid. So the averaged
// surface lags behind a moving surface.
//
//   exponential  the temporal filter of common depth cameras, from the public description of its settings
//                (librealsense): along the ray, d_j' = alpha d_j + (1 - alpha) d_{j-1}', but d_j where both
//                differ by step_threshold_m or more; a missing point keeps its last position as long as it
//                was measured in persistence_hits of the last persistence_frames frames
//   mean         the mean position over those of the last mean_frames frames in which it was measured; a
//                point that is missing in the newest frame is left out
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/vector.h"
#include "core/parameters/parameter.h"
#include "core/rivals/point_normals.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

// A neighbour search over points in the order of their indices, in blocks with bounding boxes. It can be
// filled repeatedly without allocating. Points with neighbouring indices should be near each other, as in an
// image or a grid.

class BlockSearch final : public NeighbourSearch {
 public:
  void reserve(std::size_t points);
  // Sets the number of points. All points are missing until set() is called for them. The memory is kept.
  void clear(std::size_t points, int columns, bool with_radius, bool with_stiffness);
  void set(std::size_t number, const Vec3& p_W) {
    x_[number] = p_W.x(), y_[number] = p_W.y(), z_[number] = p_W.z();
  }
  void set_fixture_radius(std::size_t number, double radius_m) { radius_[number] = radius_m; }
  void set_stiffness(std::size_t number, double N_per_m) { stiffness_[number] = N_per_m; }
  // Must be called after the last set().
  void finish();

  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  std::size_t size() const override { return x_.size(); }
  bool has_fixture_radius() const override { return !radius_.empty(); }
  bool has_regions() const override { return max_radius_m_ > 0; }
  double max_fixture_radius_m() const override { return max_radius_m_; }
  bool has_stiffness() const override { return !stiffness_.empty(); }
  int organised_columns() const override { return columns_; }

 private:
  std::vector<double> x_, y_, z_, radius_, stiffness_;
  std::vector<BoundingBox> boxes_;
  double max_radius_m_ = 0;
  int columns_ = 0;
};

enum class AverageRule { exponential, mean };

struct FrameAverageSettings {
  AverageRule rule = AverageRule::exponential;
  double alpha = 0.4;
  double step_threshold_m = 0.02;
  int persistence_hits = 2, persistence_frames = 4;
  int mean_frames = 4;
  Vec3 view_direction{0, -1, 0};
};

Parameters parameters(FrameAverageSettings& s);
std::string validate(const FrameAverageSettings& s);

class FrameAverage {
 public:
  FrameAverage(const FrameAverageSettings& settings, const Kernels& kernels);
  void reserve(std::size_t points);
  // Adds a frame to the stream and returns the averaged points. They are valid until the second next call. A
  // frame of another size restarts the averages; a frame without points counts as one in which all points are
  // missing. Allocates only for a frame larger than reserved. r_f and k_s are those of the newest frame; a
  // point that is missing there has neither.
  std::shared_ptr<const NeighbourSearch> next(const NeighbourSearch& points);

 private:
  static constexpr int kMaxFrames = 16;
  void begin(std::size_t points);
  void store(const NeighbourSearch& points);
  Vec3 exponential(std::size_t number, const ViewPoint& view);
  Vec3 mean(std::size_t number) const;
  const Vec3& latest(std::size_t number) const { return history_[newest_][number]; }

  const FrameAverageSettings s_;
  const Kernels& kernels_;
  GatheredPoints all_;
  // Measured positions of the last frames; NaN if a point was not measured. Only as many frames are used as
  // the rule needs.
  std::array<std::vector<Vec3>, kMaxFrames> history_;
  int newest_ = 0;
  std::vector<Vec3> smooth_;         // state of the exponential rule
  std::vector<std::uint32_t> seen_;  // one bit for each of the last frames: the point was measured in it
  std::array<std::shared_ptr<BlockSearch>, 2> shown_;
  int shown_last_ = 0;
};

}  // namespace remote_touch
