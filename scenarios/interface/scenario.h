// The interface of every scenario: a stream of point cloud frames and the ground truth of the scene.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/numeric/noise.h"
#include "core/search/neighbour_search.h"
#include "scenarios/interface/note.h"

namespace remote_touch {

// Two times closer than this are equal: sums and quotients of times are rounded differently.
inline constexpr double kSameTime_s = 5e-7;

// A pure function of its configuration, the noise key and the frame number: the same call gives the same
// result. Positions are in the world frame, metres; y is up in synthetic scenes, recordings keep the camera's
// frame.
class Scenario {
 public:
  virtual ~Scenario() = default;

  virtual double frame_rate_hz() const = 0;
  // Frames 0 .. frame_count() - 1 exist; a scene that never changes has one, which is then repeated.
  virtual int frame_count() const = 0;
  virtual double captured_s(int frame) const { return frame / frame_rate_hz(); }
  // True if no frame follows the last one, as in a recorded live session. Otherwise the camera repeats the
  // last frame.
  virtual bool ends() const { return false; }
  // The scene as scripted hands use it, without the faults of a sensor.
  virtual const Scenario& without_faults() const { return *this; }
  // The parts of the motion, in order. Empty: the scene rests, or its motion has no parts.
  virtual std::vector<Phase> phases() const { return {}; }
  // One line about what was read so far: the frames of a recording. Empty: nothing is read.
  virtual std::string input() const { return {}; }
  // Notes on what was read so far: a recording that was cut short, points that were dropped.
  virtual std::vector<Note> input_notes() const { return {}; }
  // The pose of the sensor in the world frame, for a recording. The sensor looks along its z axis.
  virtual std::optional<RigidTransform> sensor_pose() const { return {}; }

  // Time at which the frame leaves the sensor, if that is not when it was captured: the frame was late, or it
  // belongs to a recorded live session, which stores when the renderer got it (infinite if it never did).
  virtual std::optional<double> arrives_s(int /*frame*/) const { return {}; }
  // Fixtures that were off when the frame was processed, one bit each; only in a recorded live session.
  virtual std::optional<std::uint64_t> fixtures_off(int /*frame*/) const { return {}; }

  // The newest frame captured by then, with a tolerance of kSameTime_s for rounded times.
  int newest_frame(double time_s) const;

  // Points of a frame, as a renderer touches them. The noise of a point may be computed late, when a search
  // gathers the point.
  virtual std::shared_ptr<const NeighbourSearch> points(int frame) const = 0;
  // The same frame with every point computed: for drawing, for planning a path and as the oracle of points().
  virtual PointCloud cloud(int frame) const = 0;

  // Ground truth at a time: distance to the true surface, m, positive on the side that the sensor sees. NaN
  // if the truth is not known, if the scene has no surface (single points), and beside a surface with a
  // border. Beside it, behind the plane that ends at the border, there is no back: nothing hides p from the
  // sensor, and the way there goes round the border and not through the surface. Above that plane the
  // distance to the border is positive.
  virtual double signed_distance(const Vec3& p_W, double time_s) const = 0;
  // Returns the unit normal of the true surface of signed_distance() at the point that is nearest to p,
  // towards the side that the sensor sees. Returns NaN in all three coordinates if the truth is not known. It
  // does so also if several parts of the surface are equally near, within 0.1 mm, as over the bottom of a
  // valley, because the parts have different normals. The default is the gradient of signed_distance(), by
  // differences over 0.1 mm: exact for planes, and within 1e-4 rad for radii of curvature of 5 mm and more.
  virtual Vec3 true_normal(const Vec3& p_W, double time_s) const;
  // Returns the normal of the true surface if that is a single plane, with or without a border. It is then
  // the true normal of every contact, also of a tool, which touches with an area. Returns nothing for other
  // surfaces.
  virtual std::optional<Vec3> plane_normal(double /*time_s*/) const { return {}; }
  // Time at which the surface was where signed_distance() measures from: time_s, or, if the truth is what the
  // camera has seen, the last capture.
  virtual double truth_time_s(double time_s) const { return time_s; }
  // Height (y) of the surface over (x, z) as it moves; NaN where the scene is not a height field.
  virtual double surface_height(double /*x*/, double /*z*/, double /*time_s*/) const {
    return std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace remote_touch
