// Scenes for tests of a sensor's faults: a plane that rises and a camera's view, without faults and with
// them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "scenarios/simulated/depth_camera.h"
#include "scenarios/simulated/sensor_faults.h"
#include "scenarios/simulated/shape.h"
#include "tests/support/scenes.h"

namespace remote_touch {

using scenes::same_points;

inline const NoiseKey kKey{5, 2, 3};

// 60 x 50 points that rise by 0.3 m/s for 40 frames.
inline MovingShape::Settings rising_plane() {
  MovingShape::Settings s;
  s.grid = {60, 50, 0.002, 0, 0};
  s.motion.lift.start_velocity_m_per_s = 0.3, s.motion.lift.rise_s = 40 / 30.0;
  s.truth = SurfaceTime::moving;
  return s;
}

inline std::unique_ptr<Scenario> bare(const MovingShape::Settings& settings = rising_plane()) {
  return std::make_unique<MovingShape>(settings, kKey, scenes::kernels());
}
inline std::unique_ptr<Scenario> camera() {
  return std::make_unique<CameraScene>(CameraScene::Settings{}, kKey, scenes::kernels());
}
inline FaultySensor faulty(const SensorFaults& faults, std::unique_ptr<Scenario> scenario = bare(),
                           const NoiseKey& key = kKey) {
  return FaultySensor(std::move(scenario), faults, key, scenes::kernels());
}

inline std::size_t measured(const PointCloud& cloud) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) count += cloud.is_measured(i) ? 1 : 0;
  return count;
}

// Expects that share of the draws, within five standard deviations.
inline void expect_fraction(double count, double of, double fraction) {
  EXPECT_NEAR(count / of, fraction, 5 * std::sqrt(fraction * (1 - fraction) / of));
}

}  // namespace remote_touch
