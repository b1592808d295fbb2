// Parts from which the scenes of the metamorphic tests are made.
#pragma once

#include <functional>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/evaluation/verification/metamorphic_scene.h"
#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {

inline constexpr int kSceneTicks = 320;
inline constexpr double kJitter_m = 0.0002;  // noise of points on a lattice

// A surface in its own frame L, y up; u and v in metres.
using SceneSurface = std::function<Vec3(double u, double v)>;

// The HIP at a tick, and the rotation vector of the device; in the frame of the surface.
struct SceneKnot {
  int tick;
  Vec3 hip_L;
  Vec3 rotation_L = Vec3::Zero();  // rad
};

// Returns a wave of amplitude 1 and period 1 that is made of parabolas. The sine of the C library is not
// used, because its bits differ between machines.
double wave(double t);

Vec3 flat_surface(double u, double v);
Vec3 bumpy_surface(double u, double v);
Vec3 groove_surface(double u, double v);

// Returns the points of a surface without noise. with_normals: normals of the surface, y upwards.
PointCloud sheet_of(const Grid& grid, const SceneSurface& surface, bool with_normals);
// Returns a sheet of 105 mm x 75 mm, points 1.5 mm apart. with_normals: normals of the surface without noise,
// y upwards.
PointCloud sheet(const SceneSurface& surface, double noise_m, int seed, int view, const Kernels& kernels,
                 bool with_normals = false);

// Returns a scene with one cloud for each view. The HIP moves at a constant velocity from knot to knot, and
// the device turns evenly. The first knot is at tick 0.
MetamorphicScene scene_of(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                          const std::function<PointCloud(int view, double time_s)>& cloud);

// Rotations from the surface's frame to the world. They need square roots and products only, so all machines
// compute the same bits.
inline const Eigen::Quaterniond kSlightTilt(1, 0.11, 0.23, -0.07), kSteepTilt(1, -0.35, 0.6, 0.28);
// The surface's frame in the world.
struct ScenePlace {
  const Eigen::Quaterniond& tilt;
  Vec3 shift;
};
// Returns a scene at a place with one cloud that rests.
MetamorphicScene resting_scene(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                               const PointCloud& cloud, const ScenePlace& place);
// Returns the same with the HIP held at the last knot. No view comes in the first 150 ms after the first one,
// so that it settles.
MetamorphicScene held_scene(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                            const PointCloud& cloud, const ScenePlace& place);
// Returns a scene at a place whose surface rises to height(time_s), and the HIP with it.
MetamorphicScene rising_scene(const char* name, const char* what, const std::vector<SceneKnot>& knots,
                              const std::function<double(double time_s)>& height,
                              const std::function<PointCloud(int view, const SceneSurface& surface)>& cloud,
                              const ScenePlace& place);

}  // namespace remote_touch
