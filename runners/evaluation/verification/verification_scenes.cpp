#include "runners/evaluation/verification/metamorphic_checks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "core/points/neighbour_search.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/simulated/grid_scenes.h"

namespace remote_touch {
namespace {

std::shared_ptr<const NeighbourSearch> search_of(const PointCloud& cloud, double cell_m) {
  if (cloud.image) return std::make_shared<ImageWindowSearch>(cloud);
  if (cell_m > 0) return std::make_shared<UniformGridSearch>(cloud, cell_m);
  return std::make_shared<BruteForceSearch>(cloud);
}

// Parts from which the scenes of the metamorphic tests are made.

constexpr int kSceneTicks = 320;
constexpr double kJitter_m = 0.0002;  // noise of points on a lattice

// A surface in its own frame L, y up; u and v in metres.
using SceneSurface = std::function<Vec3(double u, double v)>;

// The HIP at a tick, and the rotation vector of the device; in the frame of the surface.
struct SceneKnot {
  int tick;
  Vec3 hip_L;
  Vec3 rotation_L = Vec3::Zero();  // rad
};

// Rotations from the surface's frame to the world. They need square roots and products only, so all machines
// compute the same bits.
inline const Eigen::Quaterniond kSlightTilt(1, 0.11, 0.23, -0.07), kSteepTilt(1, -0.35, 0.6, 0.28);
// The surface's frame in the world.
struct ScenePlace {
  const Eigen::Quaterniond& tilt;
  Vec3 shift;
};

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

// Returns a wave of amplitude 1 and period 1 that is made of parabolas. The sine of the C library is not
// used, because its bits differ between machines.
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

// Returns the points of a surface without noise. with_normals: normals of the surface, y upwards.
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

// Returns a sheet of 105 mm x 75 mm, points 1.5 mm apart. with_normals: normals of the surface without noise,
// y upwards.
PointCloud sheet(const SceneSurface& surface, double noise_m, int seed, int view, const Kernels& kernels,
                 bool with_normals = false) {
  PointCloud cloud = sheet_of({70, 50, 0.0015, 0, 0}, surface, with_normals);
  const NoiseKey key{static_cast<std::uint64_t>(seed)};
  add_noise(cloud, noise_m, noise_stream(key, NoiseUse::point_position, static_cast<std::uint32_t>(view)),
            kernels);
  return cloud;
}

// Returns a scene with one cloud for each view. The HIP moves at a constant velocity from knot to knot, and
// the device turns evenly. The first knot is at tick 0.
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

// Returns a scene at a place with one cloud that rests.
MetamorphicScene resting_scene(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                               const PointCloud& cloud, const ScenePlace& at) {
  MetamorphicScene scene = scene_of(name, what, knots, [&](int, double) { return cloud; });
  scene.cloud_rests = true;
  place(scene, at);
  return scene;
}

// Returns the same with the HIP held at the last knot. No view comes in the first 150 ms after the first one,
// so that it settles.
MetamorphicScene held_scene(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                            const PointCloud& cloud, const ScenePlace& at) {
  MetamorphicScene scene = resting_scene(name, what, knots, cloud, at);
  scene.hip_rests = true;
  scene.views.erase(scene.views.begin() + 1, scene.views.begin() + 5);  // 150 ms to settle
  return scene;
}

// Returns a scene at a place whose surface rises to height(time_s), and the HIP with it.
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

// Returns a sheet without roughness. On it, the pose nearest to the device is unique, whatever path the tool
// took. Among bumps or noisy points a rounding difference decides between poses that are millimetres apart.
PointCloud smooth_sheet(const SceneSurface& surface, const Kernels& kernels) {
  return sheet(surface, 0, 0, 0, kernels, true);
}

Vec3 dome(double u, double v) {
  return {u, -2 * (u * u + 1.5 * v * v), v};
}

MetamorphicScene tool_plane(const Kernels& kernels) {
  return resting_scene("tool-plane", "a plane at rest, pressed with a bar that slides and turns",
                       {{0, {-0.01, 0.022, -0.006}, {0, 0, 0}},
                        {60, {-0.01, 0.004, -0.006}, {0.05, 0.1, 0.03}},
                        {320, {0.011, 0.003, 0.007}, {0.12, 0.7, -0.08}}},
                       smooth_sheet(flat_surface, kernels), {kSlightTilt, {0.05, 0.02, -0.03}});
}

// The points are so close together that a renderer may replace many of them by one disk, in cubes of 2 mm
// along the world's axes.
MetamorphicScene tool_dense() {
  return resting_scene(
      "tool-dense", "a plane at rest with points 0.5 mm apart, pressed with the middle of a bar",
      {{0, {0.002, 0.022, -0.001}, {0, 0, 0}},
       {80, {0.002, 0.004, -0.001}, {0.05, 0.1, 0.03}},
       {320, {-0.003, 0.003, 0.002}, {0.1, 0.5, -0.04}}},
      sheet_of({60, 60, 0.0005, 0, 0}, flat_surface, true), {kSlightTilt, {0.03, 0.01, -0.02}});
}

MetamorphicScene tool_groove(const Kernels& kernels) {
  MetamorphicScene scene =
      resting_scene("tool-groove", "two walls that meet, a bar pressed between them and turned",
                    {{0, {0.004, 0.06, -0.005}, {0, 1.5, 0}},
                     {80, {0.002, 0.012, -0.004}, {0.05, 1.5, 0.04}},
                     {320, {-0.003, 0.008, 0.005}, {0.1, 1.3, 0.1}}},
                    smooth_sheet(groove_surface, kernels), {kSteepTilt, {-0.04, 0.02, -0.01}});
  scene.has_crease = true;
  return scene;
}

MetamorphicScene tool_touch_and_go(const Kernels& kernels) {
  return resting_scene("tool-touch-and-go",
                       "a dome at rest, touched with an edge of a bar, slid over and left",
                       {{0, {-0.01, 0.03, 0.008}, {0.3, 0.2, 0.2}},
                        {40, {-0.01, 0.006, 0.008}, {0.3, 0.2, 0.2}},
                        {250, {0.012, 0.004, -0.008}, {0.25, -0.2, 0.05}},
                        {290, {0.013, 0.03, -0.008}, {0.2, -0.2, 0}},
                        {320, {0.013, 0.032, -0.008}, {0.2, -0.2, 0}}},
                       smooth_sheet(dome, kernels), {kSlightTilt, {0.01, -0.06, 0.02}});
}

MetamorphicScene tool_rise(const Kernels& kernels) {
  return rising_scene(
      "tool-rise", "a plane that rises faster and faster, pressed with a bar",
      {{0, {-0.005, 0.022, 0.003}, {0, 0.1, 0}},
       {40, {-0.005, 0.004, 0.003}, {0.15, 0, 0.05}},
       {320, {0.004, 0.002, -0.004}, {0.1, 0.2, -0.1}}},
      [](double time_s) { return 0.04 * time_s + 0.05 * time_s * time_s; },
      [&](int, const SceneSurface& surface) { return smooth_sheet(surface, kernels); },
      {kSlightTilt, {0.02, -0.03, 0.05}});
}

// Chapter 7: every point is a ball. Only renderers of regions render the balls; others touch the points in
// their middle.
PointCloud balls_on(const SceneSurface& surface, double radius_m, const Kernels& kernels) {
  PointCloud cloud = smooth_sheet(surface, kernels);
  cloud.fixture_radius_m.assign(cloud.size(), radius_m);
  return cloud;
}

MetamorphicScene tool_regions(const Kernels& kernels) {
  return resting_scene("tool-regions", "forbidden regions at rest, pressed with a bar that turns",
                       {{0, {-0.01, 0.03, -0.006}, {0, 0, 0}},
                        {60, {-0.01, 0.004, -0.006}, {0.05, 0.1, 0.03}},
                        {320, {0.011, 0.003, 0.007}, {0.12, 0.4, -0.08}}},
                       balls_on(flat_surface, 0.006, kernels), {kSteepTilt, {0.02, 0.04, 0.01}});
}

MetamorphicScene tool_held(const Kernels& kernels) {
  return held_scene("tool-held", "a dome at rest, pressed with a bar and then held still",
                    {{0, {0.003, 0.03, 0.004}}, {20, {0.003, 0.006, 0.004}, {0.1, 0.2, 0}}},
                    balls_on(dome, 0.004, kernels), {kSteepTilt, {-0.02, 0.04, 0.01}});
}

Vec3 roof(double u, double v) {
  return {u, -1.5 * std::abs(u), v};
}

MetamorphicScene bumpy_slide(const Kernels& kernels) {
  return resting_scene(
      "bumpy-slide", "bumps at rest, pressed and slid over",
      {{0, {-0.02, 0.009, -0.01}}, {30, {-0.02, -0.009, -0.01}}, {320, {0.021, -0.012, 0.012}}},
      sheet(bumpy_surface, kJitter_m, 1, 0, kernels), {kSlightTilt, {0.05, 0.02, -0.03}});
}

MetamorphicScene held(const Kernels& kernels) {
  return held_scene("held", "bumps at rest, pressed and then held still",
                    {{0, {0.003, 0.009, 0.004}}, {20, {0.003, -0.009, 0.004}}},
                    sheet(bumpy_surface, kJitter_m, 2, 0, kernels), {kSteepTilt, {-0.02, 0.04, 0.01}});
}

MetamorphicScene touch_and_go(const Kernels& kernels) {
  return resting_scene("touch-and-go", "a rough plane at rest, entered, slid over and left",
                       {{0, {-0.015, 0.012, 0.01}},
                        {40, {-0.015, -0.007, 0.01}},
                        {250, {0.02, -0.01, -0.012}},
                        {290, {0.021, 0.015, -0.012}},
                        {320, {0.021, 0.016, -0.012}}},
                       sheet(flat_surface, 0.001, 3, 0, kernels), {kSlightTilt, {0.01, -0.06, 0.02}});
}

MetamorphicScene ridge(const Kernels& kernels) {
  return resting_scene(
      "ridge", "a sharp ridge at rest, slid across",
      {{0, {-0.02, 0, 0.006}}, {30, {-0.016, -0.037, 0.004}}, {320, {0.018, -0.036, -0.008}}},
      sheet(roof, kJitter_m, 4, 0, kernels), {kSteepTilt, {0.03, 0.01, 0.04}});
}

MetamorphicScene corner(const Kernels& kernels) {
  return resting_scene("corner", "two walls that meet, pressed into and slid along",
                       {{0, {0.012, 0.02, -0.01}},
                        {30, {0.009, -0.008, -0.008}},
                        {120, {-0.002, -0.008, -0.003}},
                        {320, {-0.002, -0.008, 0.01}}},
                       sheet(groove_surface, kJitter_m, 5, 0, kernels), {kSteepTilt, {-0.04, 0.02, -0.01}});
}

// Chapter 5: points that are balls and have their own stiffness.
MetamorphicScene regions(const Kernels& kernels) {
  PointCloud cloud = sheet(flat_surface, kJitter_m, 6, 0, kernels);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.fixture_radius_m.push_back(std::max(0.0, 0.002 * wave(cloud.x[i] / 0.04)));
    cloud.stiffness_N_per_m.push_back(500 + 300 * wave(cloud.z[i] / 0.02));
  }
  return resting_scene(
      "regions", "a plane at rest with forbidden regions and stiffness of its points, slid over",
      {{0, {-0.022, 0.012, 0.01}}, {30, {-0.02, -0.006, 0.01}}, {320, {0.02, -0.008, -0.012}}}, cloud,
      {kSlightTilt, {-0.03, 0.05, 0.02}});
}

MetamorphicScene rise(const Kernels& kernels) {
  return rising_scene(
      "rise", "a noisy plane that rises faster and faster, pressed",
      {{0, {-0.01, 0.009, 0.005}}, {30, {-0.01, -0.012, 0.005}}, {320, {0.008, -0.014, -0.004}}},
      [](double time_s) { return 0.05 * time_s + 0.1 * time_s * time_s; },
      [&](int view, const SceneSurface& surface) { return sheet(surface, 0.0005, 7, view, kernels); },
      {kSlightTilt, {0.02, -0.03, 0.05}});
}

// Chapter 5 in motion: overlapping forbidden regions of different radii rise against the HIP.
MetamorphicScene rising_regions(const Kernels& kernels) {
  return rising_scene(
      "rising-regions", "forbidden regions around a noisy plane that rises, pressed",
      {{0, {-0.01, 0.02, 0.005}}, {30, {-0.01, 0.001, 0.005}}, {320, {0.008, -0.001, -0.004}}},
      [](double time_s) { return 0.04 * time_s + 0.08 * time_s * time_s; },
      [&](int view, const SceneSurface& surface) {
        PointCloud cloud = sheet(surface, 0.0003, 9, view, kernels);
        for (std::size_t i = 0; i < cloud.size(); ++i)
          cloud.fixture_radius_m.push_back(0.008 + 0.001 * wave(cloud.x[i] / 0.05));
        return cloud;
      },
      {kSteepTilt, {-0.01, 0.02, 0.03}});
}

// Depth along the optical axis of a table that falls away to the left.
double table_depth_m(double u, double v) {
  return 0.45 - 0.0004 * u + 0.0007 * v;
}

// Depth image of the table with a block on it, and with pixels that measured nothing (NaN).
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

std::vector<RenderOutput> play(const MetamorphicScene& scene, Renderer& renderer) {
  std::vector<RenderOutput> outputs;
  outputs.reserve(scene.hip_W.size());
  auto view = scene.views.begin();
  for (std::size_t tick = 0; tick < scene.hip_W.size(); ++tick) {
    const double time_s = scene.time_s(tick);
    for (; view != scene.views.end() && view->arrives_s <= time_s; ++view)
      renderer.on_frame(
          {view->index, view->captured_s, view->arrives_s, search_of(view->cloud, scene.cell_m)});
    outputs.push_back(renderer.step({scene.hip_W[tick], scene.device_WH[tick]}, time_s));
  }
  return outputs;
}

std::vector<MetamorphicScene> tool_scenes(const Kernels& kernels) {
  return {tool_plane(kernels), tool_dense(),          tool_groove(kernels), tool_touch_and_go(kernels),
          tool_rise(kernels),  tool_regions(kernels), tool_held(kernels)};
}

std::vector<MetamorphicScene> verification_scenes(const Kernels& kernels) {
  return {bumpy_slide(kernels), rise(kernels),   touch_and_go(kernels),   ridge(kernels), corner(kernels),
          regions(kernels),     camera(kernels), rising_regions(kernels), held(kernels)};
}

}  // namespace remote_touch
