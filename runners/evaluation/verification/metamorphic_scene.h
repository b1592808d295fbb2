// The scenes of the metamorphic tests: a stream of clouds and a path of the HIP as plain data, so that both
// can be rotated, scaled, reordered or delayed before they are played again.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// One frame of the stream.
struct CloudView {
  int index = 0;
  double captured_s = 0;
  double arrives_s = 0;
  PointCloud cloud;
};

// World frame, metres, seconds.
struct MetamorphicScene {
  std::string name;
  std::string what;  // one line
  double haptic_rate_hz = 0;
  double start_s = 0;            // time of the first tick
  std::vector<CloudView> views;  // views in the order of their arrival
  std::vector<Vec3> hip_W;       // HIP in each tick
  // Orientation of the device in each tick: transforms directions from its handle to the world frame.
  std::vector<Eigen::Quaterniond> device_WH;
  bool cloud_rests = false;  // every view shows the same points
  bool hip_rests = false;    // the HIP is at rest before the second view arrives, and stays there
  bool has_crease = false;   // walls meet, which a fitted sheet rounds off
  // Cell size of the grid in which points are searched; 0: brute force. An organised cloud is searched by its
  // image instead.
  double cell_m = 0.004;

  double time_s(std::size_t tick) const { return start_s + static_cast<double>(tick) / haptic_rate_hz; }
};

// One output for each tick.
std::vector<RenderOutput> play(const MetamorphicScene& scene, Renderer& renderer);

}  // namespace remote_touch
