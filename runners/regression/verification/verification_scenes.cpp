#include "runners/regression/verification/verification_scenes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/cloud/camera.h"
#include "scenarios/synthetic/grid.h"

namespace remote_touch {

namespace {

constexpr int kTicks = 320;
constexpr int kTicksPerView = 32;
constexpr int kLatencyTicks = 5;  // the first ticks have no cloud
constexpr double kHapticRate_hz = 1024;
constexpr double kJitter_m = 0.0002;  // of points on a lattice

// A surface in its own frame L, y up; u and v in metres.
using Surface = std::function<Vec3(double u, double v)>;

struct Knot {
  int tick;
  Vec3 hip_L;
};

// A sine of amplitude 1 and period 1 made of parabolas: the C library's differs between machines.
double wave(double t) {
  const double f = t - std::floor(t);
  return f < 0.5 ? 16 * f * (0.5 - f) : -16 * (f - 0.5) * (1 - f);
}

Vec3 plane(double u, double v) {
  return {u, 0, v};
}

Vec3 bumps(double u, double v) {
  return {u, 0.0015 * (wave(u / 0.024) + wave(v / 0.031)), v};
}

Vec3 roof(double u, double v) {
  return {u, -1.5 * std::abs(u), v};
}

// Walls that meet at 100 degrees. In a corner of 90 the steps of chapter 4 go to and fro between the walls,
// and differences as small as rounding grow a thousandfold in ten ticks.
Vec3 groove(double u, double v) {
  return {0.766 * u, 0.643 * std::abs(u), v};
}

// 105 mm x 75 mm.
PointCloud sheet(const Surface& surface, double noise_m, int seed, int view, const Kernels& kernels) {
  const Grid grid{70, 50, 0.0015, 0, 0};
  PointCloud cloud;
  cloud.grid_columns = grid.columns;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) cloud.append(surface(grid.x(column), grid.z(row)));
  const NoiseKey key{static_cast<std::uint64_t>(seed)};
  add_noise(cloud, noise_m, noise_stream(key, NoiseUse::point_position, static_cast<std::uint32_t>(view)),
            kernels);
  return cloud;
}

// Even motion between the knots, the first of which is at tick 0.
std::vector<Vec3> polyline(const std::vector<Knot>& knots) {
  std::vector<Vec3> path;
  std::size_t next = 1;
  for (int tick = 0; tick < kTicks; ++tick) {
    while (next + 1 < knots.size() && tick >= knots[next].tick) ++next;
    const Knot &a = knots[next - 1], &b = knots[next];
    const double fraction = std::min(1.0, static_cast<double>(tick - a.tick) / (b.tick - a.tick));
    path.push_back(a.hip_L + fraction * (b.hip_L - a.hip_L));
  }
  return path;
}

MetamorphicScene scene_of(const char* name, const char* what, const std::vector<Knot>& knots,
                          const std::function<PointCloud(int view, double time_s)>& cloud) {
  MetamorphicScene scene;
  scene.name = name, scene.what = what;
  scene.haptic_rate_hz = kHapticRate_hz;
  scene.hip_W = polyline(knots);
  for (int view = 0; view * kTicksPerView < kTicks; ++view) {
    const double captured = view * kTicksPerView / kHapticRate_hz;
    scene.views.push_back({view, captured, captured + kLatencyTicks / kHapticRate_hz, cloud(view, captured)});
  }
  return scene;
}

// From the surface's frame to the world. Square roots and products only: the same bits on every machine.
const Eigen::Quaterniond kSlightTilt(1, 0.11, 0.23, -0.07), kSteepTilt(1, -0.35, 0.6, 0.28);

void place(MetamorphicScene& scene, const Eigen::Quaterniond& tilt, const Vec3& shift) {
  const Eigen::Matrix3d R_WL = tilt.normalized().toRotationMatrix();
  for (Vec3& hip : scene.hip_W) hip = R_WL * hip + shift;
  for (CloudView& view : scene.views) {
    PointCloud& cloud = view.cloud;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3 p_W = R_WL * cloud.point(i) + shift;
      cloud.x[i] = p_W.x(), cloud.y[i] = p_W.y(), cloud.z[i] = p_W.z();
    }
  }
}

