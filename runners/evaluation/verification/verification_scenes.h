// The scenes of the metamorphic tests as plain data: those in which every renderer is checked, and those for
// tools.
#pragma once

#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// One frame of the stream.
struct CloudView {
  int index = 0;
  double captured_s = 0;
  double arrives_s = 0;
  PointCloud cloud;
};

// A stream of clouds and a path of the HIP as plain data, so that both can be rotated, scaled, reordered or
// delayed before they are played again. World frame, metres, seconds.
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

// Returns the scenes in which renderers of a tool are checked, like verification_scenes(), with normals and a
// device that turns, for the tool kVerifiedTool. Points have regions in the scenes for renderers of regions.
std::vector<MetamorphicScene> tool_scenes(const Kernels& kernels);

// A bar of 80 x 20 x 10 mm, which is its own mirror image along every axis. Written as assignments. The
// voxels are coarse, because the tool is made or loaded for every check.
inline constexpr const char* kVerifiedTool[] = {"tool_mesh=bar", "tool_size_m=0.08", "tool_voxel_m=0.001"};

// Returns the scenes in which every renderer is checked: 320 ticks at 1024 Hz each, with clouds at 32 Hz that
// arrive 5 ticks late: all times are whole multiples of 1/1024 s, so they stay exact when they are halved or
// shifted by whole seconds. A proxy of about 5 mm on points 1.5 mm apart is pressed most of the time. Every
// surface is tilted and every point displaced from its lattice, so that no comparison in a renderer is a tie
// that rounding decides. The same bits on every machine and for all kernels.
std::vector<MetamorphicScene> verification_scenes(const Kernels& kernels);

}  // namespace remote_touch
