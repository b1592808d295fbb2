// Watches whether the hand stays on the surface that the camera sees, in runs whose motion was planned on
// depth images.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/cloud/point_cloud.h"
#include "runners/trajectories/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

class NeighbourSearch;

class SurfaceWatch {
 public:
  // Both must outlive the watch. scenario: without faults, as the trajectory was planned.
  SurfaceWatch(const Scenario& scenario, const Trajectory& trajectory)
      : scenario_(scenario), trajectory_(trajectory) {}

  // Compares the hand at the time of a tick with the newest frame that was captured by then.
  void add(const Vec3& hand_W, double time_s);

  // "behind the surface": the hand was farther behind what its pixel shows than the motion plans at most.
  // "off the surface": the motion is meant to touch, but nothing was measured around the hand's pixel, the
  // hand was outside the image, or farther in front of the surface than planned. Empty without such ticks,
  // and for motions that are not planned on images.
  std::vector<Note> notes() const;

 private:
  const PointCloud* image_at(double time_s);

  const Scenario& scenario_;
  const Trajectory& trajectory_;
  int frame_ = -1;  // the frame that is held
  std::shared_ptr<const NeighbourSearch> points_;
  std::optional<PointCloud> copy_;
  const PointCloud* cloud_ = nullptr;  // in points_ or copy_
  RigidTransform X_CW_ = RigidTransform::Identity();

  std::size_t ticks_ = 0, off_ = 0, behind_ = 0;
  double first_off_s_ = 0, first_behind_s_ = 0, deepest_m_ = 0, allowed_m_ = 0;
};

// The depth that an image shows at a position p_C of the camera's frame, in front of the camera: the median
// of the depths that were measured within reach_m of the viewing ray, at the depth of p_C, and within one
// pixel at least. NaN if none was measured, or p_C is outside the image. X_CW: the world in the camera's
// frame.
double shown_depth(const PointCloud& cloud, const RigidTransform& X_CW, const Vec3& p_C, double reach_m);

}  // namespace remote_touch
