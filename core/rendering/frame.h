// The data that a renderer receives: frames of a sensor, with the targets of guidance in them, 7.3.2, and the
// state of a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/points/neighbour_search.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// The target of one guidance virtual fixture in one frame, 7.3.2: the mean position of the points of a class,
// and the plane that they lie in; world frame.
struct GuidanceTarget {
  std::size_t points = 0;      // number of points that the rule selects; 0: no target in the frame
  Vec3 mean_W = Vec3::Zero();  // weighted mean of their positions
  // Unit normal of the plane that fits them by weighted total least squares, towards the sensor. It is zero
  // for fewer than three points. It is also zero if they do not form a plane: if their standard deviation
  // along the normal is above kFlat times that along the plane's shorter axis, or if the latter is at most
  // kLine times that along the longer axis.
  Vec3 normal_W = Vec3::Zero();
  double strength = 1;  // strength of its rule when the frame was captured, 0 to 1
  static constexpr double kFlat = 0.25, kLine = 1e-3;

  bool operator==(const GuidanceTarget&) const = default;
  bool is_visible() const { return points > 0; }
  bool is_flat() const { return !normal_W.isZero(0); }
};

// Returns the target. weights: weight of each point, 0 to 1, as FixtureRule::weights() returns it. Points
// that are not finite are ignored. The sensor is assumed at the camera of the cloud's image; at the origin if
// the cloud has no image.
GuidanceTarget guidance_target(const PointCloud& cloud, const std::vector<double>& weights);

// The properties that a renderer can require of the points of its frames. A run is refused if its frames lack
// one of them, because there would be no force, or a wrong one.
enum class FrameNeed {
  normals,    // points with normals
  organised,  // rows and columns, so that the neighbours of a point are known
  regions,    // forbidden regions around points, or a target of guidance
  view        // viewing direction of the sensor: an image, or a setting `view`
};

// Data that a renderer computes from a frame in advance, see Renderer::prepare().
class FramePreparation {
 public:
  virtual ~FramePreparation() = default;
};

// The true surface at the time of a frame, which only a simulation knows; a frame of a sensor has none. It is
// only for oracles: renderers that show what a better estimate could reach.
class TrueSurface {
 public:
  virtual ~TrueSurface() = default;
  // Returns the distance to the surface at a time, m, positive on the side that the sensor sees. NaN if it is
  // not known, and beside a surface with a border, where there is no back.
  virtual double signed_distance(const Vec3& p_W, double time_s) const = 0;
};

// One point cloud of the stream. Latency is part of the data: the renderer receives the frame at arrives_s.
struct Frame {
  int index = 0;
  double captured_s = 0;
  double arrives_s = 0;
  std::shared_ptr<const NeighbourSearch> points;
  std::vector<GuidanceTarget> guidance = {};  // one for every guidance fixture, in their order
  std::shared_ptr<const FramePreparation> prepared = nullptr;
  std::shared_ptr<const TrueSurface> truth = nullptr;  // simulations only
};

// The position of the haptic interface point (HIP) in the world frame; the orientation, which rotates the
// axes of the handle to the world; and the pressed buttons of the handle, one bit each.
struct DeviceState {
  Vec3 position_W = Vec3::Zero();
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  std::uint32_t buttons = 0;
};

}  // namespace remote_touch