MetamorphicScene resting(const char* name, const char* what, const std::vector<Knot>& knots,
                         const PointCloud& cloud) {
  MetamorphicScene scene = scene_of(name, what, knots, [&](int, double) { return cloud; });
  scene.cloud_rests = true;
  return scene;
}

MetamorphicScene bumpy_slide(const Kernels& kernels) {
  MetamorphicScene scene =
      resting("bumpy-slide", "bumps at rest, pressed and slid over",
              {{0, {-0.02, 0.009, -0.01}}, {30, {-0.02, -0.009, -0.01}}, {320, {0.021, -0.012, 0.012}}},
              sheet(bumps, kJitter_m, 1, 0, kernels));
  place(scene, kSlightTilt, {0.05, 0.02, -0.03});
  return scene;
}

MetamorphicScene held(const Kernels& kernels) {
  MetamorphicScene scene = resting("held", "bumps at rest, pressed and then held still",
                                   {{0, {0.003, 0.009, 0.004}}, {20, {0.003, -0.009, 0.004}}},
                                   sheet(bumps, kJitter_m, 2, 0, kernels));
  scene.hip_rests = true;
  scene.views.erase(scene.views.begin() + 1, scene.views.begin() + 5);  // 150 ms to settle
  place(scene, kSteepTilt, {-0.02, 0.04, 0.01});
  return scene;
}

MetamorphicScene touch_and_go(const Kernels& kernels) {
  MetamorphicScene scene = resting("touch-and-go", "a rough plane at rest, entered, slid over and left",
                                   {{0, {-0.015, 0.012, 0.01}},
                                    {40, {-0.015, -0.007, 0.01}},
                                    {250, {0.02, -0.01, -0.012}},
                                    {290, {0.021, 0.015, -0.012}},
                                    {320, {0.021, 0.016, -0.012}}},
                                   sheet(plane, 0.001, 3, 0, kernels));
  place(scene, kSlightTilt, {0.01, -0.06, 0.02});
  return scene;
}

MetamorphicScene ridge(const Kernels& kernels) {
  MetamorphicScene scene =
      resting("ridge", "a sharp ridge at rest, slid across",
              {{0, {-0.02, 0, 0.006}}, {30, {-0.016, -0.037, 0.004}}, {320, {0.018, -0.036, -0.008}}},
              sheet(roof, kJitter_m, 4, 0, kernels));
  place(scene, kSteepTilt, {0.03, 0.01, 0.04});
  return scene;
}

MetamorphicScene corner(const Kernels& kernels) {
  MetamorphicScene scene = resting("corner", "two walls that meet, pressed into and slid along",
                                   {{0, {0.012, 0.02, -0.01}},
                                    {30, {0.009, -0.008, -0.008}},
                                    {120, {-0.002, -0.008, -0.003}},
                                    {320, {-0.002, -0.008, 0.01}}},
                                   sheet(groove, kJitter_m, 5, 0, kernels));
  place(scene, kSteepTilt, {-0.04, 0.02, -0.01});
  return scene;
}

// Chapter 5: points that are balls and have their own stiffness.
MetamorphicScene regions(const Kernels& kernels) {
  PointCloud cloud = sheet(plane, kJitter_m, 6, 0, kernels);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.fixture_radius_m.push_back(std::max(0.0, 0.002 * wave(cloud.x[i] / 0.04)));
    cloud.stiffness_N_per_m.push_back(500 + 300 * wave(cloud.z[i] / 0.02));
  }
  MetamorphicScene scene = resting(
      "regions", "a plane at rest with forbidden regions and stiffness of its points, slid over",
      {{0, {-0.022, 0.012, 0.01}}, {30, {-0.02, -0.006, 0.01}}, {320, {0.02, -0.008, -0.012}}}, cloud);
  place(scene, kSlightTilt, {-0.03, 0.05, 0.02});
  return scene;
}

MetamorphicScene rise(const Kernels& kernels) {
  const auto height = [](double time_s) { return 0.05 * time_s + 0.1 * time_s * time_s; };
  MetamorphicScene scene =
      scene_of("rise", "a noisy plane that rises faster and faster, pressed",
               {{0, {-0.01, 0.009, 0.005}}, {30, {-0.01, -0.012, 0.005}}, {320, {0.008, -0.014, -0.004}}},
               [&](int view, double time_s) {
                 return sheet([&](double u, double v) { return Vec3(u, height(time_s), v); }, 0.0005, 7, view,
                              kernels);
               });
  for (std::size_t tick = 0; tick < scene.hip_W.size(); ++tick)
    scene.hip_W[tick].y() += height(scene.time_s(tick));
  place(scene, kSlightTilt, {0.02, -0.03, 0.05});
  return scene;
}

