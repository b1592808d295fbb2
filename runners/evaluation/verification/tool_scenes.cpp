#include "runners/evaluation/verification/tool_scenes.h"

#include "runners/evaluation/verification/scene_parts.h"

namespace remote_touch {

namespace {

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

}  // namespace

std::vector<MetamorphicScene> tool_scenes(const Kernels& kernels) {
  return {tool_plane(kernels), tool_dense(),          tool_groove(kernels), tool_touch_and_go(kernels),
          tool_rise(kernels),  tool_regions(kernels), tool_held(kernels)};
}

}  // namespace remote_touch
