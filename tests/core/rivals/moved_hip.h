// A renderer over a cloud, and a HIP that moves.
#pragma once

#include "core/rendering/renderer.h"
#include "tests/support/scenes.h"

namespace remote_touch::moved_hip {

template <class Made, class Settings>
Made over(const PointCloud& cloud, const Settings& settings) {
  Made renderer(settings, 1000, scenes::kernels());
  renderer.on_frame(scenes::frame(cloud));
  return renderer;
}

inline RenderOutput rest(Renderer& r, const Vec3& hip, int ticks = 40) {
  RenderOutput out;
  for (int i = 0; i < ticks; ++i) out = r.step({hip}, 0.001 * i);
  return out;
}

// Moves in that many ticks and rests then.
inline RenderOutput go(Renderer& r, const Vec3& from, const Vec3& to, int ticks = 60) {
  for (int i = 0; i < ticks; ++i) r.step({Vec3(from + (to - from) * (double(i) / ticks))}, 0.001 * i);
  return rest(r, to);
}

// Presses from 2 cm above the origin.
inline RenderOutput press(Renderer& r, double depth_m) {
  return go(r, {0, 0.02, 0}, {0, -depth_m, 0});
}

// Smooth bumps of 2 mm.
inline PointCloud bumps() {
  PointCloud cloud = scenes::flat_grid(60);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.y[i] = 0.002 * std::sin(cloud.x[i] / 0.009) * std::cos(cloud.z[i] / 0.012);
  return cloud;
}

}  // namespace remote_touch::moved_hip