// Chapter 5 in motion: regions that overlap and differ rise against the HIP.
MetamorphicScene rising_regions(const Kernels& kernels) {
  const auto height = [](double time_s) { return 0.04 * time_s + 0.08 * time_s * time_s; };
  MetamorphicScene scene =
      scene_of("rising-regions", "forbidden regions around a noisy plane that rises, pressed",
               {{0, {-0.01, 0.02, 0.005}}, {30, {-0.01, 0.001, 0.005}}, {320, {0.008, -0.001, -0.004}}},
               [&](int view, double time_s) {
                 PointCloud cloud = sheet([&](double u, double v) { return Vec3(u, height(time_s), v); },
                                          0.0003, 9, view, kernels);
                 for (std::size_t i = 0; i < cloud.size(); ++i)
                   cloud.fixture_radius_m.push_back(0.008 + 0.001 * wave(cloud.x[i] / 0.05));
                 return cloud;
               });
  for (std::size_t tick = 0; tick < scene.hip_W.size(); ++tick)
    scene.hip_W[tick].y() += height(scene.time_s(tick));
  place(scene, kSteepTilt, {-0.01, 0.02, 0.03});
  return scene;
}

// Along the optical axis: a table that falls away to the left.
double table_depth_m(double u, double v) {
  return 0.45 - 0.0004 * u + 0.0007 * v;
}

// With a block on the table, and pixels that saw nothing.
DepthImage depth_image(int view, const CameraIntrinsics& camera, const Kernels& kernels) {
  constexpr double kBlock_m = 0.012, kNoise_m = 0.0003;
  PointCloud noise;
  for (int i = 0; i < camera.width * camera.height; ++i) noise.append(Vec3::Zero());
  add_noise(noise, kNoise_m, noise_stream(NoiseKey{8}, NoiseUse::depth, static_cast<std::uint32_t>(view)),
            kernels);
  DepthImage depth{camera.width, camera.height, {}};
  for (int i = 0; i < camera.width * camera.height; ++i) {
    const int u = i % camera.width, v = i / camera.width;
    const bool hole = (7 * u + 13 * v) % 61 == 0, block = u > 48 && v > 20;
    const double true_m = table_depth_m(u, v) - (block ? kBlock_m : 0);
    depth.z_m.push_back(hole ? std::numeric_limits<double>::quiet_NaN()
                             : true_m + noise.z[static_cast<std::size_t>(i)]);
  }
  return depth;
}

MetamorphicScene camera(const Kernels& kernels) {
  const CameraIntrinsics intrinsics{96, 72, 300, 300, 47.3, 35.8};
  RigidTransform X_WC = RigidTransform::Identity();
  X_WC.linear() = kSteepTilt.normalized().toRotationMatrix();
  X_WC.translation() = Vec3(0.1, 0.3, -0.2);
  const auto behind = [&](double u, double v, double depth_m) {
    return unproject(intrinsics, u, v, table_depth_m(u, v) + depth_m);
  };
  MetamorphicScene scene =
      scene_of("camera", "an organised cloud of a table and a block on it, slid over",
               {{0, behind(25, 30, -0.01)},
                {30, behind(25, 31, 0.008)},
                {160, behind(43, 34, 0.007)},
                {180, behind(52, 36, -0.02)},  // over the edge
                {200, behind(54, 37, -0.005)},
                {320, behind(66, 40, -0.004)}},
               [&](int view, double) {
                 return cloud_from_depth(depth_image(view, intrinsics, kernels), intrinsics, X_WC);
               });
  for (Vec3& hip : scene.hip_W) hip = X_WC * hip;
  return scene;
}

}  // namespace

std::vector<MetamorphicScene> verification_scenes(const Kernels& kernels) {
  return {bumpy_slide(kernels), rise(kernels),   touch_and_go(kernels),   ridge(kernels), corner(kernels),
          regions(kernels),     camera(kernels), rising_regions(kernels), held(kernels)};
}

}  // namespace remote_touch
