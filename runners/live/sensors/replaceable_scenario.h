// A scenario that can be replaced while a simulated camera shows it, because its noise was changed.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "scenarios/interface/scenario.h"

namespace remote_touch {

// The scenario that is shown now, shared by the camera's thread and the thread that replaces it.
class ShownScenario {
 public:
  explicit ShownScenario(std::shared_ptr<const Scenario> first) : now_(std::move(first)) {}
  std::shared_ptr<const Scenario> now() const {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  // pre: the frame rate is the same. The number of frames may differ: a scenario without noise may have a
  // single frame.
  void replace(std::shared_ptr<const Scenario> next) {
    const std::lock_guard lock(mutex_);
    now_ = std::move(next);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Scenario> now_;
};

// points() and cloud() return the last frame for a number beyond it, because the camera may have chosen the
// number before the scenario was replaced.
class ReplaceableScenario final : public Scenario {
 public:
  explicit ReplaceableScenario(std::shared_ptr<const ShownScenario> shown) : shown_(std::move(shown)) {}

  double frame_rate_hz() const override { return shown_->now()->frame_rate_hz(); }
  int frame_count() const override { return shown_->now()->frame_count(); }
  double captured_s(int frame) const override { return shown_->now()->captured_s(frame); }
  bool ends() const override { return shown_->now()->ends(); }
  std::optional<RigidTransform> sensor_pose() const override { return shown_->now()->sensor_pose(); }
  std::optional<double> leaves_sensor_s(int frame) const override {
    return shown_->now()->leaves_sensor_s(frame);
  }
  std::optional<std::uint64_t> fixtures_off(int frame) const override {
    return shown_->now()->fixtures_off(frame);
  }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override {
    const auto now = shown_->now();
    return now->points(std::min(frame, now->frame_count() - 1));
  }
  PointCloud cloud(int frame) const override {
    const auto now = shown_->now();
    return now->cloud(std::min(frame, now->frame_count() - 1));
  }
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return shown_->now()->signed_distance(p_W, time_s);
  }
  Vec3 true_normal(const Vec3& p_W, double time_s) const override {
    return shown_->now()->true_normal(p_W, time_s);
  }
  std::optional<Vec3> plane_normal(double time_s) const override {
    return shown_->now()->plane_normal(time_s);
  }
  double truth_time_s(double time_s) const override { return shown_->now()->truth_time_s(time_s); }
  double surface_height(double x, double z, double time_s) const override {
    return shown_->now()->surface_height(x, z, time_s);
  }

 private:
  const std::shared_ptr<const ShownScenario> shown_;
};

}  // namespace remote_touch
