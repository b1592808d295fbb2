#include "runners/evaluation/verification/scene_parts.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

constexpr int kTicksPerView = 32;
constexpr int kLatencyTicks = 5;  // the first ticks have no cloud
constexpr double kHapticRate_hz = 1024;

Vec3 normal_of(const SceneSurface& surface, double u, double v) {
  constexpr double kStep_m = 1e-5;
  const Vec3 along_u = surface(u + kStep_m, v) - surface(u - kStep_m, v),
             along_v = surface(u, v + kStep_m) - surface(u, v - kStep_m);
  return along_v.cross(along_u).normalized();
}

void place(MetamorphicScene& scene, const ScenePlace& at) {
  const Eigen::Quaterniond q_WL = at.tilt.normalized();
  const Eigen::Matrix3d R_WL = q_WL.toRotationMatrix();
  for (Vec3& hip : scene.hip_W) hip = R_WL * hip + at.shift;
  for (Eigen::Quaterniond& device : scene.device_WH) device = q_WL * device;
  for (CloudView& view : scene.views) {
    PointCloud& cloud = view.cloud;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3 p_W = R_WL * cloud.point(i) + at.shift;
      cloud.x[i] = p_W.x(), cloud.y[i] = p_W.y(), cloud.z[i] = p_W.z();
      if (!cloud.has_normals()) continue;
      const Vec3 n_W = R_WL * cloud.normal(i);
      cloud.nx[i] = n_W.x(), cloud.ny[i] = n_W.y(), cloud.nz[i] = n_W.z();
    }
  }
}

}  // namespace

double wave(double t) {
  const double f = t - std::floor(t);
  return f < 0.5 ? 16 * f * (0.5 - f) : -16 * (f - 0.5) * (1 - f);
}

Vec3 flat_surface(double u, double v) {
  return {u, 0, v};
}

Vec3 bumpy_surface(double u, double v) {
  return {u, 0.0015 * (wave(u / 0.024) + wave(v / 0.031)), v};
}

// Walls that meet at 100 degrees. In a corner of 90 degrees the steps of chapter 4 alternate between the
// walls, and differences as small as rounding grow a thousandfold in ten ticks.
Vec3 groove_surface(double u, double v) {
  return {0.766 * u, 0.643 * std::abs(u), v};
}

PointCloud sheet_of(const Grid& grid, const SceneSurface& surface, bool with_normals) {
  PointCloud cloud;
  cloud.grid_columns = grid.columns;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double u = grid.x(column), v = grid.z(row);
      if (with_normals)
        cloud.append(surface(u, v), normal_of(surface, u, v));
      else
        cloud.append(surface(u, v));
    }
  return cloud;
}

PointCloud sheet(const SceneSurface& surface, double noise_m, int seed, int view, const Kernels& kernels,
                 bool with_normals) {
  PointCloud cloud = sheet_of({70, 50, 0.0015, 0, 0}, surface, with_normals);
  const NoiseKey key{static_cast<std::uint64_t>(seed)};
  add_noise(cloud, noise_m, noise_stream(key, NoiseUse::point_position, static_cast<std::uint32_t>(view)),
            kernels);
  return cloud;
}

MetamorphicScene scene_of(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                          const std::function<PointCloud(int view, double time_s)>& cloud) {
  MetamorphicScene scene;
  scene.name = name, scene.what = what;
  scene.haptic_rate_hz = kHapticRate_hz;
  std::size_t next = 1;
  for (int tick = 0; tick < kSceneTicks; ++tick) {
    while (next + 1 < knots.size() && tick >= knots[next].tick) ++next;
    const SceneKnot &a = knots[next - 1], &b = knots[next];
    const double fraction = std::min(1.0, static_cast<double>(tick - a.tick) / (b.tick - a.tick));
    scene.hip_W.push_back(a.hip_L + fraction * (b.hip_L - a.hip_L));
    scene.device_WH.push_back(rotation(a.rotation_L + fraction * (b.rotation_L - a.rotation_L)));
  }
  for (int view = 0; view * kTicksPerView < kSceneTicks; ++view) {
    const double captured = view * kTicksPerView / kHapticRate_hz;
    scene.views.push_back({view, captured, captured + kLatencyTicks / kHapticRate_hz, cloud(view, captured)});
  }
  return scene;
}

MetamorphicScene resting_scene(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                               const PointCloud& cloud, const ScenePlace& at) {
  MetamorphicScene scene = scene_of(name, what, knots, [&](int, double) { return cloud; });
  scene.cloud_rests = true;
  place(scene, at);
  return scene;
}

MetamorphicScene held_scene(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                            const PointCloud& cloud, const ScenePlace& at) {
  MetamorphicScene scene = resting_scene(name, what, knots, cloud, at);
  scene.hip_rests = true;
  scene.views.erase(scene.views.begin() + 1, scene.views.begin() + 5);  // 150 ms to settle
  return scene;
}

MetamorphicScene rising_scene(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                              const std::function<double(double time_s)>& height,
                              const std::function<PointCloud(int view, const SceneSurface& surface)>& cloud,
                              const ScenePlace& at) {
  MetamorphicScene scene = scene_of(name, what, knots, [&](int view, double time_s) {
    return cloud(view, [&](double u, double v) { return Vec3(u, height(time_s), v); });
  });
  for (std::size_t tick = 0; tick < scene.hip_W.size(); ++tick)
    scene.hip_W[tick].y() += height(scene.time_s(tick));
  place(scene, at);
  return scene;
}

}  // namespace remote_touch
