// The interface of every scenario: a stream of point cloud frames and the ground truth of the scene.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "core/cloud/point_cloud.h"
#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/random/noise.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

// Two times closer than this are one: sums and quotients of times are rounded differently.
inline constexpr double kSameTime_s = 5e-7;

// A pure function of its configuration, the noise key and the frame number: asked twice, it answers the same.
// Positions are in the world frame, metres; y is up in synthetic scenes, recordings keep the camera's frame.
class Scenario {
 public:
  virtual ~Scenario() = default;

  virtual double frame_rate_hz() const = 0;
  // Frames 0 .. frame_count() - 1 exist; a scene that never changes has one and goes on with it.
  virtual int frame_count() const = 0;
  virtual double captured_s(int frame) const { return frame / frame_rate_hz(); }
  // No frame follows the last, where else a camera would go on and see what it saw: a recorded live session.
  virtual bool ends() const { return false; }
  // The scene as a hand finds its way in it, whatever a sensor makes of it.
  virtual const Scenario& without_faults() const { return *this; }

  // When the frame comes out of the sensor, where that is not when it was captured: it was late, or a
  // recorded live session tells when the renderer got it, infinite where it never did.
  virtual std::optional<double> arrives_s(int /*frame*/) const { return {}; }
  // Of a recorded live session: which fixtures were off when the frame was processed, a bit each.
  virtual std::optional<std::uint64_t> fixtures_off(int /*frame*/) const { return {}; }

  // The newest frame captured by then; half a microsecond lets a frame's own time count, however it was
  // rounded.
  int newest_frame(double time_s) const;

  // What a renderer touches. The noise of a point may be made when it is asked for.
  virtual std::shared_ptr<const NeighbourSearch> points(int frame) const = 0;
  // The same frame with every point made: for drawing, for planning a path and as the oracle of points().
  virtual PointCloud cloud(int frame) const = 0;

  // Ground truth at a time: distance to the true surface, positive on the side that the sensor sees; NaN
  // where the truth is not known.
  virtual double signed_distance(const Vec3& p_W, double time_s) const = 0;
  // Height (y) of the true surface over (x, z); NaN where the scene is not a height field.
  virtual double surface_height(double /*x*/, double /*z*/, double /*time_s*/) const {
    return std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace remote_touch
