// Every depth sensor that --depth can name, one line each, and the simulated one: a scenario played in real
// time, or a recording on disk.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/depth_source.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// Encodes the frames of a scenario as the frames of one sensor. A live run has one view: one camera at one
// pose, or clouds of one layout (see CloudLayout). Encoded frames are decoded by cloud_of().
class FrameEncoder {
 public:
  struct Settings {
    std::string name = "--depth";  // name of the source, for messages
    // Maximum depth along the optical axis, in metres; 0: not known.
    double max_depth_m = 0;
    // Unit of the depths, in metres. 0: the least of 0.1, 0.2, 0.5, 1 and 2 mm with which 16 bits reach
    // max_depth_m and every point of the first frame; the last of these reaches 131.07 m.
    double unit_m = 0;
    // Checks every frame that has points. Throws InputError for a frame to which the rules of the run cannot
    // be applied, such as one without colours. Empty: no check.
    std::function<void(const PointCloud&)> require = {};
  };

  // The view is that of the first frame. Frames are sent as points, in the world frame, if the first frame is
  // no depth image, or if a pinhole camera with 16 bits of depth cannot show it: a lens bends its rays by
  // more than 1 px, or points are behind the camera or deeper than 65535 units.
  FrameEncoder(const Settings& settings, const PointCloud& first);

  const SensorView& view() const { return view_; }

  // Sets the depths or points, and the colours, of the frame. With this view, cloud_of(frame) has the same
  // measured points:
  // - Points of a depth image are on the rays of their pixels, less than 1 px from their original position.
  //   Their depths differ by half a unit at most; a depth of less than half a unit becomes one unit. Their
  //   normals are not sent; a depth_pipeline computes them.
  // - Frames that are sent as points have the nearest floats, and normals if the scenario has them.
  // If the first frame has colours, all frames have them: the points of a frame without colours get
  // kNoColour. If the first frame has none, none are sent.
  //
  // A frame without a measured point that does not fit the view becomes an image of holes, or a cloud without
  // points. Any other frame that does not fit throws InputError, which names the frame. The reasons are
  // another camera, pose or size of image; a point behind the camera or beyond 65535 units; other columns;
  // normals that the first frame has not, or the reverse; and forbidden regions or stiffnesses of single
  // points, which no sensor sends.
  void encode(const PointCloud& cloud, int index, SensorFrame& frame) const;

 private:
  // Functions that return a text return the problem of the frame; the text is empty if there is none.
  void write_nothing(SensorFrame& frame) const;
  std::string problem_of(const PointCloud& cloud) const;
  std::string image_problem(const PointCloud& cloud) const;
  std::string layout_problem(const PointCloud& cloud) const;
  std::string pixel_problem(const Vec3& p_C, std::size_t pixel) const;
  std::string write_depth(const PointCloud& cloud, SensorFrame& frame) const;

  const std::string name_;
  const std::function<void(const PointCloud&)> require_;
  SensorView view_;
  RigidTransform X_CW_ = RigidTransform::Identity();
};

// The scenario that a simulated camera shows now, shared by the camera's thread and the thread that replaces
// it because its noise was changed.
class ShownScenario {
 public:
  explicit ShownScenario(std::shared_ptr<const Scenario> first) : now_(std::move(first)) {}
  std::shared_ptr<const Scenario> now() const {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  // Returns the last frame for a number beyond it, because the camera may have chosen the number before the
  // scenario was replaced.
  PointCloud cloud(int frame) const {
    const auto scenario = now();
    return scenario->cloud(std::min(frame, scenario->frame_count() - 1));
  }
  // pre: the frame rate is the same. The number of frames may differ: a scenario without noise may have a
  // single frame.
  void replace(std::shared_ptr<const Scenario> next) {
    const std::lock_guard lock(mutex_);
    now_ = std::move(next);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Scenario> now_;
};

// Delivers the frames of the scenario at its frame rate; time 0 is start_at(), or else the first next(). If
// several frames are due, only the newest is delivered. Depths are rounded, as a sensor does, see
// FrameEncoder. The last frame is repeated after the end of the scenario, so the camera never ends.
class ScenarioCamera final : public DepthSource {
 public:
  ScenarioCamera(std::shared_ptr<const ShownScenario> scenario, Clock& clock,
                 const FrameEncoder::Settings& settings = {});
  ScenarioCamera(std::unique_ptr<const Scenario> scenario, Clock& clock,
                 const FrameEncoder::Settings& settings = {})
      : ScenarioCamera(std::make_shared<ShownScenario>(std::move(scenario)), clock, settings) {}

  void start_at(std::int64_t start_ns) override { start_s_ = 1e-9 * static_cast<double>(start_ns); }
  // Throws InputError, which names the frame, if a frame cannot be read or does not fit the view.
  SensorState next(SensorFrame& frame, double timeout_s) override;

 private:
  const std::shared_ptr<const ShownScenario> scenario_;
  const FrameEncoder encoder_;
  Clock& clock_;
  double start_s_ = -1;  // time of the clock at the start; -1: not started
  int next_ = 0;
};

// The table of the depth sensors: one line each.

// The objects that a sensor may need. All must outlive it, except shown.
struct SensorContext {
  const Experiment& experiment;
  const Kernels& kernels;
  Clock& clock;
  std::shared_ptr<const ShownScenario> shown = nullptr;  // replaces the experiment's own scenario for sim:
};

struct SensorEntry {
  const char* scheme;
  const char* example;
  const char* summary;
  std::unique_ptr<DepthSource> (*open)(const std::string& address, const SensorContext& context);
  Availability (*availability)();
  bool reads_recording = false;  // the address is the path of a recording
};

std::span<const SensorEntry> sensors();

// Returns the recording that the sensor reads: nothing for cameras, and for sim:, which shows the scenario of
// the experiment.
std::vector<InputPart> sensor_inputs(const std::string& uri);

// Throws InputError when the sensor cannot be opened; for sim: also when the frames of the scenario lack what
// the experiment needs, see Experiment::check_needs().
std::unique_ptr<DepthSource> open_sensor(const std::string& uri, const SensorContext& context);

}  // namespace remote_touch
