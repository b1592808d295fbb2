// A lift of Fig 4.12 written plainly from its equations, over all points, with the standard library's noise.
// The map of Fig 4.13 is measured against it.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/dissertation/proxy/proxy_motion.h"
#include "core/points/vector.h"
#include "scenarios/simulated/grid_scenes.h"

namespace remote_touch::naive {

struct Lift {
  MovingLift::Settings scene;
  ProxyParameters proxy;
  int steps_per_frame = 30;
  int press_frame = 15;   // frame with which the HIP begins to press
  double depth_m = 0.03;  // depth of the pressing HIP below the plane
};

// Replaces the content of points by the points of a frame, whose plane lies at that height.
using MakePoints = std::function<void(int frame, double height_m, std::vector<Vec3>& points)>;

// Every point of the scene's grid with three normal deviates of its own, drawn anew for each frame.
MakePoints standard_noise(const MovingLift::Settings& scene, std::uint64_t seed);

// Returns the proxy after every step. A tick has one step, with frame correction (4.3) and velocity estimate
// (4.13).
std::vector<Vec3> proxies(const Lift& lift, const MakePoints& make_points);

// True if the last proxy lies below the plane of the last frame.
bool popped_through(const Lift& lift, const std::vector<Vec3>& proxies);

}  // namespace remote_touch::naive
