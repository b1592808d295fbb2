// Checks whether the hand stays on the surface that the camera sees, in runs whose motion was planned on
// depth images.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

class NeighbourSearch;

class SurfaceWatch {
 public:
  // Both must outlive the watch. scenario: without faults, because the trajectory was planned on it.
  SurfaceWatch(const Scenario& scenario, const Trajectory& trajectory)
      : scenario_(scenario), trajectory_(trajectory) {}

  // Compares the hand at the time of a tick with the newest frame that was captured until then.
  void add(const Vec3& hand_W, double time_s);

  // Returns up to three notes. "behind the surface": in some ticks the hand was farther behind the surface at
  // its pixel than the motion plans at most. "off the surface": in some ticks the motion was meant to touch,
  // but nothing was measured around the hand's pixel, the hand was outside the image, or the hand was farther
  // in front of the surface than planned. "hand jumped": from one tick to the next the hand moved farther
  // than the motion does while the surface is at rest. Returns no notes for motions that are not planned on
  // images.
  std::vector<Note> notes() const;

 private:
  const PointCloud* image_at(double time_s);
  void add_step(const Vec3& hand_W, double time_s, double max_step_m);

  const Scenario& scenario_;
  const Trajectory& trajectory_;
  int frame_ = -1;  // number of the frame that was read last
  std::shared_ptr<const NeighbourSearch> points_;
  std::optional<PointCloud> copy_;
  const PointCloud* cloud_ = nullptr;  // the cloud in points_ or copy_
  RigidTransform X_CW_ = RigidTransform::Identity();

  std::size_t ticks_ = 0, off_ = 0, behind_ = 0;
  double first_off_s_ = 0, first_behind_s_ = 0, deepest_m_ = 0, allowed_m_ = 0;
  std::optional<Vec3> last_W_;  // the hand in the tick before
  std::size_t jumps_ = 0;
  double first_jump_s_ = 0, first_jump_m_ = 0, longest_jump_m_ = 0;
};

// Returns the depth of the surface that an image shows at p_C, a position in the camera's frame. It is the
// median of the depths that were measured within a radius around the pixel of p_C. The radius is reach_m at
// the depth of p_C, but at least 1 pixel and at most 32 pixels. Returns NaN if nothing was measured there, or
// if p_C is outside the image or not in front of the camera. X_CW: the world in the camera's frame.
double shown_depth(const PointCloud& cloud, const RigidTransform& X_CW, const Vec3& p_C, double reach_m);

}  // namespace remote_touch
