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

#include "core/parameters/parameter.h"
#include "core/rivals/block_search.h"
#include "core/rivals/point_normals.h"

namespace remote_touch {

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
