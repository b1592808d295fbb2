// The interface of every scenario: a stream of point cloud frames and the ground truth of the scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/points/neighbour_search.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// A remark on a run that the user should read: the run is valid, but it may not be what was meant.
struct Note {
  std::string kind;  // the same for all notes of this kind, see note_kinds(): "no contact"
  std::string text;  // one line
};

// A part of the scripted motion of a scene or of a hand.
struct Phase {
  std::string name;  // name with its article: "the acceleration"
  double begins_s = 0;
  double ends_s = std::numeric_limits<double>::infinity();
};

// The time at which a surface that moves is considered. newest_frame: the surface as at the last capture.
// moving: the surface as it moves between frames.
enum class SurfaceTime { newest_frame, moving };

// Two times count as equal if they differ by less than this, because sums and quotients of times are rounded.
inline constexpr double kSameTime_s = 5e-7;

// The delivery of a frame to the renderer, where it is not that of the run's transport.
struct FrameDelivery {
  // Time at which the frame leaves the sensor. Empty if that is the time of capture. A late frame has a later
  // time. A frame of a recorded live session has the time at which the renderer received it, infinite if it
  // never did.
  std::optional<double> leaves_sensor_s = {};
  // Fixtures that were off when the frame was processed, one bit each; only in a recorded live session.
  std::optional<std::uint64_t> fixtures_off = {};
};

// A mesh that is a part of the true surface, and its pose. The spans are valid as long as the scenario.
struct PosedMesh {
  std::string name;
  std::span<const Vec3> vertices_O;               // frame O of the object, m
  std::span<const std::array<int, 3>> triangles;  // indices of vertices, counter-clockwise seen from outside
  std::optional<RigidTransform> X_WO;             // object to world frame; nothing: unknown
  bool is_closed = true;                          // false: a sheet, whose both sides can be seen
};

// A scenario is a pure function of its configuration, the noise key and the frame number: the same call gives
// the same result. Positions are in the world frame, in metres. y is up in synthetic scenes; recordings keep
// the camera's frame unless the camera is registered.
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
  // One line about the frames of a recording that were read so far. Empty if the scenario reads no files.
  virtual std::string input() const { return {}; }
  // Notes on what was read so far: a recording that was cut short, points that were dropped.
  virtual std::vector<Note> input_notes() const { return {}; }
  // The pose of the sensor in the world frame, for a recording. The sensor looks along its z axis.
  virtual std::optional<RigidTransform> sensor_pose() const { return {}; }

  virtual FrameDelivery delivery(int /*frame*/) const { return {}; }

  // Returns the newest frame captured by time_s, with a tolerance of kSameTime_s for rounded times. Returns
  // frame 0 if no frame was captured by then.
  int newest_frame(double time_s) const;

  // Points of a frame, as a renderer touches them; by default those of cloud(). The noise of a point may be
  // computed late, when a search gathers the point.
  virtual std::shared_ptr<const NeighbourSearch> points(int frame) const { return make_search(cloud(frame)); }
  // The same frame with every point computed: for drawing, for planning a path and as the oracle of points().
  virtual PointCloud cloud(int frame) const = 0;

  // Ground truth at a time: distance to the true surface, m, positive on the side that the sensor sees. NaN
  // if the truth is not known, or if the scene has no surface (single points). NaN also if p is beside a
  // surface with a border and behind the plane that ends at the border. The surface has no back there: it
  // does not hide p from the sensor, and the way to p goes round the border and not through the surface.
  // Beside the surface and in front of that plane the result is positive: it is the distance to the border,
  // or, for a flat grid, the height over the plane.
  virtual double signed_distance(const Vec3& p_W, double time_s) const = 0;
  // Distance to the surface as the sensor has measured it in its newest frame, m, with the sign of
  // signed_distance(). A scenario has it if it knows a true surface besides the measured one, so that the
  // error of the camera can be told from that of the renderer. NaN where it is not known.
  virtual std::optional<double> measured_distance(const Vec3& /*p_W*/, double /*time_s*/) const { return {}; }
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
  // Time of the surface from which signed_distance() measures. It is time_s, or the time of the last capture
  // if the truth is what the camera has seen.
  virtual double truth_time_s(double time_s) const { return time_s; }
  // The true surface of signed_distance() in words, if the scenario is a recording: "the measured surface".
  // Empty for a simulation, whose true surface is exact.
  virtual std::string truth_text() const { return {}; }
  // Returns the meshes from which signed_distance() measures at this time: the same meshes in the same order
  // at all times, at the poses of that time. Empty if the true surface is not one of meshes.
  virtual std::vector<PosedMesh> true_meshes(double /*time_s*/) const { return {}; }
  // Height (y) of the surface over (x, z) at time_s; NaN where the scene is not a height field.
  virtual double surface_height(double /*x*/, double /*z*/, double /*time_s*/) const {
    return std::numeric_limits<double>::quiet_NaN();
  }
};

// The frames of a scenario that were used last. Hand, renderer and truth use the same frames in turn, and
// making a frame may take far longer than copying it. Several threads may call get() at the same time.
class KeptFrames {
 public:
  using Points = std::shared_ptr<const NeighbourSearch>;

  // pre: at_most is 1 or more.
  explicit KeptFrames(std::size_t at_most) : at_most_(at_most) {}

  // Returns the frame if it is kept. Otherwise makes it, and keeps it instead of the frame that was used
  // longest ago. What make() throws is passed on, and nothing is kept. Threads that ask for the same frame
  // at the same time may each make it.
  Points get(std::size_t frame, const std::function<Points()>& make);

 private:
  struct Kept {
    std::size_t frame;
    Points points;
  };
  Points find(std::size_t frame);

  const std::size_t at_most_;
  std::mutex mutex_;        // guards kept_
  std::vector<Kept> kept_;  // the frame that was used last is in front
};

}  // namespace remote_touch
