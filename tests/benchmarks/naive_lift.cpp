#include "tests/benchmarks/naive_lift.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/benchmarks/naive_proxy.h"

namespace remote_touch::naive {

namespace {

// (4.20), for every frame
std::vector<double> heights(const MovingLift::Settings& scene) {
  const LiftMotion::Settings& lift = scene.lift;
  double velocity = lift.start_velocity_m_per_s, height = -lift.start_depth_m;
  std::vector<double> out{height};
  const auto frames = [&](double time_s) {
    return static_cast<int>(std::lround(time_s * scene.frame_rate_hz));
  };
  for (int j = 0; j < frames(lift.rise_s) + frames(lift.acceleration_s); ++j) {
    if (j >= frames(lift.rise_s)) velocity += lift.acceleration_m_per_s2 / scene.frame_rate_hz;
    out.push_back(height += velocity / scene.frame_rate_hz);
  }
  return out;
}

}  // namespace

MakePoints standard_noise(const MovingLift::Settings& scene, std::uint64_t seed) {
  return [scene, random = std::mt19937_64(seed), normal = std::normal_distribution<double>()](
             int, double height_m, std::vector<Vec3>& points) mutable {
    points.clear();
    for (int row = 0; row < scene.grid.rows; ++row)
      for (int column = 0; column < scene.grid.columns; ++column) {
        const double x = scene.grid.x(column) + scene.noise_sigma_m * normal(random);
        const double y = height_m + scene.noise_sigma_m * normal(random);
        const double z = scene.grid.z(row) + scene.noise_sigma_m * normal(random);
        points.emplace_back(x, y, z);
      }
  };
}

std::vector<Vec3> proxies(const Lift& lift, const MakePoints& make_points) {
  const std::vector<double> height_m = heights(lift.scene);
  const double interval_s = 1 / lift.scene.frame_rate_hz;
  Vec3 proxy_W = Vec3::Zero(), normal_W = Vec3::Zero();
  double velocity = 0;
  std::vector<Vec3> points, out;
  for (int frame = 0; frame < static_cast<int>(height_m.size()); ++frame) {
    const double height = height_m[static_cast<std::size_t>(frame)];
    make_points(frame, height, points);
    const Vec3 hip_W(0, frame < lift.press_frame ? 0 : height - lift.depth_m, 0);
    const Vec3 along = normal_W;
    proxy_W += velocity * interval_s * along;  // (4.3)
    for (int k = 0; k < lift.steps_per_frame; ++k) {
      const Step step = proxy_step(points, proxy_W, hip_W, normal_W, lift.proxy);
      normal_W = step.normal;
      if (k == 0 && frame > 0)
        velocity = std::max(0.0, velocity + along.dot(step.step) / interval_s);  // (4.13)
      proxy_W += step.step;
      out.push_back(proxy_W);
    }
  }
  return out;
}

bool popped_through(const Lift& lift, const std::vector<Vec3>& proxies) {
  return proxies.back().y() < heights(lift.scene).back();
}

}  // namespace remote_touch::naive
